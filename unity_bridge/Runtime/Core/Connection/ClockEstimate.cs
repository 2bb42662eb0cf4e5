using System;

namespace AgentServer
{
    /// <summary>
    /// Estimates the server's clock less the own one from pings and pongs. The sample with the smallest
    /// round trip of the last eight counts: its way there and back was the most even.
    /// </summary>
    public sealed class ClockEstimate
    {
        const int SampleCount = 8;
        const int JumpCount = 3;
        const long ToleranceNs = 50000000;

        readonly long[] _roundTrips = new long[SampleCount];
        readonly long[] _offsets = new long[SampleCount];
        int _count;
        int _next;
        int _astray;

        /// <summary>The server's clock less the own one; null before the first pong.</summary>
        public long? OffsetNs { get; private set; }

        /// <summary>Smallest round trip of the last samples; null before the first pong.</summary>
        public long? RoundTripNs { get; private set; }

        /// <summary>Forgets everything.</summary>
        public void Reset()
        {
            OffsetNs = null;
            RoundTripNs = null;
            _count = 0;
            _next = 0;
            _astray = 0;
        }

        /// <summary>Takes the times of one ping and its pong.</summary>
        /// <param name="sentNs">Own clock when the ping was sent.</param>
        /// <param name="timeNs">The server's clock when it answered.</param>
        /// <param name="nowNs">Own clock when the pong came.</param>
        /// <returns>Whether one of the clocks has jumped.</returns>
        public bool Add(long sentNs, long timeNs, long nowNs)
        {
            long roundTrip = nowNs - sentNs;
            if (roundTrip < 0) return false;
            long offset = timeNs + roundTrip / 2 - nowNs;
            bool isAstray = IsAstray(roundTrip, offset);
            bool hasJumped = Math.Abs(_astray) == JumpCount;
            if (isAstray && !hasJumped) return false;
            if (hasJumped) Reset();
            _roundTrips[_next] = roundTrip;
            _offsets[_next] = offset;
            _next = (_next + 1) % SampleCount;
            _count = Math.Min(_count + 1, SampleCount);
            int best = Best();
            RoundTripNs = _roundTrips[best];
            OffsetNs = OffsetNs == null ? _offsets[best] : Follow(OffsetNs.Value, _offsets[best]);
            return hasJumped;
        }

        /// <summary>How far the estimate may be off, by the sample that it goes by.</summary>
        long OffByNs => (RoundTripNs ?? 0) / 2;

        /// <summary>A quarter of the way to the best sample, and into the range in which it lies for sure.</summary>
        long Follow(long offset, long best)
        {
            long followed = offset + (best - offset >> 2);
            return Math.Min(Math.Max(followed, best - OffByNs), best + OffByNs);
        }

        /// <summary>Whether a sample lies too far from the estimate to be followed; counts such in a row.</summary>
        bool IsAstray(long roundTrip, long offset)
        {
            if (OffsetNs == null) return false;
            long difference = offset - OffsetNs.Value;
            int side = Math.Sign(difference);
            bool isAstray = Math.Abs(difference) > ToleranceNs + roundTrip / 2 + OffByNs;
            if (!isAstray) _astray = 0;
            else _astray = Math.Sign(_astray) == side ? _astray + side : side;
            return isAstray;
        }

        int Best()
        {
            int best = 0;
            for (int index = 1; index < _count; index++)
                if (_roundTrips[index] < _roundTrips[best]) best = index;
            return best;
        }
    }
}
