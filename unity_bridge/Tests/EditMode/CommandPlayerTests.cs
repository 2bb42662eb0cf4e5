using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class CommandPlayerTests
    {
        FakeBody _body;
        FakeReport _report;
        CommandPlayer _player;

        [SetUp]
        public void MakePlayer()
        {
            _body = new FakeBody();
            _report = new FakeReport();
            _player = new CommandPlayer(_body, _report);
        }

        [Test]
        public void StepsFollowEachOtherAndEachIsReported()
        {
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1), Make.Step("close", 2, "window")));
            Play(4, 1);
            Assert.AreEqual(new[] { "stand_up", "close window" }, _body.Said.ToArray());
            Assert.AreEqual(new[] { "start c1", "progress 0", "progress 1", "done c1" }, _report.Said.ToArray());
            Assert.IsTrue(_player.Command == null);
        }

        [Test]
        public void NothingIsDoneBeforeItsTime()
        {
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1)));
            Play(9, 0.1f);
            Assert.AreEqual(new[] { "start c1" }, _report.Said.ToArray());
            Play(2, 0.1f);
            Assert.AreEqual("done c1", Last(_report.Said));
        }

        [Test]
        public void AnAgentThatStandsDoesNotStandUp()
        {
            _body.IsStanding = true;
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1), Make.Step("close", 1, "window")));
            Play(1, 1);
            Assert.AreEqual(new[] { "close window" }, _body.Said.ToArray());
            Assert.AreEqual(new[] { "start c1", "progress 0", "progress 1", "done c1" }, _report.Said.ToArray());
        }

        [Test]
        public void ACommandOfNeedlessStepsIsDoneAtOnce()
        {
            _player.Begin(Make.Command("c1", Make.Step("sit_down", 1)));
            Assert.AreEqual(new[] { "start c1", "progress 0", "done c1" }, _report.Said.ToArray());
        }

        [Test]
        public void OneThatComesTooLateIsNotPlayed()
        {
            _report.IsTooLate = true;
            Assert.IsTrue(!_player.Begin(Make.Command("c1", Make.Step("stand_up", 1))));
            Play(3, 1);
            Assert.AreEqual(0, _body.Said.Count);
            Assert.AreEqual(new[] { "start c1" }, _report.Said.ToArray());
        }

        [Test]
        public void ACancelledOneStopsWithoutAWord()
        {
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1), Make.Step("close", 1, "window")));
            Play(1, 0.5f);
            _player.Cancel();
            Play(5, 1);
            Assert.AreEqual(new[] { "stand_up", "cut" }, _body.Said.ToArray());
            Assert.AreEqual(new[] { "start c1" }, _report.Said.ToArray());
        }

        [Test]
        public void TheNextOneStartsFromWhereTheAgentIs()
        {
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1), Make.Step("walk_to", 2, "window")));
            Play(3, 0.5f);
            _player.Begin(Make.Command("c2", Make.Step("stand_up", 1), Make.Step("walk_to", 1, "curtain")));
            Assert.AreEqual(new[] { "stand_up", "walk_to window", "cut", "walk_to curtain" }, _body.Said.ToArray());
        }

        [Test]
        public void AStepThatCannotBePlayedFailsTheCommand()
        {
            _body.Problem = "there is no lamp";
            _player.Begin(Make.Command("c1", Make.Step("dim", 1, "lamp"), Make.Step("open", 1, "window")));
            Play(3, 1);
            Assert.AreEqual(new[] { "start c1", "fail c1: there is no lamp" }, _report.Said.ToArray());
        }

        [Test]
        public void OneThatIsOverForTheServerIsPlayedNoFurther()
        {
            _report.OverAfter = 0;
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1), Make.Step("open", 1, "window")));
            Play(5, 1);
            Assert.AreEqual(new[] { "stand_up" }, _body.Said.ToArray());
            Assert.AreEqual(new[] { "start c1", "progress 0" }, _report.Said.ToArray());
        }

        [Test]
        public void AnAbandonedOneSaysWhy()
        {
            _player.Begin(Make.Command("c1", Make.Step("stand_up", 1)));
            _player.Abandon("switched off");
            _player.Abandon("switched off");
            Assert.AreEqual(new[] { "start c1", "fail c1: switched off" }, _report.Said.ToArray());
            Assert.AreEqual("cut", Last(_body.Said));
        }

        void Play(int frames, float seconds)
        {
            for (int i = 0; i < frames; i++) _player.Update(seconds);
        }

        static string Last(List<string> said) => said[said.Count - 1];
    }
}
