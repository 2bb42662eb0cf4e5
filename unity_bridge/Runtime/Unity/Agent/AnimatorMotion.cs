using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Plays steps with an Animator: a state or a trigger for each, scaled to the step's time.</summary>
    [AddComponentMenu("Agent Server/Animator Motion")]
    [RequireComponent(typeof(Animator))]
    public sealed class AnimatorMotion : MonoBehaviour, IAgentMotion
    {
        const int Layer = 0;

        [SerializeField, Tooltip("State of the animator for standing still.")]
        string _standState = "Stand";

        [SerializeField, Tooltip("State of the animator for sitting still.")]
        string _sitState = "Sit";

        [SerializeField, Min(0), Tooltip("Seconds of the cross-fade between states.")]
        float _fade = 0.2f;

        [SerializeField, Tooltip("Bone that turns to what the agent looks at; empty: the humanoid's head.")]
        Transform _head;

        [SerializeField, Range(0, 90), Tooltip("The head turns no further than this, in degrees.")]
        float _headLimit = 70;

        [SerializeField, Min(0), Tooltip("Time constant of the head's turn in seconds.")]
        float _headSmoothing = 0.2f;

        readonly HashSet<string> _missing = new HashSet<string>();
        Animator _animator;
        string _trigger = "";
        Vector3? _gaze;
        Quaternion _headTurn = Quaternion.identity;
        Quaternion _headRest, _headShown;

        /// <inheritdoc/>
        public void Play(StepMessage step, StepMapping mapping)
        {
            _animator.speed = mapping == null ? 1 : mapping.Speed(step.DurationS);
            if (mapping == null) return;
            if (mapping.Trigger != "")
            {
                _trigger = mapping.Trigger;
                _animator.SetTrigger(_trigger);
            }
            else if (mapping.AnimatorState != "") Fade(mapping.AnimatorState);
        }

        /// <inheritdoc/>
        public void Rest(bool isStanding)
        {
            // A trigger that was set and not used yet would start what was cut.
            if (_trigger != "") _animator.ResetTrigger(_trigger);
            _trigger = "";
            _animator.speed = 1;
            Fade(isStanding ? _standState : _sitState);
        }

        /// <inheritdoc/>
        public void LookAt(Vector3? point) => _gaze = point;

        void Awake()
        {
            _animator = GetComponent<Animator>();
            if (_head == null) _head = _animator.GetBoneTransform(HumanBodyBones.Head);
        }

        // After the animator, whose pose of the head is turned further.
        void LateUpdate()
        {
            if (_head == null) return;
            // An animator that is culled leaves the head as it was shown: that is not to be turned again.
            if (!_head.localRotation.Equals(_headShown)) _headRest = _head.localRotation;
            _head.localRotation = _headRest;
            float share = _headSmoothing > 0 ? 1 - Mathf.Exp(-Time.deltaTime / _headSmoothing) : 1;
            _headTurn = Quaternion.Slerp(_headTurn, HeadAim(), share);
            Quaternion root = transform.rotation;
            _head.rotation = root * _headTurn * Quaternion.Inverse(root) * _head.rotation;
            _headShown = _head.localRotation;
        }

        /// <summary>Where the head is to turn, against looking straight ahead.</summary>
        Quaternion HeadAim()
        {
            if (_gaze == null) return Quaternion.identity;
            Vector3 way = Quaternion.Inverse(transform.rotation) * (_gaze.Value - _head.position);
            Quaternion full = Quaternion.FromToRotation(Vector3.forward, way);
            return Quaternion.RotateTowards(Quaternion.identity, full, _headLimit);
        }

        void Fade(string state)
        {
            int hash = Animator.StringToHash(state);
            if (_animator.HasState(Layer, hash))
            {
                _animator.CrossFadeInFixedTime(hash, _fade, Layer);
                return;
            }
            if (_missing.Add(state))
                Debug.LogWarning(
                    "The animator of '" + name + "' has no state '" + state + "': add one, or name another in "
                    + "the table of steps.", this);
        }
    }
}
