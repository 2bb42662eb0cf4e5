using System;
using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class ConnectionTests
    {
        ManualClock _clock;
        FixedRandom _random;
        MockTransportFactory _sockets;
        Connection _connection;
        List<Phase> _phases;
        List<Message> _received;

        [SetUp]
        public void SetUp()
        {
            _clock = new ManualClock();
            _random = new FixedRandom();
            _sockets = new MockTransportFactory();
            _phases = new List<Phase>();
            _received = new List<Message>();
            Build(new ConnectionSettings { Session = "lab", Role = Role.Monitor, ClientName = "test" });
        }

        void Build(ConnectionSettings settings)
        {
            _connection = new Connection(settings, _sockets, _clock, _random);
            _connection.PhaseChanged += _phases.Add;
            _connection.Received += _received.Add;
        }

        void Pass(double seconds)
        {
            _clock.Advance(seconds);
            _connection.Poll();
        }

        void Greet()
        {
            _sockets.Last.Accept();
            _connection.Poll();
        }

        void GoLive(Welcome welcome = null)
        {
            if (_connection.Phase == Phase.Stopped) _connection.Start();
            Greet();
            _sockets.Last.Say(welcome ?? Make.Welcome());
            _connection.Poll();
        }

        T LastHeard<T>() where T : Message
        {
            IReadOnlyList<Message> heard = _sockets.Last.Heard;
            for (int index = heard.Count - 1; index >= 0; index--)
                if (heard[index] is T message) return message;
            return null;
        }

        [Test]
        public void ItGoesThroughThePhases()
        {
            Welcome seen = null;
            _connection.Welcomed += welcome => seen = welcome;
            GoLive();
            Assert.AreEqual(new[] { Phase.Opening, Phase.Greeting, Phase.Live }, _phases);
            Assert.AreEqual("l1", seen.Ledger);
            Assert.AreEqual("ws://127.0.0.1:8765/v1/sessions/lab/monitor", _sockets.Last.Url);
            Assert.IsTrue(_connection.Fault == null);
        }

        [Test]
        public void HelloSaysWhoItIs()
        {
            Build(new ConnectionSettings
            {
                Session = "lab", Role = Role.Monitor, ClientName = "test", ClientVersion = "2", Token = "secret",
                Topics = new[] { Topic.Pose }, Coding = Coding.MessagePack,
            });
            _connection.Start();
            Greet();
            Hello hello = LastHeard<Hello>();
            Assert.AreEqual("1.0", hello.Protocol);
            Assert.AreEqual("test", hello.Client);
            Assert.AreEqual("2", hello.ClientVersion);
            Assert.AreEqual("secret", hello.Token);
            Assert.AreEqual("lab", hello.Session);
            Assert.AreEqual(Role.Monitor, hello.Role);
            Assert.AreEqual(new[] { "heartbeat" }, hello.Capabilities);
            Assert.AreEqual(new[] { Topic.Pose }, hello.Topics);
            Assert.AreEqual(32, hello.Instance.Length);
            Assert.IsTrue(hello.LastEpoch == null);
        }

        [Test]
        public void AfterALossHelloNamesTheEpochAndTheSameInstance()
        {
            GoLive();
            string instance = LastHeard<Hello>().Instance;
            _sockets.Last.End(1006);
            Pass(0);
            Pass(0.2);
            Greet();
            Assert.AreEqual("e1", LastHeard<Hello>().LastEpoch);
            Assert.AreEqual(instance, LastHeard<Hello>().Instance);
        }

        [Test]
        public void ASocketThatDoesNotOpenIsTriedAgain()
        {
            _connection.Start();
            _sockets.Last.End(1006, "connection refused");
            Pass(0);
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
            Assert.IsTrue(_connection.Fault.Contains("connection refused"));
            Assert.AreEqual(125, _connection.NextAttemptInMs);
            Pass(0.124);
            Assert.AreEqual(1, _sockets.Made.Count);
            Pass(0.001);
            Assert.AreEqual(2, _sockets.Made.Count);
            Assert.AreEqual(Phase.Opening, _connection.Phase);
            Assert.IsTrue(_connection.NextAttemptInMs == null);
        }

        [Test]
        public void NoAnswerForTenSecondsEndsAnAttempt()
        {
            _connection.Start();
            Pass(9.9);
            Greet();
            Pass(9.9);
            Assert.AreEqual(Phase.Greeting, _connection.Phase);
            Pass(0.1);
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
            Assert.AreEqual(CloseCodes.HelloTimeout, _sockets.Last.ClosedWith);
        }

        [Test]
        public void AWelcomeSetsTheWaitBack()
        {
            _connection.Start();
            for (int attempt = 0; attempt < 5; attempt++)
            {
                _sockets.Last.End(1006);
                Pass(0);
                Pass(2);
            }
            GoLive();
            _sockets.Last.End(1006);
            Pass(0);
            Assert.AreEqual(125, _connection.NextAttemptInMs);
        }

        [Test]
        public void CodesThatSayLaterWaitFifteenSeconds()
        {
            GoLive();
            _sockets.Last.End(CloseCodes.Full);
            Pass(0);
            Assert.AreEqual(15000, _connection.NextAttemptInMs);
        }

        [Test]
        public void CodesThatSayNeverStopAndTellWhy()
        {
            GoLive();
            _sockets.Last.Say(new ErrorMessage("renderer_taken", "another one took over", fatal: true));
            _sockets.Last.End(CloseCodes.Replaced);
            Pass(0);
            Assert.AreEqual(Phase.Stopped, _connection.Phase);
            Assert.AreEqual("another one took over", _connection.Fault);
            Pass(60);
            Assert.AreEqual(1, _sockets.Made.Count);
        }

        [Test]
        public void RetryNowDoesNotWait()
        {
            GoLive();
            _sockets.Last.End(CloseCodes.Full);
            Pass(0);
            _connection.RetryNow();
            Assert.AreEqual(Phase.Opening, _connection.Phase);
            _connection.RetryNow();
            Assert.AreEqual(2, _sockets.Made.Count);
        }

        [Test]
        public void ItPingsEveryHeartbeatAndMeasuresTheClock()
        {
            _clock.NowNs = 5000000000;
            GoLive();
            Assert.AreEqual(5000000000, LastHeard<Ping>().SentNs);
            _clock.Advance(0.010);
            _sockets.Last.Say(new Pong(5000000000, 7005000000));
            Pass(0.5);
            Assert.AreEqual(10, _connection.RoundTripMs);
            Assert.AreEqual(2000000000, _connection.ClockOffsetNs);
            Pass(1.48);
            Assert.AreEqual(5000000000, LastHeard<Ping>().SentNs);
            Pass(0.01);
            Assert.AreEqual(7000000000, LastHeard<Ping>().SentNs);
        }

        [Test]
        public void ItAnswersPings()
        {
            GoLive();
            _clock.Advance(1);
            _sockets.Last.Say(new Ping(77));
            _connection.Poll();
            Assert.AreEqual(77, LastHeard<Pong>().SentNs);
            Assert.AreEqual(1000000000, LastHeard<Pong>().TimeNs);
        }

        [Test]
        public void SilenceForTwoAndAHalfHeartbeatsEndsAConnectionWithoutAGoodbye()
        {
            GoLive();
            Pass(4.9);
            Assert.AreEqual(Phase.Live, _connection.Phase);
            _sockets.Last.Say(Make.Scene());
            Pass(4.9);
            Assert.AreEqual(Phase.Live, _connection.Phase);
            Pass(0.2);
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
            Assert.AreEqual(CloseCodes.Silent, _sockets.Last.ClosedWith);
        }

        [Test]
        public void AnApplicationThatSleptHearsFirstWhatCameMeanwhile()
        {
            GoLive();
            _clock.Advance(20);
            _sockets.Last.Say(Make.Scene());
            _connection.Poll();
            Assert.AreEqual(Phase.Live, _connection.Phase);
        }

        [Test]
        public void AClockThatJumpsIsTold()
        {
            int jumps = 0;
            _connection.ClockJumped += () => jumps++;
            GoLive();
            foreach (long time in new long[] { 0, 500000000, 500000000, 500000000 })
                _sockets.Last.Say(new Pong(0, time));
            _connection.Poll();
            Assert.AreEqual(1, jumps);
            Assert.AreEqual(500000000, _connection.ClockOffsetNs);
        }

        [Test]
        public void EachConnectionHasAClockEstimateOfItsOwn()
        {
            GoLive();
            _sockets.Last.Say(new Pong(0, 500));
            _sockets.Last.End(1006);
            Pass(0);
            Pass(1);
            GoLive();
            Assert.IsTrue(_connection.ClockOffsetNs == null);
        }

        [Test]
        public void ADroppedSocketIsNotHeard()
        {
            GoLive();
            MockTransport old = _sockets.Last;
            old.Say(Make.Scene());
            old.End(1006);
            old.Say(Make.Scene());
            _connection.Poll();
            Assert.AreEqual(1, _received.Count);
            Pass(1);
            GoLive();
            old.Say(Make.Scene());
            old.End(CloseCodes.Replaced);
            _connection.Poll();
            Assert.AreEqual(Phase.Live, _connection.Phase);
            Assert.AreEqual(1, _received.Count);
        }

        [Test]
        public void WhatCannotBeReadOrIsUnknownIsPassedOver()
        {
            var reasons = new List<string>();
            _connection.Unreadable += reasons.Add;
            GoLive();
            _sockets.Last.Say(new Frame("{\"type\":\"from_the_future\",\"a\":[{}]}"));
            _sockets.Last.Say(new Frame("{\"type\":\"scene\",\"mode\":7}"));
            _sockets.Last.Say(Make.Scene());
            _connection.Poll();
            Assert.AreEqual(1, _received.Count);
            Assert.AreEqual(1, _connection.UnreadableMessages);
            Assert.IsTrue(reasons[0].StartsWith("mode: "));
        }

        [Test]
        public void AnAnswerToHelloThatCannotBeReadEndsTheAttempt()
        {
            _connection.Start();
            Greet();
            _sockets.Last.Say(new Frame("<html>"));
            _connection.Poll();
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
        }

        [Test]
        public void AServerOfAnotherMajorVersionIsAskedLater()
        {
            _connection.Start();
            Greet();
            _sockets.Last.Say(Make.Welcome(protocol: "2.0"));
            _connection.Poll();
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
            Assert.AreEqual(15000, _connection.NextAttemptInMs);
            Assert.IsTrue(_connection.Fault.Contains("2.0"));
        }

        [Test]
        public void StopSaysGoodbye()
        {
            GoLive();
            _connection.Stop();
            Assert.AreEqual(CloseCodes.Normal, _sockets.Last.ClosedWith);
            Assert.AreEqual(Phase.Stopped, _connection.Phase);
            Assert.IsTrue(!_connection.Send(new Ping(0)));
            Pass(60);
            Assert.AreEqual(1, _sockets.Made.Count);
            _connection.Start();
            Assert.AreEqual(Phase.Opening, _connection.Phase);
        }

        [Test]
        public void AHandlerMayStopTheConnectionAtEveryPhase()
        {
            foreach (Phase last in new[] { Phase.Opening, Phase.Greeting, Phase.Live })
            {
                SetUp();
                bool isWelcomed = false;
                _connection.Welcomed += welcome => isWelcomed = true;
                _connection.PhaseChanged += phase =>
                {
                    if (phase == last) _connection.Stop();
                };
                _connection.Start();
                if (last != Phase.Opening) GoLive();
                Assert.AreEqual(Phase.Stopped, _connection.Phase);
                Assert.IsTrue(!isWelcomed);
            }
        }

        [Test]
        public void WhatAHandlerThrowsComesOutAndTheRestFollows()
        {
            GoLive();
            bool isFirst = true;
            _connection.Received += message =>
            {
                if (isFirst)
                {
                    isFirst = false;
                    throw new InvalidOperationException();
                }
            };
            _sockets.Last.Say(Make.Scene("open"));
            _sockets.Last.Say(Make.Scene("closed"));
            Assert.Throws<InvalidOperationException>(() => _connection.Poll());
            _connection.Poll();
            Assert.AreEqual("closed", ((SceneState)_received[1]).Objects["window"]);
        }

        [Test]
        public void OfTelemetryTheOldestIsDroppedAndCommandsNever()
        {
            GoLive();
            for (int index = 0; index < 1000; index++)
            {
                _sockets.Last.Say(new AffectTelemetry(index, 0, 0));
                if (index % 2 == 0) _sockets.Last.Say(Make.Command("c" + index, index));
            }
            _connection.Poll();
            Assert.AreEqual(744, _connection.DroppedTelemetry);
            Assert.AreEqual(756, _received.Count);
            Assert.AreEqual("c0", ((CommandMessage)_received[0]).Id);
            Assert.AreEqual(999, ((AffectTelemetry)_received[755]).OriginatingNs);
            Assert.AreEqual("c998", ((CommandMessage)_received[754]).Id);
        }

        [Test]
        public void AnApplicationThatLetsTooMuchWaitLosesTheConnectionAndComesBack()
        {
            GoLive();
            for (int index = 0; index < 5000; index++) _sockets.Last.Say(Make.Command("c" + index, index));
            _connection.Poll();
            Assert.AreEqual(4096, _received.Count);
            Assert.AreEqual(Phase.Waiting, _connection.Phase);
            Assert.AreEqual(CloseCodes.TooSlow, _sockets.Last.ClosedWith);
            Pass(1);
            GoLive();
            Assert.AreEqual(Phase.Live, _connection.Phase);
        }

        [Test]
        public void APollWithoutNewsMakesNoGarbage()
        {
            GoLive();
            _connection.Poll();
            int before = GC.CollectionCount(0);
            for (int poll = 0; poll < 2000000; poll++) _connection.Poll();
            Assert.IsTrue(GC.CollectionCount(0) - before <= 1);
        }

        [Test]
        public void ArrivalsAreTold()
        {
            int arrivals = 0;
            _connection.Arrived += () => arrivals++;
            GoLive();
            Assert.AreEqual(2, arrivals);
        }

        [Test]
        public void SettingsThatCannotWorkAreRefused()
        {
            var wrong = new[]
            {
                new ConnectionSettings { Address = "localhost:8765" },
                new ConnectionSettings { Address = "ws://host/path" },
                new ConnectionSettings { Address = "ftp://host" },
                new ConnectionSettings { Address = null },
                new ConnectionSettings { Session = "a b" },
                new ConnectionSettings { Session = "" },
                new ConnectionSettings { Session = new string('a', 65) },
                new ConnectionSettings { ClientName = "" },
                new ConnectionSettings { ClientVersion = new string('1', 65) },
                new ConnectionSettings { Token = new string('t', 4097) },
                new ConnectionSettings { Mirror = true, Role = Role.Monitor },
                new ConnectionSettings { Mirror = true, TakeOver = true },
                new ConnectionSettings { TakeOver = true, Role = Role.Monitor },
                new ConnectionSettings { Topics = new Topic[0] },
                new ConnectionSettings { Face = FaceKind.Gaze },
            };
            foreach (ConnectionSettings settings in wrong)
                Assert.Throws<ArgumentException>(() => new Connection(settings, _sockets, _clock, _random));
        }

        [Test]
        public void AnHttpAddressWillDo()
        {
            var settings = new ConnectionSettings { Address = "https://host:1/", Session = "s", Role = Role.Sensor };
            Assert.AreEqual("wss://host:1/v1/sessions/s/sensor", settings.Url);
        }
    }
}
