using System;
using System.IO;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>
    /// Writes what a monitor hears: all messages as JSON lines, and the body as a track that
    /// <see cref="RecordedSkeletonSource"/> plays and `agent-server convert --from kinect-json` reads.
    /// </summary>
    public sealed class SessionRecorder : IDisposable
    {
        const string Header = "{\"format\": \"core9\"}";
        const long FrameNs = 40000000;

        readonly Codec _codec = Codec.Of(Coding.Json);
        readonly TextWriter _telemetry, _skeletons;
        long _offsetNs;
        long _lastNs = -1;

        /// <param name="telemetry">Gets every message, one a line.</param>
        /// <param name="skeletons">Gets the body.</param>
        public SessionRecorder(TextWriter telemetry, TextWriter skeletons)
        {
            _telemetry = telemetry;
            _skeletons = skeletons;
            _skeletons.WriteLine(Header);
        }

        /// <summary>Messages that were written.</summary>
        public int Messages { get; private set; }

        /// <summary>Frames of the body that were written.</summary>
        public int Frames { get; private set; }

        /// <summary>Takes a message.</summary>
        public void Take(Message message)
        {
            // What this version does not know has no form.
            if (message is UnknownMessage) return;
            _telemetry.WriteLine(_codec.Encode(message).Text);
            Messages++;
            var pose = message as PoseMessage;
            if (pose == null) return;
            // A session that was opened anew counts from 0 again; the track goes on.
            if (pose.OriginatingNs + _offsetNs <= _lastNs) _offsetNs = _lastNs + FrameNs - pose.OriginatingNs;
            _lastNs = pose.OriginatingNs + _offsetNs;
            _skeletons.WriteLine(
                _codec.Encode(new Skeleton(_lastNs, pose.BodyId, JointTable.Core9.Format, pose.Joints)).Text);
            Frames++;
        }

        /// <summary>Writes what waits and closes both.</summary>
        public void Dispose()
        {
            _telemetry.Dispose();
            _skeletons.Dispose();
        }
    }
}
