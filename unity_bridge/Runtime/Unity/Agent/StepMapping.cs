using System;
using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>How a step of the rule file looks: which animation, and what becomes of its object.</summary>
    [Serializable]
    public sealed class StepMapping
    {
        [SerializeField, Tooltip("A step of the rule file, for example close.")]
        string _action = "";

        [SerializeField, Tooltip("Only for this object; empty for all.")]
        string _target = "";

        [SerializeField, Tooltip("State of the animator that is played; empty for none.")]
        string _animatorState = "";

        [SerializeField, Tooltip("Trigger of the animator that is set instead of playing a state; empty for none.")]
        string _trigger = "";

        [SerializeField, Min(0), Tooltip("Seconds that the clip takes at speed 1; it is scaled to the step's time. 0: not scaled.")]
        float _clipSeconds;

        [SerializeField, Tooltip("State that the object is shown in when the step has ended, before the server says so.")]
        string _objectState = "";

        /// <summary>For Unity.</summary>
        public StepMapping()
        {
        }

        /// <param name="action">A step of the rule file.</param>
        /// <param name="target">Only for this object; empty for all.</param>
        /// <param name="animatorState">State of the animator that is played; empty for none.</param>
        /// <param name="clipSeconds">Seconds that its clip takes at speed 1; 0 if it is not scaled.</param>
        /// <param name="objectState">State that the object is shown in afterwards; empty for none.</param>
        public StepMapping(
            string action, string target = "", string animatorState = "", float clipSeconds = 0, string objectState = "")
        {
            _action = action;
            _target = target;
            _animatorState = animatorState;
            _clipSeconds = clipSeconds;
            _objectState = objectState;
        }

        /// <summary>A step of the rule file.</summary>
        public string Action => _action;

        /// <summary>State of the animator that is played; empty for none.</summary>
        public string AnimatorState => _animatorState;

        /// <summary>Trigger of the animator that is set; empty for none.</summary>
        public string Trigger => _trigger;

        /// <summary>State that the object is shown in when the step has ended; empty for none.</summary>
        public string ObjectState => _objectState;

        /// <summary>Playback speed with which the clip ends with the step.</summary>
        /// <param name="seconds">Time of the step.</param>
        public float Speed(double seconds) =>
            _clipSeconds > 0 && seconds > 0 ? _clipSeconds / (float)seconds : 1;

        /// <summary>The line for a step: one for its object goes before one for all; null if there is none.</summary>
        public static StepMapping Find(IReadOnlyList<StepMapping> table, StepMessage step)
        {
            StepMapping general = null;
            foreach (StepMapping line in table)
            {
                if (line._action != step.Action) continue;
                if (line._target == (step.Target ?? "") && line._target != "") return line;
                if (line._target == "" && general == null) general = line;
            }
            return general;
        }

        /// <summary>The steps of the server's own rule file.</summary>
        public static StepMapping[] Default() => new[]
        {
            new StepMapping("stand_up", animatorState: "StandUp"),
            new StepMapping("sit_down", animatorState: "SitDown"),
            new StepMapping("walk_to", animatorState: "Walk"),
            new StepMapping("open", animatorState: "Reach", objectState: "open"),
            new StepMapping("close", animatorState: "Reach", objectState: "closed"),
            new StepMapping("turn_down", animatorState: "Reach", objectState: "low"),
            new StepMapping("put_out", animatorState: "Reach", objectState: "out"),
            new StepMapping("turn_to"),
            new StepMapping("turn_to_person"),
            new StepMapping("look_at"),
            new StepMapping("look_at_person"),
            new StepMapping("type_on", animatorState: "Type"),
        };
    }
}
