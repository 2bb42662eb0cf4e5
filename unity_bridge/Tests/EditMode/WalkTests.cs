using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class WalkTests
    {
        [Test]
        public void ItTurnsGoesAndTurns()
        {
            Quaternion rotation = Quaternion.identity;
            Quaternion facing = Quaternion.Euler(0, 180, 0);
            var walk = new Walk(Vector3.zero, new Vector3(2, 5, 0), facing, 1, 180, 10);
            // A quarter of a turn takes half a second.
            Go(walk, 5, ref rotation);
            Assert.IsTrue(walk.Position.x < 0.15f);
            Assert.AreEqual(0, Vector3.Angle(Vector3.right, rotation * Vector3.forward), 1.0);
            Go(walk, 10, ref rotation);
            Assert.IsTrue(walk.Position.x > 0.8f && walk.Position.x < 1.2f, walk.Position.ToString());
            Assert.IsTrue(walk.IsStepping);
            Go(walk, 25, ref rotation);
            Assert.AreEqual(new Vector3(2, 0, 0), walk.Position);
            Assert.AreEqual(0, Quaternion.Angle(facing, rotation), 1.0);
            Assert.IsTrue(walk.Go(0.1f, ref rotation));
        }

        [Test]
        public void ALongWayIsGoneInItsTime()
        {
            Quaternion rotation = Quaternion.LookRotation(Vector3.right);
            var walk = new Walk(Vector3.zero, new Vector3(8, 0, 0), rotation, 1, 180, 2);
            Go(walk, 20, ref rotation);
            Assert.IsTrue(walk.Go(0.1f, ref rotation), walk.Position.ToString());
        }

        [Test]
        public void WhoIsThereOnlyTurns()
        {
            Quaternion rotation = Quaternion.identity;
            var walk = new Walk(Vector3.one, Vector3.one, Quaternion.Euler(0, 90, 0), 1, 180, 2);
            Assert.IsTrue(!walk.Go(0.1f, ref rotation));
            Assert.IsTrue(!walk.IsStepping);
            Go(walk, 5, ref rotation);
            Assert.AreEqual(90, Quaternion.Angle(Quaternion.identity, rotation), 1.0);
            Assert.AreEqual(Vector3.one, walk.Position);
        }

        static void Go(Walk walk, int frames, ref Quaternion rotation)
        {
            for (int i = 0; i < frames; i++) walk.Go(0.1f, ref rotation);
        }
    }
}
