using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class PoseFollowerTests
    {
        const float Least = 0.3f;
        const int Arm = (int)AvatarBone.RightUpperArm;

        [Test]
        public void TheFirstPoseIsTakenAtOnce()
        {
            var follower = new PoseFollower();
            follower.Aim(new PoseSolver(), Make.Person(), Least);
            Assert.AreEqual(90, Quaternion.Angle(Quaternion.identity, follower.Rotations[Arm]), 0.1);
        }

        [Test]
        public void ItGoesMostOfTheWayInOneTimeConstant()
        {
            PoseFollower follower = Raised();
            Quaternion before = follower.Rotations[Arm];
            follower.Step(0.1f, 0.1f);
            // 1 - 1/e of half a turn.
            Assert.AreEqual(180 * 0.632, Quaternion.Angle(before, follower.Rotations[Arm]), 1.0);
        }

        [Test]
        public void ManySmallStepsAreOneLargeOne()
        {
            PoseFollower one = Raised();
            PoseFollower many = Raised();
            one.Step(0.1f, 0.08f);
            for (int i = 0; i < 10; i++) many.Step(0.01f, 0.08f);
            Assert.IsTrue(Near.Are(one.Rotations[Arm], many.Rotations[Arm], 1e-4f));
        }

        [Test]
        public void WithoutSmoothingItFollowsAtOnce()
        {
            PoseFollower follower = Raised();
            Quaternion before = follower.Rotations[Arm];
            follower.Step(0.001f, 0);
            Assert.AreEqual(180, Quaternion.Angle(before, follower.Rotations[Arm]), 0.5);
        }

        [Test]
        public void ForgettingGoesBackToRest()
        {
            PoseFollower follower = Raised();
            follower.Forget();
            Assert.IsTrue(Near.Are(Quaternion.identity, follower.Rotations[Arm]));
        }

        /// <summary>Arms hang, and are to go straight up, past the side.</summary>
        static PoseFollower Raised()
        {
            var follower = new PoseFollower();
            var solver = new PoseSolver();
            CoreJoints person = Make.Person();
            follower.Aim(solver, person, Least);
            person.Positions[(int)CoreJoint.RightElbow] = new Vector3(0.17f, 0.7f, -2);
            person.Positions[(int)CoreJoint.RightWrist] = new Vector3(0.17f, 0.95f, -2);
            follower.Aim(solver, person, Least);
            return follower;
        }
    }
}
