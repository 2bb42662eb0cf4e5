using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>Plays a recording against a clock that its user moves on.</summary>
    public sealed class SkeletonPlayer
    {
        /// <summary>Pause between the last sample and the first one of the next round, in nanoseconds.</summary>
        const long PauseNs = 40000000;

        readonly SkeletonRecording _recording;
        readonly bool _isLoop;
        double _nowNs;
        long _roundNs;
        int _next;

        /// <param name="recording">What is played.</param>
        /// <param name="isLoop">Whether it begins anew at its end; stamps go on.</param>
        public SkeletonPlayer(SkeletonRecording recording, bool isLoop)
        {
            _recording = recording;
            _isLoop = isLoop;
        }

        /// <summary>Whether everything was played.</summary>
        public bool IsOver => _next == _recording.Samples.Count;

        /// <summary>Adds what falls due in the next so many seconds, the first time from 0 on.</summary>
        public void Advance(double seconds, List<SkeletonSample> samples)
        {
            _nowNs += seconds * 1e9;
            while (!IsOver)
            {
                SkeletonSample next = _recording.Samples[_next];
                long at = _roundNs + next.OriginatingNs;
                if (at > _nowNs) return;
                samples.Add(new SkeletonSample(at, next.BodyId, next.Format, next.Joints));
                _next++;
                if (!IsOver || !_isLoop) continue;
                _next = 0;
                _roundNs += _recording.DurationNs + PauseNs;
            }
        }
    }
}
