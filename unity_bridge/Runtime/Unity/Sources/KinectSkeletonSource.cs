using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>How far a Kinect v2 trusts a joint; its SDK's <c>TrackingState</c>.</summary>
    public enum KinectTracking
    {
        /// <summary>Not seen.</summary>
        NotTracked,

        /// <summary>Guessed from others.</summary>
        Inferred,

        /// <summary>Seen.</summary>
        Tracked,
    }

    /// <summary>A joint of a Kinect v2: metres in its camera space.</summary>
    public struct KinectJoint
    {
        /// <summary>To the sensor's left.</summary>
        public float X;

        /// <summary>Up.</summary>
        public float Y;

        /// <summary>Away from the sensor.</summary>
        public float Z;

        /// <summary>How far it can be trusted.</summary>
        public KinectTracking Tracking;
    }

    /// <summary>A body of a Kinect v2.</summary>
    public sealed class KinectBody
    {
        /// <summary>Its SDK's <c>TrackingId</c>, which counts from 2^56.</summary>
        public ulong TrackingId;

        /// <summary>25 joints in the order of its SDK's <c>JointType</c>.</summary>
        public readonly KinectJoint[] Joints = new KinectJoint[JointTable.KinectV2.Names.Count];
    }

    /// <summary>
    /// What is asked of the Kinect v2 SDK. The package does not ship the SDK; the manual has an
    /// implementation to copy beside it.
    /// </summary>
    public interface IKinectBodies
    {
        /// <summary>Whether a frame came since the last call.</summary>
        /// <param name="relativeTicks">The frame's <c>RelativeTime</c>, in units of 100 ns.</param>
        /// <param name="bodies">Cleared, then filled with the tracked bodies.</param>
        bool TryGetFrame(out long relativeTicks, List<KinectBody> bodies);
    }

    /// <summary>Bodies of a Kinect v2.</summary>
    public sealed class KinectSkeletonSource : ISkeletonSource
    {
        const long NsPerTick = 100;

        readonly IKinectBodies _kinect;
        readonly List<KinectBody> _bodies = new List<KinectBody>();
        readonly SensorTime _time = new SensorTime();

        /// <param name="kinect">The sensor.</param>
        public KinectSkeletonSource(IKinectBodies kinect)
        {
            _kinect = kinect;
        }

        /// <inheritdoc/>
        public void Collect(List<SkeletonSample> samples)
        {
            long ticks, stamp;
            if (!_kinect.TryGetFrame(out ticks, _bodies)) return;
            if (!_time.TryStamp(ticks * NsPerTick, out stamp)) return;
            foreach (KinectBody body in _bodies)
            {
                var joints = new JointSample[body.Joints.Length];
                for (int i = 0; i < joints.Length; i++)
                {
                    KinectJoint joint = body.Joints[i];
                    joints[i] = new JointSample(joint.X, joint.Y, joint.Z, Confidence(joint.Tracking));
                }
                samples.Add(new SkeletonSample(
                    stamp, SensorTime.BodyId(body.TrackingId), JointTable.KinectV2.Format, joints));
            }
        }

        static double Confidence(KinectTracking tracking) => (int)tracking / 2.0;
    }
}
