#if AGENT_SERVER_KINECT_V2
using System.Collections.Generic;
using AgentServer.Unity;
using Windows.Kinect;

namespace AgentServer.Samples
{
    /// <summary>The bodies of a Kinect v2, with Microsoft's Kinect.2.0 package for Unity.</summary>
    public sealed class KinectV2Bodies : IKinectBodies
    {
        readonly BodyFrameReader _reader;
        readonly Body[] _bodies;

        /// <summary>Opens the sensor.</summary>
        public KinectV2Bodies()
        {
            KinectSensor sensor = KinectSensor.GetDefault();
            _reader = sensor.BodyFrameSource.OpenReader();
            _bodies = new Body[sensor.BodyFrameSource.BodyCount];
            if (!sensor.IsOpen) sensor.Open();
        }

        /// <inheritdoc/>
        public bool TryGetFrame(out long relativeTicks, List<KinectBody> bodies)
        {
            relativeTicks = 0;
            bodies.Clear();
            using (BodyFrame frame = _reader.AcquireLatestFrame())
            {
                if (frame == null) return false;
                // A tick of a TimeSpan is 100 ns, as is the sensor's.
                relativeTicks = frame.RelativeTime.Ticks;
                frame.GetAndRefreshBodyData(_bodies);
            }
            foreach (Body body in _bodies)
            {
                if (body != null && body.IsTracked) bodies.Add(Copy(body));
            }
            return true;
        }

        static KinectBody Copy(Body body)
        {
            var copy = new KinectBody { TrackingId = body.TrackingId };
            for (int i = 0; i < copy.Joints.Length; i++)
            {
                Joint joint = body.Joints[(JointType)i];
                copy.Joints[i] = new KinectJoint
                {
                    X = joint.Position.X,
                    Y = joint.Position.Y,
                    Z = joint.Position.Z,
                    Tracking = (KinectTracking)(int)joint.TrackingState,
                };
            }
            return copy;
        }
    }
}
#endif
