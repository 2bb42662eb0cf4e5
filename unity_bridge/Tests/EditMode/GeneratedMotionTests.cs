using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class GeneratedMotionTests
    {
        static readonly string[] Names =
        {
            "head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand",
            "right_shoulder", "right_elbow", "right_hand",
        };

        /// <summary>An agent that stands and holds its right arm straight forwards.</summary>
        static PoseStreamMessage Forwards(params string[] names)
        {
            var pose = new[]
            {
                new Point3(0, 1.6, 0), new Point3(0, 1.4, 0), new Point3(0, 1.1, 0),
                new Point3(0.2, 1.4, 0), new Point3(0.2, 1.1, 0), new Point3(0.2, 0.8, 0),
                new Point3(-0.2, 1.4, 0), new Point3(-0.2, 1.4, 0.3), new Point3(-0.2, 1.4, 0.6),
            };
            return new PoseStreamMessage("s/c1", 0, 25, names, new[] { pose }, isLast: false);
        }

        [Test]
        public void TheAgentsOwnRightArmPointsForwards()
        {
            var player = new PoseStreamPlayer();
            var joints = new CoreJoints();
            player.Push(Forwards(Names));
            Assert.IsTrue(joints.Take(player));
            Assert.IsTrue(joints.Positions[(int)CoreJoint.RightShoulder].x > 0);
            Quaternion[] rotations = AvatarBones.Rest();
            new PoseSolver().Solve(joints, 0, rotations);
            Vector3 right = Whole(rotations, AvatarBone.RightUpperArm) * Vector3.right;
            Vector3 left = Whole(rotations, AvatarBone.LeftUpperArm) * Vector3.left;
            Assert.IsTrue((right - Vector3.forward).magnitude < 1e-3f);
            Assert.IsTrue((left - Vector3.down).magnitude < 1e-3f);
        }

        [Test]
        public void AMotionWithoutAJointIsNotTaken()
        {
            var player = new PoseStreamPlayer();
            var names = (string[])Names.Clone();
            names[8] = "right_paw";
            player.Push(Forwards(names));
            Assert.IsTrue(!new CoreJoints().Take(player));
        }

        static Quaternion Whole(Quaternion[] rotations, AvatarBone bone)
        {
            Quaternion turn = Quaternion.identity;
            for (int i = (int)bone; i >= 0; i = AvatarBones.ParentOf(i)) turn = rotations[i] * turn;
            return turn;
        }
    }
}
