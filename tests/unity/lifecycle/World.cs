using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    /// <summary>A scene on the stand-in of the engine, with a server that is played by hand.</summary>
    public abstract class World
    {
        internal const float Frame = 1 / 50f;

        readonly Dictionary<MockTransport, int> _answered = new Dictionary<MockTransport, int>();
        internal MockTransportFactory Sockets;
        internal ManualClock Clock;

        [SetUp]
        public void Reset()
        {
            Lifecycle.Reset();
            _answered.Clear();
            Camera.main = null;
            Sockets = new MockTransportFactory();
            Clock = new ManualClock();
        }

        /// <summary>The last socket of a role.</summary>
        internal MockTransport Socket(string role) =>
            Sockets.Made.Last(one => one.Url != null && one.Url.EndsWith("/" + role));

        /// <summary>Lets frames pass, and the clock of the clients with them.</summary>
        internal void Pass(double seconds)
        {
            for (double left = seconds; left > 1e-6; left -= Frame)
            {
                Clock.Advance(Frame);
                Lifecycle.Frames(1, Frame);
                foreach (MockTransport socket in Sockets.Made) AnswerPings(socket);
            }
        }

        /// <summary>Opens the socket of a role and says welcome.</summary>
        internal MockTransport Greet(string role, SceneState scene = null, params Difference[] differences)
        {
            MockTransport socket = Socket(role);
            socket.Accept();
            Lifecycle.Frames(1, 0);
            socket.Say(WelcomeTo(scene ?? Scene("working"), differences));
            Lifecycle.Frames(1, 0);
            return socket;
        }

        internal static SceneState Scene(string mode, string window = "open") => new SceneState(
            mode,
            new Dictionary<string, string>
            {
                { "window", window }, { "hifi", "high" }, { "cigarette", "lit" }, { "curtain", "open" },
            });

        internal static CommandMessage CloseWindow(string id, long sequence) => new CommandMessage(
            id, sequence, "e1", "close_window", "cold",
            new[]
            {
                new StepMessage("stand_up", 1.2), new StepMessage("walk_to", 2, "window"),
                new StepMessage("close", 1.5, "window"), new StepMessage("walk_to", 2, "chair"),
                new StepMessage("sit_down", 1.3),
            },
            10, 0, 0, 5000);

        /// <summary>What the client said on commands: status, and step or reason.</summary>
        internal static string[] Words(MockTransport socket) => socket.Heard.OfType<AckMessage>()
            .Select(one => (one.Status.Text() + " " + one.Step + one.Reason).Trim())
            .ToArray();

        internal static int Logged(string part) => Debug.Lines.Count(line => line.Contains(part));

        void AnswerPings(MockTransport socket)
        {
            Ping[] pings = socket.Heard.OfType<Ping>().ToArray();
            int answered;
            _answered.TryGetValue(socket, out answered);
            foreach (Ping ping in pings.Skip(answered)) socket.Say(new Pong(ping.SentNs, Clock.NowNs));
            _answered[socket] = pings.Length;
        }

        static Welcome WelcomeTo(SceneState scene, IReadOnlyList<Difference> differences) => new Welcome(
            "1.0", "agent-server", "1.0", "demo", Role.Renderer, "e1", "l1", false, 0, 2,
            new[] { "cold" },
            new GateLevels("off", -2, 2, -1, 1),
            new DecideLevels(new Dictionary<string, double>(), 0.4),
            new Limits(1000000, 1000000, 20),
            new ModelInfo[0],
            scene,
            differences);
    }
}
