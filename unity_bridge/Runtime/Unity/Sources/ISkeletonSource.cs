using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>One body at one instant, as its sensor sees it.</summary>
    public sealed class SkeletonSample
    {
        /// <param name="originatingNs">Capture time in nanoseconds on the source's clock, 0 at its start.</param>
        /// <param name="bodyId">The tracker's identity of the body, below 2^53.</param>
        /// <param name="format">Joint table, for example `kinect_v2`.</param>
        /// <param name="joints">Every joint of the table, in its order, unit and axes.</param>
        public SkeletonSample(
            long originatingNs, long bodyId, string format, IReadOnlyList<JointSample> joints)
        {
            OriginatingNs = originatingNs;
            BodyId = bodyId;
            Format = format;
            Joints = joints;
        }

        /// <summary>Capture time in nanoseconds on the source's clock, 0 at its start.</summary>
        public long OriginatingNs { get; }

        /// <summary>The tracker's identity of the body, below 2^53.</summary>
        public long BodyId { get; }

        /// <summary>Joint table, for example `kinect_v2`.</summary>
        public string Format { get; }

        /// <summary>Every joint of the table, in its order, unit and axes.</summary>
        public IReadOnlyList<JointSample> Joints { get; }
    }

    /// <summary>
    /// Where bodies come from: a depth camera, a recording, anything. A component that is one, on the
    /// object of a <see cref="SkeletonSender"/>, is found by it.
    /// </summary>
    public interface ISkeletonSource
    {
        /// <summary>
        /// Adds what was captured since the last call, in the order of capture. Called once a frame on
        /// the main thread; it does not wait.
        /// </summary>
        void Collect(List<SkeletonSample> samples);
    }

    /// <summary>Where the person looks.</summary>
    public interface IGazeSource
    {
        /// <summary>Whether the eyes or the head can be read; the hello says `gaze`, or else `none`.</summary>
        bool HasGaze { get; }

        /// <summary>The present ray in the frame of the skeletons, metres; false if there is none.</summary>
        bool TryGetGaze(out Point3 origin, out Point3 direction);
    }
}
