using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class PoseSolverTests
    {
        const float Least = 0.3f;

        [Test]
        public void ItAgreesWithTheServer()
        {
            var solver = new PoseSolver();
            Quaternion[] rotations = AvatarBones.Rest();
            int number = 0;
            foreach (string line in File.ReadAllLines(Golden()))
            {
                number++;
                float[] numbers = line.Split(' ').Select(one => float.Parse(one, CultureInfo.InvariantCulture)).ToArray();
                solver.Solve(Joints(numbers), Least, rotations);
                for (int bone = 0; bone < AvatarBones.Count; bone++)
                {
                    int at = 36 + 4 * bone;
                    var wanted = new Quaternion(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]);
                    Assert.IsTrue(
                        Near.Are(wanted, rotations[bone]),
                        "line " + number + ", " + (AvatarBone)bone + ": " + rotations[bone] + " is not " + wanted);
                }
            }
            Assert.IsTrue(number >= 100);
        }

        [Test]
        public void BonesPointWhereThePersonsDo()
        {
            CoreJoints person = Make.Person();
            person.Positions[(int)CoreJoint.RightElbow] = new Vector3(0.4f, 0.5f, -1.9f);
            person.Positions[(int)CoreJoint.RightWrist] = new Vector3(0.45f, 0.7f, -1.7f);
            Quaternion[] rotations = AvatarBones.Rest();
            new PoseSolver().Solve(person, Least, rotations);
            AssertDirection(person, rotations, AvatarBone.RightUpperArm, Vector3.right, CoreJoint.RightShoulder);
            AssertDirection(person, rotations, AvatarBone.RightLowerArm, Vector3.right, CoreJoint.RightElbow);
            AssertDirection(person, rotations, AvatarBone.LeftUpperArm, Vector3.left, CoreJoint.LeftShoulder);
        }

        [Test]
        public void AnAvatarInAnAPoseNeedsLessOfATurn()
        {
            CoreJoints person = Make.Person();
            var left = new Vector3(-1, -1, 0);
            var right = new Vector3(1, -1, 0);
            Quaternion[] rotations = AvatarBones.Rest();
            new PoseSolver(left, right).Solve(person, Least, rotations);
            AssertDirection(person, rotations, AvatarBone.RightUpperArm, right.normalized, CoreJoint.RightShoulder);
            Assert.AreEqual(45, Quaternion.Angle(Quaternion.identity, rotations[(int)AvatarBone.RightUpperArm]), 0.1);
        }

        [Test]
        public void ALostJointHolds()
        {
            CoreJoints person = Make.Person();
            Quaternion[] rotations = AvatarBones.Rest();
            var solver = new PoseSolver();
            solver.Solve(person, Least, rotations);
            Quaternion before = rotations[(int)AvatarBone.RightLowerArm];
            person.Positions[(int)CoreJoint.RightWrist] = new Vector3(1, 1, -1);
            person.Confidence[(int)CoreJoint.RightWrist] = 0;
            solver.Solve(person, Least, rotations);
            Assert.IsTrue(Near.Are(before, rotations[(int)AvatarBone.RightLowerArm]));
            person.Confidence[(int)CoreJoint.RightWrist] = 1;
            solver.Solve(person, Least, rotations);
            Assert.IsTrue(!Near.Are(before, rotations[(int)AvatarBone.RightLowerArm]));
        }

        [Test]
        public void WhatIsNoNumberHolds()
        {
            CoreJoints person = Make.Person();
            for (int i = 0; i < CoreJoints.Count; i++) person.Positions[i] = new Vector3(float.NaN, 0, 0);
            Quaternion[] rotations = AvatarBones.Rest();
            new PoseSolver().Solve(person, Least, rotations);
            Assert.IsTrue(rotations.All(one => Near.Are(one, Quaternion.identity)));
        }

        [Test]
        public void AMirrorSwapsTheSides()
        {
            CoreJoints person = Make.Person();
            person.Positions[(int)CoreJoint.RightWrist] = new Vector3(0.5f, 0.6f, -1.8f);
            person.Confidence[(int)CoreJoint.RightWrist] = 0.5f;
            person.Positions[(int)CoreJoint.Head] = new Vector3(0.1f, 0.7f, -2);
            person.Mirror();
            Assert.AreEqual(new Vector3(-0.5f, 0.6f, -1.8f), person.Positions[(int)CoreJoint.LeftWrist]);
            Assert.AreEqual(0.5f, person.Confidence[(int)CoreJoint.LeftWrist]);
            Assert.AreEqual(new Vector3(-0.1f, 0.7f, -2), person.Positions[(int)CoreJoint.Head]);
            Assert.AreEqual(1f, person.Confidence[(int)CoreJoint.RightWrist]);
        }

        [Test]
        public void AForecastIsReadFrameByFrame()
        {
            Point3[][] frames = Enumerable.Range(0, 50)
                .Select(frame => Enumerable.Range(0, 9).Select(joint => new Point3(frame, joint, 2)).ToArray())
                .ToArray();
            var forecast = new ForecastMessage(0, 0, "last_frame", frames);
            var joints = new CoreJoints();
            Assert.IsTrue(joints.Take(forecast, 49));
            Assert.AreEqual(new Vector3(49, 8, -2), joints.Positions[8]);
            Assert.AreEqual(1f, joints.Confidence[8]);
            Assert.IsTrue(!joints.Take(forecast, 50));
        }

        static void AssertDirection(
            CoreJoints person, Quaternion[] rotations, AvatarBone bone, Vector3 rest, CoreJoint from)
        {
            Vector3 wanted = person.Positions[(int)from + 1] - person.Positions[(int)from];
            Quaternion world = Quaternion.identity;
            for (int at = (int)bone; at >= 0; at = AvatarBones.ParentOf(at)) world = rotations[at] * world;
            Assert.IsTrue(Near.Are(wanted.normalized, world * rest), bone + " points to " + world * rest);
        }

        static CoreJoints Joints(float[] numbers)
        {
            var joints = new CoreJoints();
            for (int i = 0; i < CoreJoints.Count; i++)
            {
                joints.Positions[i] = Coordinates.ToUnity(
                    new Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]));
                joints.Confidence[i] = numbers[27 + i];
            }
            return joints;
        }

        static string Golden([CallerFilePath] string here = "") =>
            Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here), "retarget_golden.txt"));
    }
}
