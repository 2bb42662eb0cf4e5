using System.Collections.Generic;
using UnityEditor;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>Shows, while the game runs, how the connection of an <see cref="AgentClient"/> does.</summary>
    [CustomEditor(typeof(AgentClient))]
    sealed class AgentClientEditor : Editor
    {
        const int LineCount = 8;

        readonly List<string> _lines = new List<string>();
        AgentClient _client;

        public override bool RequiresConstantRepaint() => EditorApplication.isPlaying;

        public override void OnInspectorGUI()
        {
            DrawDefaultInspector();
            if (!EditorApplication.isPlaying)
            {
                EditorGUILayout.HelpBox("Press play to connect; the state of the connection is shown here.", MessageType.Info);
                return;
            }
            EditorGUILayout.Space();
            if (_client.Renderer == null)
            {
                EditorGUILayout.HelpBox("Not connected: a setting is wrong, see the console.", MessageType.Error);
                return;
            }
            Draw("Renderer", _client.Renderer.Connection);
            if (_client.Monitor != null) Draw("Monitor", _client.Monitor.Connection);
            EditorGUILayout.LabelField("Last commands", EditorStyles.boldLabel);
            if (_lines.Count == 0) EditorGUILayout.LabelField("none yet");
            foreach (string line in _lines) EditorGUILayout.LabelField(line);
        }

        void OnEnable()
        {
            _client = (AgentClient)target;
            _client.CommandReceived += Began;
            _client.CommandCancelled += Cancelled;
        }

        void OnDisable()
        {
            if (ReferenceEquals(_client, null)) return;
            _client.CommandReceived -= Began;
            _client.CommandCancelled -= Cancelled;
        }

        static void Draw(string title, Connection connection)
        {
            EditorGUILayout.LabelField(title, EditorStyles.boldLabel);
            EditorGUILayout.LabelField("Phase", ConnectionText.Phase(connection));
            EditorGUILayout.LabelField("Round trip", ConnectionText.RoundTrip(connection));
            EditorGUILayout.LabelField("Server's clock less ours", ConnectionText.Offset(connection));
            if (connection.Fault != null) EditorGUILayout.HelpBox(connection.Fault, MessageType.Warning);
        }

        void Began(CommandMessage command) => Add(command.Reaction + " (" + command.Cause + "), " + command.Id);

        void Cancelled(CommandMessage command, string reason) => Add("cut short, " + reason + ": " + command.Id);

        void Add(string line)
        {
            _lines.Insert(0, line);
            if (_lines.Count > LineCount) _lines.RemoveAt(LineCount);
        }
    }
}
