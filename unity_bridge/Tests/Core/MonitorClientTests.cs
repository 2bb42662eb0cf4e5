using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class MonitorClientTests
    {
        [Test]
        public void EachKindOfTelemetryHasAnEvent()
        {
            var sockets = new MockTransportFactory();
            var monitor = new MonitorClient(
                new ConnectionSettings { Role = Role.Monitor }, sockets, new ManualClock(), new FixedRandom());
            var seen = new List<string>();
            monitor.PoseReceived += message => seen.Add(message.Type);
            monitor.ForecastReceived += message => seen.Add(message.Type);
            monitor.AffectReceived += message => seen.Add(message.Type);
            monitor.CalibrationReceived += message => seen.Add(message.Type);
            monitor.CommandReceived += message => seen.Add(message.Type);
            monitor.AckReceived += message => seen.Add(message.Type);
            monitor.SceneChanged += message => seen.Add(message.Type);
            monitor.StatsReceived += message => seen.Add(message.Type);
            monitor.TelemetryMissed += message => seen.Add(message.Type);
            monitor.ErrorReceived += message => seen.Add(message.Type);
            monitor.DecisionReceived += message => seen.Add(message.Type);
            monitor.Connection.Start();
            sockets.Last.Accept();
            monitor.Poll();
            sockets.Last.Say(Make.Welcome());
            sockets.Last.Say(new PoseMessage(0, 1, new[] { new JointSample(0, 0, 1, 1) }));
            sockets.Last.Say(new ForecastMessage(0, 0, "last_frame", new[] { new[] { new Point3(1, 2, 3) } }));
            sockets.Last.Say(new AffectTelemetry(0, 0, 0));
            sockets.Last.Say(new CalibrationState(0, 0, 0, false));
            sockets.Last.Say(Make.Command("a", 1));
            sockets.Last.Say(new AckTelemetry("a", "assumed"));
            sockets.Last.Say(Make.Scene());
            sockets.Last.Say(new StatsMessage(0, 0, 0, 0, 0, 0, 0, 0, new Dictionary<string, long>()));
            sockets.Last.Say(new Missed(new Dictionary<string, long> { { "pose", 3 } }));
            sockets.Last.Say(new ErrorMessage("face_skew", "too far apart"));
            sockets.Last.Say(new DecisionMessage(Decision(), new Timing("now", 0, 0, 0, 0, 0)));
            monitor.Poll();
            Assert.AreEqual(
                new[]
                {
                    "scene", "pose", "forecast", "affect_state", "calibration_state", "command", "ack_state", "scene",
                    "stats", "missed", "error", "decision",
                },
                seen);
        }

        static DecisionBody Decision()
        {
            return new DecisionBody(
                "lab/d0", 0, 0, 0, 0, 1, new Dictionary<string, string>(),
                new QualityBody(1, 0, 0, new string[0]), "last_frame", null, new Dictionary<string, double>(), "cold",
                new GateBody("off", true, "off", null, null, null), null, "idle", "nothing happens", null);
        }
    }
}
