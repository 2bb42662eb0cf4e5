using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class IdleTests
    {
        static readonly IdleStep[] Table =
        {
            new IdleStep("type_on", "keyboard", 4, 6),
            new IdleStep("look_at", "screen", 1, 3),
            new IdleStep("look_at_person", "", 1, 1),
        };

        [Test]
        public void WeightsSayHowOften()
        {
            Assert.AreEqual("type_on", IdleChooser.Choose(Table, 0).Action);
            Assert.AreEqual("type_on", IdleChooser.Choose(Table, 0.59).Action);
            Assert.AreEqual("screen", IdleChooser.Choose(Table, 0.61).Target);
            Assert.AreEqual("look_at_person", IdleChooser.Choose(Table, 0.95).Action);
            Assert.IsTrue(IdleChooser.Choose(Table, 0.95).Target == null);
        }

        [Test]
        public void AnEmptyTableHasNothing()
        {
            Assert.IsTrue(IdleChooser.Choose(new IdleStep[0], 0.5) == null);
            Assert.IsTrue(IdleChooser.Choose(new[] { new IdleStep("type_on", "", 1, 0) }, 0.5) == null);
        }

        [Test]
        public void OneStepFollowsTheOther()
        {
            var body = new FakeBody();
            var random = new FixedRandom { Unit = 0.7 };
            var loop = new IdleLoop(body, random);
            loop.Update(0.1f, Table, "chair");
            random.Unit = 0;
            for (int i = 0; i < 12; i++) loop.Update(0.1f, Table, "chair");
            Assert.AreEqual(new[] { "look_at screen", "type_on keyboard" }, body.Said.ToArray());
        }

        [Test]
        public void WhoStandsGoesBackToTheSeatFirst()
        {
            var body = new FakeBody { IsStanding = true };
            var loop = new IdleLoop(body, new FixedRandom());
            for (int i = 0; i < 40; i++) loop.Update(0.1f, Table, "chair");
            Assert.AreEqual(new[] { "walk_to chair", "sit_down", "type_on keyboard" }, body.Said.ToArray());
        }

        [Test]
        public void WhoMayStandStays()
        {
            var body = new FakeBody { IsStanding = true };
            new IdleLoop(body, new FixedRandom()).Update(0.1f, Table, null);
            Assert.AreEqual(new[] { "type_on keyboard" }, body.Said.ToArray());
        }

        [Test]
        public void ACutStopsItAndForgetsTheWayBack()
        {
            var body = new FakeBody { IsStanding = true };
            var loop = new IdleLoop(body, new FixedRandom());
            loop.Update(0.1f, Table, "chair");
            loop.Cut();
            loop.Update(0.1f, Table, null);
            Assert.AreEqual(new[] { "walk_to chair", "cut", "type_on keyboard" }, body.Said.ToArray());
        }

        [Test]
        public void WhoCannotGetToTheSeatDoesNotSitDown()
        {
            var body = new FakeBody { IsStanding = true, Problem = "there is no chair" };
            var loop = new IdleLoop(body, new FixedRandom());
            loop.Update(0.1f, Table, "chair");
            body.Problem = null;
            loop.Update(0.1f, Table, null);
            Assert.AreEqual(new[] { "type_on keyboard" }, body.Said.ToArray());
        }
    }
}
