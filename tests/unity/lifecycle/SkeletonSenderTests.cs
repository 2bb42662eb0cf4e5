using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.XR;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class SkeletonSenderTests : World
    {
        const string Recording =
            "{\"format\": \"kinect_v2\", \"rate_hz\": 25}\n"
            + "{\"frame\": 0, \"body_id\": 4, \"joints\": {\"Head\": [0, 0.5, 2]}}\n"
            + "{\"frame\": 1, \"body_id\": 4, \"joints\": {\"Head\": [0, 0.6, 2]}}\n";

        GameObject _thing;
        SkeletonSender _sender;

        [SetUp]
        public void MakeSender()
        {
            InputDevices.Devices.Clear();
            _thing = new GameObject("sensor");
            _sender = _thing.AddComponent<SkeletonSender>();
            _sender.Use(Sockets, Clock);
        }

        [Test]
        public void ARecordingIsSentInItsTime()
        {
            var source = _thing.AddComponent<RecordedSkeletonSource>();
            Lifecycle.Start();
            Assert.AreEqual(FaceKind.None, GreetedWith().Face);
            source.Play(SkeletonRecording.Parse(Recording, "run"));
            Pass(0.1);
            Skeleton[] sent = Socket("sensor").Heard.OfType<Skeleton>().ToArray();
            Assert.AreEqual(2, sent.Take(2).Count());
            Assert.AreEqual("kinect_v2", sent[0].Format);
            Assert.AreEqual(4L, sent[0].BodyId);
            Assert.AreEqual(25, sent[0].Joints.Count);
            Assert.AreEqual(40000000L, sent[1].OriginatingNs - sent[0].OriginatingNs);
        }

        [Test]
        public void AGazeIsToldInTheFrameOfTheSensor()
        {
            var space = new GameObject("space").transform;
            var sensor = new GameObject("camera").transform;
            // The camera stands three metres before the wearer and looks at them.
            space.position = new Vector3(0, 0, -3);
            sensor.position = Vector3.zero;
            sensor.rotation = Quaternion.LookRotation(Vector3.back);
            var gaze = _thing.AddComponent<HeadsetGazeSource>();
            gaze.Place(space, sensor);
            InputDevices.Devices[XRNode.Head] = new Dictionary<string, object>
            {
                { "CenterEyePosition", new Vector3(0.1f, 0.4f, 0) }, { "CenterEyeRotation", Quaternion.identity },
            };
            Lifecycle.Start();
            Assert.AreEqual(FaceKind.Gaze, GreetedWith().Face);
            Pass(0.5);
            Gaze sent = Socket("sensor").Heard.OfType<Gaze>().Last();
            // What is on the wearer's right is at larger x; the wearer looks at the camera, against its z.
            Assert.AreEqual(0.1, sent.Origin.X, 1e-5);
            Assert.AreEqual(0.4, sent.Origin.Y, 1e-5);
            Assert.AreEqual(3, sent.Origin.Z, 1e-5);
            Assert.AreEqual(-1, sent.Direction.Z, 1e-5);
            int count = Socket("sensor").Heard.OfType<Gaze>().Count();
            Assert.IsTrue(count >= 10 && count <= 17, count.ToString());
        }

        [Test]
        public void EyesGoBeforeTheHead()
        {
            var space = new GameObject("space").transform;
            var gaze = _thing.AddComponent<HeadsetGazeSource>();
            gaze.Place(space, space);
            InputDevices.Devices[XRNode.Head] = new Dictionary<string, object>
            {
                { "DevicePosition", new Vector3(0, 1, 0) }, { "DeviceRotation", Quaternion.identity },
                { "EyesData", new Eyes { Fixation = new Vector3(0, -1, 0) } },
            };
            Point3 origin, direction;
            Assert.IsTrue(gaze.TryGetGaze(out origin, out direction));
            Assert.AreEqual(-2, direction.Y, 1e-5);
        }

        [Test]
        public void AHeadsetThatComesIsSaidInANewHello()
        {
            var space = new GameObject("space").transform;
            _thing.AddComponent<HeadsetGazeSource>().Place(space, space);
            Lifecycle.Start();
            Assert.AreEqual(FaceKind.None, GreetedWith().Face);
            MockTransport first = Socket("sensor");
            InputDevices.Devices[XRNode.Head] = new Dictionary<string, object>();
            Pass(Frame);
            Assert.AreEqual(1000, first.ClosedWith);
            Assert.AreEqual(FaceKind.Gaze, GreetedWith().Face);
        }

        [Test]
        public void NothingToSendIsSaid()
        {
            Lifecycle.Start();
            Assert.AreEqual(1, Logged("has nothing to send"));
        }

        Hello GreetedWith() => Greet("sensor").Heard.OfType<Hello>().Single();
    }
}
