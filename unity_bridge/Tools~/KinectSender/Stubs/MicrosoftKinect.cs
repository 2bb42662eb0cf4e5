using System;
using System.Collections.Generic;

// What the sender uses of Microsoft.Kinect 2.0, without a device: for the compiler and for tests. Two
// bodies are seen, of which one is tracked; joint n lies at (n, n + 0.25, 2), and every third is inferred.
namespace Microsoft.Kinect
{
    public enum TrackingState
    {
        NotTracked = 0,
        Inferred = 1,
        Tracked = 2,
    }

    public enum JointType
    {
        SpineBase = 0,
        ThumbRight = 24,
    }

    public struct CameraSpacePoint
    {
        public float X { get; set; }

        public float Y { get; set; }

        public float Z { get; set; }
    }

    public struct Joint
    {
        public JointType JointType { get; set; }

        public CameraSpacePoint Position { get; set; }

        public TrackingState TrackingState { get; set; }
    }

    public sealed class Body
    {
        public bool IsTracked { get; internal set; }

        public ulong TrackingId { get; internal set; }

        public IReadOnlyDictionary<JointType, Joint> Joints { get; internal set; }
    }

    public sealed class BodyFrame : IDisposable
    {
        internal BodyFrame(TimeSpan at)
        {
            RelativeTime = at;
        }

        public int BodyCount => 2;

        public TimeSpan RelativeTime { get; }

        public void GetAndRefreshBodyData(IList<Body> bodies)
        {
            var joints = new Dictionary<JointType, Joint>();
            for (int index = 0; index <= (int)JointType.ThumbRight; index++)
            {
                joints[(JointType)index] = new Joint
                {
                    JointType = (JointType)index,
                    Position = new CameraSpacePoint { X = index, Y = index + 0.25f, Z = 2 },
                    TrackingState = index % 3 == 0 ? TrackingState.Inferred : TrackingState.Tracked,
                };
            }
            bodies[0] = new Body { Joints = joints };
            bodies[1] = new Body { IsTracked = true, TrackingId = 72057594037927941, Joints = joints };
        }

        public void Dispose()
        {
        }
    }

    public sealed class BodyFrameReader : IDisposable
    {
        static readonly TimeSpan Frame = TimeSpan.FromMilliseconds(33);

        readonly System.Diagnostics.Stopwatch _clock = System.Diagnostics.Stopwatch.StartNew();
        TimeSpan _next = TimeSpan.Zero;

        public BodyFrame AcquireLatestFrame()
        {
            if (_clock.Elapsed < _next) return null;
            _next += Frame;
            return new BodyFrame(TimeSpan.FromHours(1) + _next);
        }

        public void Dispose()
        {
        }
    }

    public sealed class BodyFrameSource
    {
        public BodyFrameReader OpenReader() => new BodyFrameReader();
    }

    public sealed class KinectSensor
    {
        public BodyFrameSource BodyFrameSource { get; } = new BodyFrameSource();

        public static KinectSensor GetDefault() => new KinectSensor();

        public void Open()
        {
        }

        public void Close()
        {
        }
    }
}
