using System.Diagnostics;

namespace AgentServer
{
    /// <summary>A monotonic clock. It may be read on any thread.</summary>
    public interface IClock
    {
        /// <summary>Nanoseconds since some start, from 0 to 2^53 - 1.</summary>
        long NowNs { get; }
    }

    /// <summary>The machine's monotonic clock, zero when it was made.</summary>
    public sealed class SystemClock : IClock
    {
        static readonly double NsPerTick = 1e9 / Stopwatch.Frequency;
        readonly long _start = Stopwatch.GetTimestamp();

        /// <inheritdoc/>
        public long NowNs => (long)((Stopwatch.GetTimestamp() - _start) * NsPerTick);
    }

    /// <summary>A clock that stands until it is moved; for tests and for replay.</summary>
    public sealed class ManualClock : IClock
    {
        /// <inheritdoc/>
        public long NowNs { get; set; }

        /// <summary>Moves the clock on.</summary>
        public void Advance(double seconds)
        {
            NowNs += (long)(seconds * 1e9);
        }
    }
}
