using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class PoseStreamPlayerTests
    {
        PoseStreamPlayer _player;

        [SetUp]
        public void SetUp()
        {
            _player = new PoseStreamPlayer(0.2);
        }

        /// <summary>Five frames at 10 Hz; the hand rises by a metre a frame.</summary>
        static PoseStreamMessage Stretch(int first, bool isLast = false, string command = "s/c1")
        {
            var frames = new Point3[5][];
            for (int i = 0; i < 5; i++)
                frames[i] = new[] { new Point3(0, 0, 0), new Point3(0.5, first + i, 2) };
            return new PoseStreamMessage(command, first, 10, new[] { "torso", "hand" }, frames, isLast);
        }

        double Height()
        {
            Point3 place;
            return _player.Joint("hand", out place) ? place.Y : -1;
        }

        static void Near(double expected, double found)
        {
            Assert.AreEqual(expected, found, 1e-9);
        }

        [Test]
        public void ItPlaysBetweenFramesAndFadesInAndOut()
        {
            Near(-1, Height());
            _player.Push(Stretch(0));
            _player.Step(0.05);
            Near(0.5, Height());
            Near(0.25, _player.Weight);
            _player.Push(Stretch(5, isLast: true));
            _player.Step(0.6);
            Near(6.5, Height());
            Near(1, _player.Weight);
            _player.Step(0.2);
            Near(8.5, Height());
            _player.Step(0.1);
            Near(9, Height());
            Near(0.5, _player.Weight);
            _player.Step(0.1);
            Near(-1, Height());
            Near(0, _player.Weight);
        }

        [Test]
        public void ItWaitsALittleForMore()
        {
            _player.Push(Stretch(0));
            for (int i = 0; i < 8; i++) _player.Step(0.1);
            Near(4, Height());
            Near(1, _player.Weight);
            for (int i = 0; i < 6; i++) _player.Step(0.1);
            Near(0, _player.Weight);
            Near(-1, Height());
        }

        [Test]
        public void WhatComesAfterAGapIsNotPlayed()
        {
            _player.Push(Stretch(0));
            _player.Push(Stretch(10));
            _player.Push(Stretch(5));
            for (int i = 0; i < 12; i++) _player.Step(0.1);
            Near(0, _player.Weight);
        }

        [Test]
        public void AnotherCommandBeginsAnew()
        {
            _player.Push(Stretch(0, isLast: true));
            _player.Step(0.3);
            _player.Push(Stretch(0, command: "s/c2"));
            Near(0, Height());
            _player.Step(0.1);
            Near(1, Height());
            Near(1, _player.Weight);
        }

        [Test]
        public void ACutFadesOutFromWhereItIs()
        {
            _player.Push(Stretch(0));
            _player.Step(0.25);
            _player.Cut();
            _player.Step(0.1);
            Near(0.5, _player.Weight);
            _player.Step(0.1);
            Near(0, _player.Weight);
            Near(-1, Height());
        }

        [Test]
        public void AMotionThatIsNoGoodShowsNothing()
        {
            _player.Push(new PoseStreamMessage(
                "s/c1", 0, 25, new[] { "hand" }, new Point3[0][], isLast: true, fallback: "too fast"));
            _player.Step(0.1);
            Near(0, _player.Weight);
            Near(-1, Height());
        }

        [Test]
        public void JointsThatItHasNotAreNotTold()
        {
            Point3 place;
            _player.Push(Stretch(0));
            Assert.IsTrue(!_player.Joint("tail", out place));
        }
    }
}
