using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class BindPoseTests
    {
        GameObject _avatar;
        Transform[] _bones;

        [SetUp]
        public void MakeAvatar()
        {
            _avatar = new GameObject("avatar");
            _bones = new Transform[AvatarBones.Count];
            // The axes of a modeller: every bone lies along its own y.
            Transform chest = Bone("chest", _avatar.transform, new Vector3(0, 1.2f, 0), Quaternion.Euler(0, 90, 0));
            Transform arm = Bone("arm", chest, new Vector3(0, 0.2f, 0.2f), Quaternion.Euler(90, 0, 0));
            Transform forearm = Bone("forearm", arm, new Vector3(0, 0.3f, 0), Quaternion.identity);
            _bones[(int)AvatarBone.Chest] = chest;
            _bones[(int)AvatarBone.RightUpperArm] = arm;
            _bones[(int)AvatarBone.RightLowerArm] = forearm;
        }

        [TearDown]
        public void DestroyAvatar() => Object.DestroyImmediate(_avatar);

        [Test]
        public void AtRestNothingMoves()
        {
            BindPose bind = BindPose.Of(_avatar.transform, _bones, null);
            for (int i = 0; i < _bones.Length; i++)
            {
                if (_bones[i] == null) continue;
                Assert.IsTrue(Near.Are(_bones[i].rotation, bind.World(i, Quaternion.identity, Quaternion.identity)));
            }
        }

        [Test]
        public void ABoneTurnsAboutTheAvatarsAxesWhateverItsOwn()
        {
            BindPose bind = BindPose.Of(_avatar.transform, _bones, null);
            Transform arm = _bones[(int)AvatarBone.RightUpperArm];
            Vector3 before = arm.rotation * Vector3.up;
            Quaternion turn = Quaternion.AngleAxis(30, Vector3.forward);
            arm.rotation = bind.World((int)AvatarBone.RightUpperArm, Quaternion.identity, turn);
            Assert.IsTrue(Near.Are(turn * before, arm.rotation * Vector3.up));
        }

        [Test]
        public void TheWholeAvatarMayBeTurned()
        {
            BindPose bind = BindPose.Of(_avatar.transform, _bones, null);
            Quaternion root = Quaternion.Euler(0, 70, 0);
            _avatar.transform.rotation = root;
            int arm = (int)AvatarBone.RightUpperArm;
            Assert.IsTrue(Near.Are(_bones[arm].rotation, bind.World(arm, root, Quaternion.identity)));
        }

        [Test]
        public void TheAvatarsTPoseGoesBeforeThePresentPose()
        {
            Quaternion rest = _bones[(int)AvatarBone.RightUpperArm].rotation;
            var skeleton = new[]
            {
                Rest("chest"), Rest("arm"), Rest("forearm"),
            };
            _bones[(int)AvatarBone.RightUpperArm].localRotation = Quaternion.Euler(0, 0, -70);
            BindPose bind = BindPose.Of(_avatar.transform, _bones, skeleton);
            int arm = (int)AvatarBone.RightUpperArm;
            Assert.IsTrue(Near.Are(rest, bind.World(arm, Quaternion.identity, Quaternion.identity)));
        }

        [Test]
        public void TheArmsDirectionAtRestIsFound()
        {
            CoreJoints person = Make.Person();
            Quaternion[] rotations = AvatarBones.Rest();
            BindPose bind = BindPose.Of(_avatar.transform, _bones, null);
            bind.Solver.Solve(person, 0.3f, rotations);
            int arm = (int)AvatarBone.RightUpperArm;
            Quaternion world = bind.World(arm, Quaternion.identity, rotations[arm]);
            // The bone lies along its y, and the person's arms hang.
            Assert.IsTrue(Near.Are(Vector3.down, world * Vector3.up, 0.01f), (world * Vector3.up).ToString());
        }

        SkeletonBone Rest(string name)
        {
            Transform bone = name == "chest" ? _avatar.transform.Find("chest")
                : _avatar.transform.Find(name == "arm" ? "chest/arm" : "chest/arm/forearm");
            return new SkeletonBone
            {
                name = name, position = bone.localPosition, rotation = bone.localRotation, scale = bone.localScale,
            };
        }

        static Transform Bone(string name, Transform parent, Vector3 place, Quaternion turn)
        {
            Transform bone = new GameObject(name).transform;
            bone.SetParent(parent, false);
            bone.localPosition = place;
            bone.localRotation = turn;
            return bone;
        }
    }
}
