using System.Diagnostics;

namespace AgentServer.ConsoleClient
{
    /// <summary>The machine's monotonic clock as it stands: on Linux all processes have the same.</summary>
    sealed class MachineClock : IClock
    {
        static readonly double NsPerTick = 1e9 / Stopwatch.Frequency;

        /// <inheritdoc/>
        public long NowNs => (long)(Stopwatch.GetTimestamp() * NsPerTick);
    }
}
