using System;

namespace AgentServer
{
    /// <summary>Chance; given from outside, so that tests can name it.</summary>
    public interface IRandom
    {
        /// <summary>A number from 0 to below 1, uniform.</summary>
        double NextUnit();
    }

    /// <summary>Chance that differs from run to run.</summary>
    public sealed class SystemRandom : IRandom
    {
        // Clients that start together get other seeds, or full jitter would not part them.
        readonly Random _random = new Random(Guid.NewGuid().GetHashCode());

        /// <inheritdoc/>
        public double NextUnit() => _random.NextDouble();
    }
}
