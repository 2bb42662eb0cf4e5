using System;
using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// An object of the rule file in the scene: its states, how they look, and where the agent stands
    /// to use it. An object without states is scenery that steps can name.
    /// </summary>
    [AddComponentMenu("Agent Server/Room Object")]
    [DisallowMultipleComponent]
    public sealed class RoomObject : MonoBehaviour
    {
        [SerializeField, Tooltip("Name of the object in the rule file, for example window.")]
        string _objectName = "";

        [SerializeField, Tooltip("The states of the rule file; none for scenery.")]
        ObjectState[] _states = new ObjectState[0];

        [SerializeField, Tooltip("State at the start; the server's word replaces it.")]
        string _state = "";

        [SerializeField, Tooltip("Where the agent stands, and looks along z, to use it. Empty: one metre before it.")]
        Transform _standPoint;

        string _shown = "";

        /// <summary>Somebody changed it by hand, to this state; a <see cref="Room"/> tells the server.</summary>
        public event Action<RoomObject, string> ChangedByHand;

        /// <summary>Name of the object in the rule file.</summary>
        public string ObjectName => _objectName;

        /// <summary>The state that the server knows of; empty for scenery.</summary>
        public string State => _states.Length == 0 ? "" : _state;

        /// <summary>The state that is seen; another one than <see cref="State"/> while a step plays.</summary>
        public string Shown => _shown;

        /// <summary>Whether it has states.</summary>
        public bool HasStates => _states.Length > 0;

        /// <summary>Where the agent stands to use it; null for one metre before it.</summary>
        public Transform StandPoint => _standPoint;

        /// <summary>Names it, for scenes that are built by a program.</summary>
        public void Describe(string objectName, Transform standPoint, string state, params ObjectState[] states)
        {
            _objectName = objectName;
            _standPoint = standPoint;
            _state = state;
            _states = states;
            Show(state);
        }

        /// <summary>The server's word: takes the state and shows it.</summary>
        /// <returns>False, and nothing is changed, if it has no such state.</returns>
        public bool Apply(string state)
        {
            if (!Has(state)) return false;
            _state = state;
            Show(state);
            return true;
        }

        /// <summary>Shows a state before the server has said so, while a step plays.</summary>
        /// <returns>False, and nothing is changed, if it has no such state.</returns>
        public bool Preview(string state)
        {
            if (!Has(state)) return false;
            Show(state);
            return true;
        }

        /// <summary>Shows the state that the server knows of again.</summary>
        public void EndPreview() => Show(State);

        /// <summary>A change by hand: takes the state, shows it, and reports it.</summary>
        /// <returns>False if it has no such state, or is in it already.</returns>
        public bool Change(string state)
        {
            if (!Has(state) || state == _state) return false;
            Apply(state);
            ChangedByHand?.Invoke(this, state);
            return true;
        }

        /// <summary>A change by hand to the state after the present one; for a button or a click.</summary>
        public void ChangeToNext()
        {
            int at = Array.FindIndex(_states, one => one.Name == _state);
            if (_states.Length > 0) Change(_states[(at + 1) % _states.Length].Name);
        }

        /// <summary>Names of the states, in order.</summary>
        public IReadOnlyList<string> StateNames() => Array.ConvertAll(_states, one => one.Name);

        void Awake() => Show(State);

        bool Has(string state) => Array.Exists(_states, one => one.Name == state);

        void Show(string state)
        {
            if (_shown == state) return;
            _shown = state;
            // One visual may belong to several states.
            foreach (ObjectState other in _states) other.SetVisible(false);
            ObjectState entered = Array.Find(_states, one => one.Name == state);
            if (entered == null) return;
            entered.SetVisible(true);
            entered.OnShown.Invoke();
        }
    }
}
