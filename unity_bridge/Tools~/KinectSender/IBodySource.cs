using System;
using System.Collections.Generic;

namespace AgentServer.KinectSender
{
    /// <summary>One body at one instant.</summary>
    readonly struct BodySample
    {
        /// <param name="trackingId">The tracker's identity of the body.</param>
        /// <param name="capturedAt">Capture time on the device's clock.</param>
        /// <param name="joints">x, y, z and confidence of every joint, in the format of the source.</param>
        public BodySample(ulong trackingId, TimeSpan capturedAt, float[] joints)
        {
            TrackingId = trackingId;
            CapturedAt = capturedAt;
            Joints = joints;
        }

        public ulong TrackingId { get; }

        public TimeSpan CapturedAt { get; }

        public float[] Joints { get; }
    }

    /// <summary>Something that sees bodies.</summary>
    interface IBodySource : IDisposable
    {
        /// <summary>Joint table of its bodies, as the protocol calls it.</summary>
        string Format { get; }

        /// <summary>Adds the bodies of the next frame, if there is one by now; may wait for some milliseconds.</summary>
        void Read(List<BodySample> bodies);
    }
}
