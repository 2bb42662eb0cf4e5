using System.Collections.Generic;

namespace AgentServer.Tests
{
    /// <summary>Chance that always falls the same way.</summary>
    sealed class FixedRandom : IRandom
    {
        public double Unit = 0.5;

        public double NextUnit() => Unit;
    }

    /// <summary>Messages as a server sends them, with what a test does not look at filled in.</summary>
    static class Make
    {
        public static Welcome Welcome(
            string ledger = "l1",
            string epoch = "e1",
            double heartbeatS = 2,
            string protocol = "1.0",
            IReadOnlyList<Difference> differences = null)
        {
            return new Welcome(
                protocol, "agent-server", "1.0", "lab", Role.Renderer, epoch, ledger, false, 0, heartbeatS,
                new[] { "cold", "heat" },
                new GateLevels("required", -2, 2, -1, 1),
                new DecideLevels(new Dictionary<string, double> { { "cold", 0.6 } }, 0.4),
                new Limits(1000000, 1000000, 20),
                new ModelInfo[0],
                Scene(),
                differences);
        }

        public static SceneState Scene(string window = "open")
        {
            return new SceneState("working", new Dictionary<string, string> { { "window", window } });
        }

        public static CommandMessage Command(string id, long sequence, long ttlMs = 5000, long ageMs = 0)
        {
            return new CommandMessage(
                id, sequence, "e1", "close_window", "cold", new[] { new StepMessage("stand_up", 1.2) }, 10, 0, 0,
                ttlMs, ageMs: ageMs);
        }
    }
}
