using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// The objects of the room: tells the server how they stand, shows what the server says, and reports
    /// what is changed by hand. They are the <see cref="RoomObject"/>s below it.
    /// </summary>
    [AddComponentMenu("Agent Server/Room")]
    [DisallowMultipleComponent]
    public sealed class Room : MonoBehaviour
    {
        [SerializeField, Tooltip("The connection to the server.")]
        AgentClient _client;

        readonly Dictionary<string, RoomObject> _objects = new Dictionary<string, RoomObject>();
        readonly HashSet<string> _told = new HashSet<string>();

        /// <summary>The connection to the server; set it before the room is enabled.</summary>
        public AgentClient Client
        {
            get => _client;
            set => _client = value;
        }

        /// <summary>What the agent does: `working`, `attention` or `reacting`; empty before the first word.</summary>
        public string Mode { get; private set; } = "";

        /// <summary>The object of a name; null if the room has none.</summary>
        public RoomObject Find(string objectName)
        {
            RoomObject found;
            return _objects.TryGetValue(objectName, out found) ? found : null;
        }

        /// <summary>The state of every object that has any, for the hello.</summary>
        public IDictionary<string, string> Snapshot() =>
            _objects.Values.Where(one => one.HasStates).ToDictionary(one => one.ObjectName, one => one.State);

        /// <summary>Shows the room as the server has it.</summary>
        public void Apply(SceneState scene)
        {
            Mode = scene.Mode;
            foreach (KeyValuePair<string, string> one in scene.Objects) Apply(one.Key, one.Value);
            foreach (RoomObject own in _objects.Values)
            {
                if (own.HasStates && !scene.Objects.ContainsKey(own.ObjectName))
                    Tell("The server's rule file has no states for '" + own.ObjectName
                        + "': add it under [objects], or take its states away here.", own);
            }
        }

        /// <summary>Says on what server and scene did not agree, and whose word holds.</summary>
        public void Reconcile(IReadOnlyList<Difference> differences)
        {
            foreach (Difference one in differences)
            {
                bool isOurs = one.Kept == Authority.Renderer;
                Debug.Log("Room: '" + one.Object + "' was '" + one.Renderer + "' here and '" + one.Server
                    + "' on the server; " + (isOurs ? "the scene's" : "the server's") + " state holds.", this);
            }
        }

        /// <summary>Shows what the server knows of, where a step that was cut had shown more.</summary>
        public void EndPreviews()
        {
            foreach (RoomObject one in _objects.Values) one.EndPreview();
        }

        /// <summary>Looks for the objects anew, after some were added or taken away.</summary>
        public void Refresh()
        {
            Forget();
            foreach (RoomObject one in GetComponentsInChildren<RoomObject>(true))
            {
                if (one.ObjectName == "")
                    Tell("'" + one.name + "' has no object name: give it that of the rule file.", one);
                else if (_objects.ContainsKey(one.ObjectName))
                    Tell("There are two objects '" + one.ObjectName + "' in the room: the first one is used.", one);
                else
                {
                    _objects.Add(one.ObjectName, one);
                    one.ChangedByHand += Report;
                }
            }
        }

        void OnEnable()
        {
            Refresh();
            if (_client == null)
            {
                Debug.LogError("The room '" + name + "' has no client: set its field Client.", this);
                return;
            }
            _client.Objects = Snapshot;
            _client.SceneChanged += Apply;
            _client.Reconciled += Reconcile;
        }

        void OnDisable()
        {
            Forget();
            if (_client == null) return;
            _client.Objects = null;
            _client.SceneChanged -= Apply;
            _client.Reconciled -= Reconcile;
        }

        void Apply(string objectName, string state)
        {
            RoomObject found = Find(objectName);
            if (found == null)
                Tell("The room has no object '" + objectName + "' of the rule file: add a RoomObject of that name.", this);
            else if (!found.Apply(state))
                Tell("'" + objectName + "' has no state '" + state + "': add it to its states ("
                    + string.Join(", ", found.StateNames()) + ").", found);
        }

        void Report(RoomObject changed, string state)
        {
            if (_client != null) _client.ReportObject(changed.ObjectName, state);
        }

        void Forget()
        {
            foreach (RoomObject one in _objects.Values) one.ChangedByHand -= Report;
            _objects.Clear();
        }

        void Tell(string what, Object about)
        {
            if (_told.Add(what)) Debug.LogWarning(what, about);
        }
    }
}
