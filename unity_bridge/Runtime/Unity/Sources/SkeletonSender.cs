using System;
using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// Sends the bodies of an <see cref="ISkeletonSource"/> and the gaze of an <see cref="IGazeSource"/> to the
    /// server. Both are looked for on the same object, or set by a program.
    /// </summary>
    [AddComponentMenu("Agent Server/Skeleton Sender")]
    [DisallowMultipleComponent]
    public sealed class SkeletonSender : MonoBehaviour
    {
        const int GoodbyeMs = 300;
        const int NumbersPerJoint = 4;

        [SerializeField, Tooltip("A shared asset; it replaces the field below.")]
        AgentSettings _settings;

        [SerializeField]
        ServerAddress _server = new ServerAddress();

        [SerializeField, Tooltip("Replace a sensor that is there already.")]
        bool _takeOver;

        [SerializeField, Tooltip("Whether somebody sends the person's face too. Untick it where nobody does: the gate of the server is then off, or goes by the gaze.")]
        bool _expectFace;

        [SerializeField, Range(1, 60), Tooltip("Gazes a second.")]
        float _gazeRate = 30;

        readonly List<SkeletonSample> _samples = new List<SkeletonSample>();
        readonly PlatformTransports _platform = new PlatformTransports();
        ITransportFactory _transports;
        IClock _clock;
        float[] _numbers = new float[0];
        long? _sourceStartNs;
        float _untilGaze;
        FaceKind _face;
        bool _isPaused;

        /// <summary>Where bodies come from; null if only a gaze is sent.</summary>
        public ISkeletonSource Source { get; set; }

        /// <summary>Where the gaze comes from; null if none is sent.</summary>
        public IGazeSource Gaze { get; set; }

        /// <summary>The sensor; null before the first enabling, or if a setting is wrong.</summary>
        public SensorClient Sensor { get; private set; }

        /// <summary>Where the server is; change it before the component is enabled.</summary>
        public ServerAddress Server => _settings == null ? _server : _settings.Server;

        /// <summary>Other sockets and another clock than the platform's; for tests, before it is enabled.</summary>
        public void Use(ITransportFactory transports, IClock clock)
        {
            _transports = transports;
            _clock = clock;
        }

        void OnEnable()
        {
            if (Source == null) Source = GetComponent<ISkeletonSource>();
            if (Gaze == null) Gaze = GetComponent<IGazeSource>();
            if (Source == null && Gaze == null)
                Debug.LogWarning("The sender '" + name + "' has nothing to send: add a source to its object, for "
                    + "example a Recorded Skeleton Source.", this);
            if (!_isPaused) Begin();
        }

        void OnDisable() => Disconnect(0);

        void OnApplicationPause(bool isPaused)
        {
            if (isPaused == _isPaused) return;
            _isPaused = isPaused;
            if (isPaused) Disconnect(GoodbyeMs);
            else if (isActiveAndEnabled) Begin();
        }

        void OnApplicationQuit() => Disconnect(GoodbyeMs);

        void Update()
        {
            if (Sensor == null) return;
            // A headset may have come, or gone. The hello says which, so it is said anew.
            if (Face() != _face)
            {
                Disconnect(0);
                Sensor = null;
                Begin();
                if (Sensor == null) return;
            }
            _platform.Pump();
            Sensor.Poll();
            SendBodies();
            SendGaze();
        }

        void SendBodies()
        {
            if (Source == null) return;
            _samples.Clear();
            Source.Collect(_samples);
            foreach (SkeletonSample sample in _samples)
            {
                // Bodies and gazes share one time line: that of the client.
                if (_sourceStartNs == null) _sourceStartNs = Sensor.StampNs - sample.OriginatingNs;
                Pack(sample.Joints);
                Sensor.SendSkeleton(
                    sample.BodyId, sample.Format, _numbers, _sourceStartNs.Value + sample.OriginatingNs);
            }
        }

        void SendGaze()
        {
            Point3 origin, direction;
            _untilGaze -= Time.deltaTime;
            if (_face != FaceKind.Gaze || _untilGaze > 0) return;
            _untilGaze = 1 / _gazeRate;
            if (Gaze.TryGetGaze(out origin, out direction)) Sensor.SendGaze(origin, direction);
        }

        FaceKind Face()
        {
            if (_expectFace) return FaceKind.Expected;
            return Gaze != null && Gaze.HasGaze ? FaceKind.Gaze : FaceKind.None;
        }

        void Begin()
        {
            try
            {
                if (Sensor == null) Sensor = MakeSensor();
            }
            catch (ArgumentException wrong)
            {
                Debug.LogError("The sender '" + name + "' does not connect. " + wrong.Message + ".", this);
                return;
            }
            Sensor.Connection.Start();
        }

        void Disconnect(int waitMs)
        {
            if (Sensor != null) Sensor.Connection.Stop(waitMs);
        }

        SensorClient MakeSensor()
        {
            _face = Face();
            _sourceStartNs = null;
            ConnectionSettings settings = Server.For(Role.Sensor);
            settings.TakeOver = _takeOver;
            settings.Face = _face;
            var made = new SensorClient(settings, _transports ?? _platform.Factory, _clock);
            made.Refused += Warn;
            new ConnectionLog(made.Connection, "sensor", this);
            return made;
        }

        void Warn(ErrorMessage error)
        {
            if (!error.Fatal)
                Debug.LogWarning("The server refused a message (" + error.Code + "): " + error.Message, this);
        }

        void Pack(IReadOnlyList<JointSample> joints)
        {
            if (_numbers.Length != NumbersPerJoint * joints.Count) _numbers = new float[NumbersPerJoint * joints.Count];
            for (int i = 0; i < joints.Count; i++)
            {
                int at = NumbersPerJoint * i;
                _numbers[at] = (float)joints[i].X;
                _numbers[at + 1] = (float)joints[i].Y;
                _numbers[at + 2] = (float)joints[i].Z;
                _numbers[at + 3] = (float)joints[i].Confidence;
            }
        }
    }
}
