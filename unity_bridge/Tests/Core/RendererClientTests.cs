using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class RendererClientTests
    {
        ManualClock _clock;
        MockTransportFactory _sockets;
        RendererClient _renderer;
        List<string> _seen;

        [SetUp]
        public void SetUp()
        {
            Build(isMirror: false);
        }

        void Build(bool isMirror)
        {
            _clock = new ManualClock();
            _sockets = new MockTransportFactory();
            _seen = new List<string>();
            _renderer = new RendererClient(
                new ConnectionSettings { Mirror = isMirror }, _sockets, _clock, new FixedRandom());
            _renderer.CommandReceived += command => _seen.Add("command " + command.Id);
            _renderer.CommandCancelled += (command, reason) => _seen.Add("cancel " + command.Id + " " + reason);
            _renderer.SceneChanged += scene => _seen.Add("scene " + scene.Objects["window"]);
            _renderer.Reconciled += differences => _seen.Add("differences " + differences.Count);
            _renderer.Connection.Start();
            Connect(Make.Welcome());
        }

        void Connect(Welcome welcome)
        {
            _sockets.Last.Accept();
            _renderer.Poll();
            _sockets.Last.Say(welcome);
            _renderer.Poll();
        }

        void Say(Message message)
        {
            _sockets.Last.Say(message);
            _renderer.Poll();
        }

        void Break()
        {
            _sockets.Last.End(1006);
            _renderer.Poll();
        }

        void Return(Welcome welcome)
        {
            _clock.Advance(2);
            _renderer.Poll();
            Connect(welcome);
        }

        /// <summary>What was said of commands on the present socket, as `id status`.</summary>
        List<string> Words()
        {
            var words = new List<string>();
            foreach (Message message in _sockets.Last.Heard)
                if (message is AckMessage ack)
                    words.Add(ack.CommandId + " " + ack.Status.Text() + ack.Step + (ack.Reason == null ? "" : " " + ack.Reason));
            return words;
        }

        Hello LastHello() => (Hello)_sockets.Last.Heard[0];

        [Test]
        public void ACommandIsCarriedOutAndEveryStepIsSaid()
        {
            Say(Make.Command("a", 1));
            Assert.IsTrue(_renderer.Start("a"));
            Assert.IsTrue(_renderer.Progress("a", 0));
            Assert.IsTrue(_renderer.Done("a"));
            Assert.AreEqual(new[] { "a accepted", "a started", "a progress0", "a done" }, Words());
            Assert.AreEqual(new[] { "scene open", "command a" }, _seen);
        }

        [Test]
        public void ANewCommandCancelsTheRunningOneFirst()
        {
            Say(Make.Command("a", 1));
            Say(Make.Command("b", 2));
            Assert.AreEqual(new[] { "a accepted", "a failed preempted", "b accepted" }, Words());
            Assert.AreEqual(new[] { "scene open", "command a", "cancel a preempted", "command b" }, _seen);
            Assert.IsTrue(!_renderer.Progress("a", 0));
        }

        [Test]
        public void TimeRunsFromTheArrivalNotFromThePoll()
        {
            _sockets.Last.Say(Make.Command("a", 1, ttlMs: 1000));
            _clock.Advance(1.1);
            _renderer.Poll();
            Assert.IsTrue(!_renderer.Start("a"));
            Assert.AreEqual(new[] { "a accepted", "a failed expired" }, Words());
        }

        [Test]
        public void ACommandThatComesAgainIsCarriedOutOnce()
        {
            Say(Make.Command("a", 1));
            _renderer.Start("a");
            Break();
            Assert.IsTrue(_renderer.Done("a"));
            Return(Make.Welcome(epoch: "e2"));
            Say(Make.Command("a", 1, ageMs: 2000));
            Assert.AreEqual(new[] { "a done", "a done" }, Words());
            Assert.AreEqual(new[] { "scene open", "command a", "scene open" }, _seen);
        }

        [Test]
        public void HelloTellsWhatIsKnownAndShown()
        {
            Assert.AreEqual(new[] { "heartbeat", "resume", "progress" }, LastHello().Capabilities);
            Assert.IsTrue(LastHello().Ledger == null && LastHello().LastSequence == null);
            Assert.IsTrue(LastHello().Objects == null);
            _renderer.Objects = () => new Dictionary<string, string> { { "window", "closed" } };
            Say(Make.Command("a", 4));
            Break();
            Return(Make.Welcome());
            Assert.AreEqual("l1", LastHello().Ledger);
            Assert.AreEqual(4, LastHello().LastSequence);
            Assert.AreEqual("closed", LastHello().Objects["window"]);
            Assert.AreEqual("e1", LastHello().LastEpoch);
        }

        [Test]
        public void AnotherLedgerCancelsWithoutAWord()
        {
            Say(Make.Command("a", 9));
            Break();
            Return(Make.Welcome(ledger: "l2"));
            Assert.AreEqual(0, Words().Count);
            Assert.AreEqual("cancel a forgotten", _seen[2]);
            Say(Make.Command("b", 1));
            Assert.AreEqual("command b", _seen[4]);
        }

        [Test]
        public void DifferencesAreTold()
        {
            Break();
            Return(Make.Welcome(differences: new[] { new Difference("window", "closed", "open", Authority.Server) }));
            Assert.AreEqual(new[] { "scene open", "differences 1", "scene open" }, _seen);
        }

        [Test]
        public void AnObjectIsReportedWhenThereIsAConnection()
        {
            Assert.IsTrue(_renderer.ReportObject("window", "closed"));
            var scene = (SceneEvent)_sockets.Last.Heard[_sockets.Last.Heard.Count - 1];
            Assert.AreEqual("closed", scene.State);
            Break();
            Assert.IsTrue(!_renderer.ReportObject("window", "open"));
        }

        [Test]
        public void MotionIsHandedOnForTheCommandUnderWayAlone()
        {
            var frames = new List<int>();
            _renderer.MotionReceived += stretch => frames.Add(stretch.FirstFrame);
            Say(Make.Command("a", 1));
            Say(Motion("a", 0));
            Say(Motion("b", 5));
            Say(Motion("a", 1));
            _renderer.Start("a");
            _renderer.Done("a");
            Say(Motion("a", 2));
            Assert.AreEqual(new[] { 0, 1 }, frames);
        }

        static PoseStreamMessage Motion(string command, int frame) => new PoseStreamMessage(
            command, frame, 25, new[] { "torso" }, new[] { new[] { new Point3(0, 1, 0) } });

        [Test]
        public void AMirrorSeesCommandsAndSaysNothing()
        {
            Build(isMirror: true);
            Say(Make.Command("a", 1));
            Assert.IsTrue(_renderer.Start("a"));
            Assert.IsTrue(_renderer.Done("a"));
            Assert.IsTrue(!_renderer.ReportObject("window", "closed"));
            Assert.AreEqual(0, Words().Count);
            Assert.AreEqual("command a", _seen[1]);
        }
    }
}
