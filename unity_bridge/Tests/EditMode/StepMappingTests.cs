using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class StepMappingTests
    {
        static readonly StepMapping[] Table =
        {
            new StepMapping("close", animatorState: "Push"),
            new StepMapping("close", "curtain", "Draw", 3),
            new StepMapping("sit_down", animatorState: "Sit"),
        };

        [Test]
        public void TheLineOfAnObjectGoesBeforeTheGeneralOne()
        {
            Assert.AreEqual("Draw", StepMapping.Find(Table, Make.Step("close", 1, "curtain")).AnimatorState);
            Assert.AreEqual("Push", StepMapping.Find(Table, Make.Step("close", 1, "window")).AnimatorState);
            Assert.AreEqual("Sit", StepMapping.Find(Table, Make.Step("sit_down", 1)).AnimatorState);
        }

        [Test]
        public void AnUnknownStepHasNone()
        {
            Assert.IsTrue(StepMapping.Find(Table, Make.Step("dance", 1)) == null);
        }

        [Test]
        public void AClipEndsWithItsStep()
        {
            Assert.AreEqual(2, StepMapping.Find(Table, Make.Step("close", 1.5, "curtain")).Speed(1.5), 1e-6);
            Assert.AreEqual(1, StepMapping.Find(Table, Make.Step("close", 1.5)).Speed(1.5), 1e-6);
        }
    }
}
