using System;
using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Something that the agent does unasked, and how often.</summary>
    [Serializable]
    public sealed class IdleStep
    {
        [SerializeField, Tooltip("A step of the rule file, for example look_at.")]
        string _action = "";

        [SerializeField, Tooltip("Object that it is done to; empty for none.")]
        string _target = "";

        [SerializeField, Min(0.001f), Tooltip("Seconds that it takes.")]
        float _seconds = 2;

        [SerializeField, Min(0), Tooltip("How often, relative to the other lines.")]
        float _weight = 1;

        /// <summary>For Unity.</summary>
        public IdleStep()
        {
        }

        /// <param name="action">A step of the rule file.</param>
        /// <param name="target">Object that it is done to; empty for none.</param>
        /// <param name="seconds">Seconds that it takes.</param>
        /// <param name="weight">How often, relative to the other lines.</param>
        public IdleStep(string action, string target, float seconds, float weight)
        {
            _action = action;
            _target = target;
            _seconds = seconds;
            _weight = weight;
        }

        /// <summary>How often, relative to the other lines.</summary>
        public float Weight => _weight;

        /// <summary>As a step to play.</summary>
        public StepMessage Step() => new StepMessage(_action, _seconds, _target == "" ? null : _target);
    }

    /// <summary>Picks what the agent does unasked, by the weights of a table.</summary>
    public static class IdleChooser
    {
        /// <summary>A step of the table; null if it has none with a weight.</summary>
        /// <param name="table">As in the rule file.</param>
        /// <param name="unit">A random number from 0 to below 1.</param>
        public static StepMessage Choose(IReadOnlyList<IdleStep> table, double unit)
        {
            double total = 0;
            foreach (IdleStep line in table) total += line.Weight;
            double left = unit * total;
            foreach (IdleStep line in table)
            {
                left -= line.Weight;
                if (left < 0) return line.Step();
            }
            return null;
        }
    }
}
