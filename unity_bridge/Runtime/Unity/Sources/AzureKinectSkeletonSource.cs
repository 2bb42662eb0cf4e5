using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>How far an Azure Kinect trusts a joint; its SDK's <c>JointConfidenceLevel</c>.</summary>
    public enum AzureKinectConfidence
    {
        /// <summary>Out of range.</summary>
        None,

        /// <summary>Not seen, but predicted.</summary>
        Low,

        /// <summary>Seen; the present SDK gives no higher one.</summary>
        Medium,

        /// <summary>Reserved by the SDK.</summary>
        High,
    }

    /// <summary>A joint of an Azure Kinect: millimetres in its depth camera's space.</summary>
    public struct AzureKinectJoint
    {
        /// <summary>To the right of the image.</summary>
        public float X;

        /// <summary>Down.</summary>
        public float Y;

        /// <summary>Away from the sensor.</summary>
        public float Z;

        /// <summary>How far it can be trusted.</summary>
        public AzureKinectConfidence Confidence;
    }

    /// <summary>A body of an Azure Kinect.</summary>
    public sealed class AzureKinectBody
    {
        /// <summary>Its SDK's body id.</summary>
        public uint Id;

        /// <summary>32 joints in the order of its SDK's <c>JointId</c>.</summary>
        public readonly AzureKinectJoint[] Joints =
            new AzureKinectJoint[JointTable.AzureKinect.Names.Count];
    }

    /// <summary>
    /// What is asked of the Azure Kinect body tracking SDK. The package does not ship the SDK; the
    /// manual has an implementation to copy beside it.
    /// </summary>
    public interface IAzureKinectBodies
    {
        /// <summary>Whether a frame came since the last call; it does not wait for one.</summary>
        /// <param name="deviceMicroseconds">The frame's device time stamp.</param>
        /// <param name="bodies">Cleared, then filled with the tracked bodies.</param>
        bool TryGetFrame(out long deviceMicroseconds, List<AzureKinectBody> bodies);
    }

    /// <summary>Bodies of an Azure Kinect, or of an Orbbec camera with its wrapper of the same SDK.</summary>
    public sealed class AzureKinectSkeletonSource : ISkeletonSource
    {
        const long NsPerMicrosecond = 1000;
        static readonly double[] Levels = { 0, 0.5, 1, 1 };

        readonly IAzureKinectBodies _kinect;
        readonly List<AzureKinectBody> _bodies = new List<AzureKinectBody>();
        readonly SensorTime _time = new SensorTime();

        /// <param name="kinect">The sensor.</param>
        public AzureKinectSkeletonSource(IAzureKinectBodies kinect)
        {
            _kinect = kinect;
        }

        /// <inheritdoc/>
        public void Collect(List<SkeletonSample> samples)
        {
            long microseconds, stamp;
            if (!_kinect.TryGetFrame(out microseconds, _bodies)) return;
            if (!_time.TryStamp(microseconds * NsPerMicrosecond, out stamp)) return;
            foreach (AzureKinectBody body in _bodies)
            {
                var joints = new JointSample[body.Joints.Length];
                for (int i = 0; i < joints.Length; i++)
                {
                    AzureKinectJoint joint = body.Joints[i];
                    joints[i] = new JointSample(joint.X, joint.Y, joint.Z, Levels[(int)joint.Confidence]);
                }
                samples.Add(new SkeletonSample(stamp, body.Id, JointTable.AzureKinect.Format, joints));
            }
        }
    }
}
