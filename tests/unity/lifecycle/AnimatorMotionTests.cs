using System.Linq;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class AnimatorMotionTests : World
    {
        Animator _animator;
        AnimatorMotion _motion;

        [SetUp]
        public void MakeAvatar()
        {
            var thing = new GameObject("avatar");
            _motion = thing.AddComponent<AnimatorMotion>();
            _animator = thing.GetComponent<Animator>();
            foreach (string state in new[] { "Stand", "Sit", "Reach" }) _animator.States.Add(Animator.StringToHash(state));
            Lifecycle.Start();
        }

        [Test]
        public void AStepIsPlayedInItsTime()
        {
            _motion.Play(new StepMessage("close", 1.5, "window"), new StepMapping("close", "", "Reach", 3));
            Assert.AreEqual(2f, _animator.speed);
            Assert.AreEqual(new[] { "fade " + Animator.StringToHash("Reach") }, _animator.Calls.ToArray());
            _motion.Rest(true);
            Assert.AreEqual(1f, _animator.speed);
            Assert.AreEqual("fade " + Animator.StringToHash("Stand"), _animator.Calls.Last());
        }

        [Test]
        public void AStateThatIsMissingIsSaidOnce()
        {
            var mapping = new StepMapping("type_on", "", "Type");
            _motion.Play(new StepMessage("type_on", 1, "keyboard"), mapping);
            _motion.Play(new StepMessage("type_on", 1, "keyboard"), mapping);
            Assert.AreEqual(0, _animator.Calls.Count);
            Assert.AreEqual(1, Logged("no state 'Type'"));
        }

        [Test]
        public void TheHeadTurnsToWhatIsLookedAtAndNoFurtherThanItCan()
        {
            var head = new GameObject("head").transform;
            head.SetParent(_animator.transform, false);
            head.localPosition = new Vector3(0, 1.6f, 0);
            _animator.Bones[HumanBodyBones.Head] = head;
            Lifecycle.Send(_motion, "Awake");
            _motion.LookAt(new Vector3(-5, 1.6f, 0));
            for (int i = 0; i < 100; i++)
            {
                // As the animator does in each frame.
                head.localRotation = Quaternion.identity;
                Lifecycle.Frames(1, Frame);
            }
            Assert.AreEqual(70, Vector3.Angle(Vector3.forward, head.forward), 1);
            Assert.IsTrue(head.forward.x < 0);
        }

        [Test]
        public void AHeadThatTheAnimatorLeavesAloneTurnsNoFurther()
        {
            var head = new GameObject("head").transform;
            head.SetParent(_animator.transform, false);
            _animator.Bones[HumanBodyBones.Head] = head;
            Lifecycle.Send(_motion, "Awake");
            _motion.LookAt(new Vector3(-5, 0, 5));
            Lifecycle.Frames(200, Frame);
            Assert.AreEqual(45, Vector3.Angle(Vector3.forward, head.forward), 1);
            _motion.LookAt(null);
            Lifecycle.Frames(200, Frame);
            Assert.AreEqual(0, Vector3.Angle(Vector3.forward, head.forward), 1);
        }

        [Test]
        public void ARetargeterFindsTheBonesOfAHumanoid()
        {
            var arm = new GameObject("arm").transform;
            var forearm = new GameObject("forearm").transform;
            arm.SetParent(_animator.transform, false);
            forearm.SetParent(arm, false);
            forearm.localPosition = new Vector3(0.3f, 0, 0);
            _animator.avatar = new Avatar();
            _animator.Bones[HumanBodyBones.RightUpperArm] = arm;
            _animator.Bones[HumanBodyBones.RightLowerArm] = forearm;
            var retargeter = _animator.gameObject.AddComponent<HumanoidRetargeter>();
            Lifecycle.Send(retargeter, "Awake");
            retargeter.Take(new PoseMessage(0, 1, new[]
            {
                new JointSample(0, 0.7, 2, 1), new JointSample(0, 0.45, 2, 1), new JointSample(0, 0.15, 2, 1),
                new JointSample(-0.17, 0.4, 2, 1), new JointSample(-0.17, 0.1, 2, 1), new JointSample(-0.17, -0.15, 2, 1),
                new JointSample(0.17, 0.4, 2, 1), new JointSample(0.17, 0.7, 2, 1), new JointSample(0.17, 1, 2, 1),
            }));
            Lifecycle.Frames(1, Frame);
            Assert.IsTrue((arm.rotation * Vector3.right - Vector3.up).magnitude < 0.01f);
        }

        [Test]
        public void AnAvatarThatIsNoHumanoidIsSaid()
        {
            var retargeter = _animator.gameObject.AddComponent<HumanoidRetargeter>();
            Lifecycle.Send(retargeter, "Awake");
            Assert.AreEqual(1, Logged("Animation Type"));
        }
    }
}
