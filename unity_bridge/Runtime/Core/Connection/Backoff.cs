using System;

namespace AgentServer
{
    /// <summary>
    /// How long to wait before the next attempt to connect: uniform between 0 and a bound that doubles
    /// (full jitter), low while the connection has not been gone for long.
    /// </summary>
    public sealed class Backoff
    {
        /// <summary>Bound of the first wait.</summary>
        public const long FirstNs = 250000000;

        /// <summary>Largest bound in the first <see cref="PatienceNs"/>.</summary>
        public const long QuickNs = 1500000000;

        /// <summary>So long without a connection, a server that comes back is found within 2 s.</summary>
        public const long PatienceNs = 20000000000;

        /// <summary>Largest bound; also the wait after a close that says *later*.</summary>
        public const long LongestNs = 15000000000;

        readonly IRandom _random;
        long _since;
        long _bound = FirstNs;

        /// <summary>Makes one.</summary>
        public Backoff(IRandom random)
        {
            _random = random;
        }

        /// <summary>A time without a connection begins: the bound is the first one again.</summary>
        public void Begin(long nowNs)
        {
            _since = nowNs;
            _bound = FirstNs;
        }

        /// <summary>How long to wait after an attempt or a connection that has ended now.</summary>
        public long NextNs(long nowNs)
        {
            long largest = nowNs - _since < PatienceNs ? QuickNs : LongestNs;
            _bound = Math.Min(_bound, largest);
            long wait = (long)(_random.NextUnit() * _bound);
            _bound = Math.Min(2 * _bound, largest);
            return wait;
        }
    }
}
