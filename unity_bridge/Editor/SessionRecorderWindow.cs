using System;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>Records a session into files, whether or not the game runs.</summary>
    sealed class SessionRecorderWindow : EditorWindow
    {
        [SerializeField]
        string _address = "ws://127.0.0.1:8765";

        [SerializeField]
        string _session = "demo";

        [SerializeField]
        string _folder = "Recordings";

        MonitorClient _monitor;
        SessionRecorder _recorder;
        string _problem = "";

        [MenuItem("Agent Server/Session Recorder")]
        static void Open() => GetWindow<SessionRecorderWindow>("Session Recorder");

        void OnGUI()
        {
            bool isRecording = _recorder != null;
            using (new EditorGUI.DisabledScope(isRecording))
            {
                _address = EditorGUILayout.TextField("Server", _address);
                _session = EditorGUILayout.TextField("Session", _session);
                _folder = EditorGUILayout.TextField("Folder", _folder);
            }
            if (GUILayout.Button(isRecording ? "Stop" : "Record"))
            {
                if (isRecording) Stop();
                else Begin();
            }
            if (_problem != "") EditorGUILayout.HelpBox(_problem, MessageType.Error);
            if (_recorder == null) return;
            EditorGUILayout.LabelField("Connection", ConnectionText.Phase(_monitor.Connection));
            EditorGUILayout.LabelField("Messages", _recorder.Messages.ToString());
            EditorGUILayout.LabelField("Frames", _recorder.Frames.ToString());
            if (_monitor.Connection.Fault != null)
                EditorGUILayout.HelpBox(_monitor.Connection.Fault, MessageType.Warning);
        }

        void OnDisable() => Stop();

        void Begin()
        {
            _problem = "";
            try
            {
                var settings = new ConnectionSettings
                {
                    Address = _address, Session = _session, Role = Role.Monitor, ClientName = "unity-recorder",
                };
                _monitor = new MonitorClient(settings);
                Directory.CreateDirectory(_folder);
                string path = Path.Combine(_folder, _session + "-" + DateTime.Now.ToString("yyyyMMdd-HHmmss"));
                _recorder = new SessionRecorder(
                    new StreamWriter(path + ".telemetry.jsonl"), new StreamWriter(path + ".skeletons.jsonl"));
            }
            catch (Exception wrong) when (wrong is ArgumentException || wrong is IOException || wrong is UnauthorizedAccessException)
            {
                _problem = wrong.Message;
                return;
            }
            _monitor.Connection.Received += _recorder.Take;
            _monitor.Connection.Start();
            EditorApplication.update += Poll;
        }

        void Stop()
        {
            if (_recorder == null) return;
            EditorApplication.update -= Poll;
            _monitor.Connection.Stop();
            _recorder.Dispose();
            _recorder = null;
        }

        void Poll()
        {
            _monitor.Poll();
            Repaint();
        }
    }
}
