using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>
    /// Sends what a sensor sees. Nothing waits: what cannot be sent now is dropped and counted, since a
    /// late frame is worth nothing. Stamps are nanoseconds of the sensor's clock, zero when it was made.
    /// </summary>
    public sealed class SensorClient
    {
        /// <summary>So many messages may wait in the socket before frames are dropped.</summary>
        public const int WaitingLimit = 8;

        const int NumbersPerJoint = 4;

        readonly long _startNs;
        readonly Coding _coding;
        byte[] _packed = Array.Empty<byte>();

        /// <summary>Makes a sensor; it does nothing before `Connection.Start()`.</summary>
        /// <param name="settings">Where to connect; the role must be sensor.</param>
        /// <param name="transports">Makes the sockets; null for `System.Net.WebSockets`.</param>
        /// <param name="clock">Monotonic clock; null for the machine's.</param>
        /// <param name="random">Chance of the waiting times; null for the machine's.</param>
        /// <exception cref="ArgumentException">If a setting is wrong.</exception>
        public SensorClient(
            ConnectionSettings settings,
            ITransportFactory transports = null,
            IClock clock = null,
            IRandom random = null)
        {
            Roles.Require(settings, Role.Sensor);
            _coding = settings.Coding;
            Connection = new Connection(settings, transports, clock, random);
            Connection.Received += OnMessage;
            _startNs = Connection.Clock.NowNs;
        }

        /// <summary>The server refused something that was sent, or says what went wrong.</summary>
        public event Action<ErrorMessage> Refused;

        /// <summary>The answer to a calibration.</summary>
        public event Action<CalibrationState> Calibrated;

        /// <summary>The connection.</summary>
        public Connection Connection { get; }

        /// <summary>The stamp of what is captured now.</summary>
        public long StampNs => Connection.Clock.NowNs - _startNs;

        /// <summary>What was sent since the start.</summary>
        public long Sent { get; private set; }

        /// <summary>What was dropped since the start: there was no connection, or it was too slow.</summary>
        public long Dropped { get; private set; }

        /// <summary>Handles what has come; call it regularly.</summary>
        public void Poll()
        {
            Connection.Poll();
        }

        /// <summary>Sends one body.</summary>
        /// <param name="bodyId">The tracker's identity of the body.</param>
        /// <param name="format">Joint table, for example `kinect_v2`.</param>
        /// <param name="joints">
        /// x, y, z and confidence of every joint in the order of the table, in the format's unit and
        /// frame. It may be used again afterwards.
        /// </param>
        /// <param name="stampNs">Capture time; null for now.</param>
        /// <returns>Whether it is sent.</returns>
        public bool SendSkeleton(long bodyId, string format, float[] joints, long? stampNs = null)
        {
            if (joints.Length % NumbersPerJoint != 0)
                throw new ArgumentException(
                    "joints has " + joints.Length + " numbers: give x, y, z and confidence of each joint");
            if (!HasRoom()) return Drop();
            long stamp = stampNs ?? StampNs;
            return _coding == Coding.Json
                ? Send(new Skeleton(stamp, bodyId, format, Joints(joints)))
                : Send(new PackedSkeleton(stamp, bodyId, format, Pack(joints)));
        }

        /// <summary>Sends the landmarks of a face.</summary>
        /// <param name="format">Order of the points.</param>
        /// <param name="width">Width of the image in pixels.</param>
        /// <param name="height">Height of the image in pixels.</param>
        /// <param name="points">x and y of each point of `dlib68`, x, y and z of a mesh, in pixels.</param>
        /// <param name="stampNs">Capture time; null for now.</param>
        /// <returns>Whether it is sent.</returns>
        public bool SendFace(FaceFormat format, int width, int height, float[] points, long? stampNs = null)
        {
            int numbers = format == FaceFormat.Dlib68 ? 2 : 3;
            if (points.Length % numbers != 0)
                throw new ArgumentException(
                    "points has " + points.Length + " numbers: give " + numbers + " for each point");
            if (!HasRoom()) return Drop();
            long stamp = stampNs ?? StampNs;
            return _coding == Coding.Json
                ? Send(new FacePoints(stamp, format, width, height, Rows(points, numbers)))
                : Send(new PackedFacePoints(stamp, format, width, height, Pack(points)));
        }

        /// <summary>Sends each of ARKit's 52 blendshapes by its name, from 0 to 1.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool SendBlendshapes(IReadOnlyDictionary<string, double> values, long? stampNs = null)
        {
            return SendOrDrop(new Blendshapes(stampNs ?? StampNs, values));
        }

        /// <summary>Sends valence and arousal, each from -10 to 10.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool SendAffect(double valence, double arousal, long? stampNs = null)
        {
            return SendOrDrop(new Affect(stampNs ?? StampNs, valence, arousal));
        }

        /// <summary>Sends where the person looks, in the frame of the skeletons, in metres.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool SendGaze(Point3 origin, Point3 direction, long? stampNs = null)
        {
            return SendOrDrop(new Gaze(stampNs ?? StampNs, origin, direction));
        }

        /// <summary>Sends a picture of the face as JPEG.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool SendImage(byte[] jpeg, long? stampNs = null)
        {
            return SendOrDrop(new Image(stampNs ?? StampNs, jpeg));
        }

        /// <summary>Says that the face is neutral for the next seconds, above 0 and at most 30.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool Calibrate(double seconds)
        {
            return SendOrDrop(new Calibrate(StampNs, seconds: seconds));
        }

        /// <summary>Says what an earlier calibration of this person found.</summary>
        /// <returns>Whether it is sent.</returns>
        public bool Calibrate(double valence, double arousal)
        {
            return SendOrDrop(new Calibrate(StampNs, valence: valence, arousal: arousal));
        }

        void OnMessage(Message message)
        {
            if (message is ErrorMessage error) Refused?.Invoke(error);
            else if (message is CalibrationState state) Calibrated?.Invoke(state);
        }

        bool HasRoom() => Connection.Phase == Phase.Live && Connection.Waiting < WaitingLimit;

        bool SendOrDrop(Message message) => HasRoom() ? Send(message) : Drop();

        bool Send(Message message)
        {
            Connection.Send(message);
            Sent++;
            return true;
        }

        bool Drop()
        {
            Dropped++;
            return false;
        }

        /// <summary>Numbers as bytes, in a buffer that the next call uses again.</summary>
        byte[] Pack(float[] numbers)
        {
            if (_packed.Length != 4 * numbers.Length) _packed = new byte[4 * numbers.Length];
            Packed.Floats(numbers, _packed);
            return _packed;
        }

        static JointSample[] Joints(float[] numbers)
        {
            var joints = new JointSample[numbers.Length / NumbersPerJoint];
            for (int joint = 0; joint < joints.Length; joint++)
            {
                int at = NumbersPerJoint * joint;
                joints[joint] = new JointSample(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]);
            }
            return joints;
        }

        static IReadOnlyList<double>[] Rows(float[] numbers, int each)
        {
            var rows = new IReadOnlyList<double>[numbers.Length / each];
            for (int row = 0; row < rows.Length; row++)
            {
                var values = new double[each];
                for (int index = 0; index < each; index++) values[index] = numbers[each * row + index];
                rows[row] = values;
            }
            return rows;
        }
    }
}
