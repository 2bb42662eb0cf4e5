using System;
using UnityEngine;
using UnityEngine.Events;

namespace AgentServer.Unity
{
    /// <summary>One state that an object of the room may be in, and how it looks.</summary>
    [Serializable]
    public sealed class ObjectState
    {
        [SerializeField, Tooltip("Name of the state in the rule file, for example closed.")]
        string _name = "";

        [SerializeField, Tooltip("Shown in this state and hidden in the others.")]
        GameObject[] _visuals = new GameObject[0];

        [SerializeField, Tooltip("Called when the object is shown in this state.")]
        UnityEvent _onShown = new UnityEvent();

        /// <summary>For Unity.</summary>
        public ObjectState()
        {
        }

        /// <param name="name">Name of the state in the rule file.</param>
        /// <param name="visuals">Shown in this state and hidden in the others.</param>
        public ObjectState(string name, params GameObject[] visuals)
        {
            _name = name;
            _visuals = visuals;
        }

        /// <summary>Name of the state in the rule file.</summary>
        public string Name => _name;

        /// <summary>Called when the object is shown in this state.</summary>
        public UnityEvent OnShown => _onShown;

        internal void SetVisible(bool isVisible)
        {
            foreach (GameObject visual in _visuals)
            {
                if (visual != null) visual.SetActive(isVisible);
            }
        }
    }
}
