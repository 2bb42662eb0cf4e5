using System;
using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class SensorClientTests
    {
        ManualClock _clock;
        MockTransportFactory _sockets;
        SensorClient _sensor;

        [SetUp]
        public void SetUp()
        {
            Build(Coding.Json);
        }

        void Build(Coding coding)
        {
            _clock = new ManualClock { NowNs = 123456789 };
            _sockets = new MockTransportFactory();
            _sensor = new SensorClient(
                new ConnectionSettings { Role = Role.Sensor, Coding = coding }, _sockets, _clock, new FixedRandom());
        }

        void GoLive()
        {
            _sensor.Connection.Start();
            _sockets.Last.Accept();
            _sensor.Poll();
            _sockets.Last.Say(Make.Welcome());
            _sensor.Poll();
        }

        Message LastHeard() => _sockets.Last.Heard[_sockets.Last.Heard.Count - 1];

        [Test]
        public void StampsBeginAtZero()
        {
            Assert.AreEqual(0, _sensor.StampNs);
            _clock.Advance(0.5);
            Assert.AreEqual(500000000, _sensor.StampNs);
        }

        [Test]
        public void FramesWithoutAConnectionAreDroppedAndCounted()
        {
            Assert.IsTrue(!_sensor.SendAffect(1, 2));
            Assert.IsTrue(!_sensor.SendSkeleton(1, "core9", new float[36]));
            Assert.AreEqual(2, _sensor.Dropped);
            GoLive();
            Assert.IsTrue(_sensor.SendAffect(1, 2));
            Assert.AreEqual(1, _sensor.Sent);
            Assert.AreEqual(2, _sensor.Dropped);
        }

        [Test]
        public void FramesForWhichTheSocketIsTooSlowAreDropped()
        {
            GoLive();
            _sockets.Last.Waiting = SensorClient.WaitingLimit;
            Assert.IsTrue(!_sensor.SendAffect(1, 2));
            Assert.AreEqual(1, _sensor.Dropped);
        }

        [Test]
        public void ASkeletonIsSentInJson()
        {
            GoLive();
            _clock.Advance(1);
            Assert.IsTrue(_sensor.SendSkeleton(3, "core9", new[] { 0.5f, 1, 2, 1, 3, 4, 5, 0 }));
            var skeleton = (Skeleton)LastHeard();
            Assert.AreEqual(1000000000, skeleton.OriginatingNs);
            Assert.AreEqual(3, skeleton.BodyId);
            Assert.AreEqual(new[] { new JointSample(0.5, 1, 2, 1), new JointSample(3, 4, 5, 0) }, skeleton.Joints);
        }

        [Test]
        public void ASkeletonIsPackedInMessagePack()
        {
            Build(Coding.MessagePack);
            GoLive();
            var joints = new float[] { 1, 2, 3, 1 };
            Assert.IsTrue(_sensor.SendSkeleton(3, "core9", joints, 42));
            var skeleton = (PackedSkeleton)LastHeard();
            Assert.AreEqual(42, skeleton.OriginatingNs);
            Assert.AreEqual(Packed.Floats(joints), skeleton.Joints);
        }

        [Test]
        public void AFaceIsSentInBothCodings()
        {
            GoLive();
            _sensor.SendFace(FaceFormat.Dlib68, 640, 480, new float[] { 1, 2, 3, 4 });
            var face = (FacePoints)LastHeard();
            Assert.AreEqual(2, face.Points.Count);
            Assert.AreEqual(new double[] { 3, 4 }, face.Points[1]);
            Build(Coding.MessagePack);
            GoLive();
            _sensor.SendFace(FaceFormat.Mesh478, 640, 480, new float[] { 1, 2, 3 });
            Assert.AreEqual(12, ((PackedFacePoints)LastHeard()).Points.Length);
        }

        [Test]
        public void EverythingElseIsSent()
        {
            GoLive();
            _sensor.SendBlendshapes(new Dictionary<string, double> { { "jawOpen", 0.25 } });
            Assert.AreEqual(0.25, ((Blendshapes)LastHeard()).Values["jawOpen"]);
            _sensor.SendGaze(new Point3(0, 1, 2), new Point3(0, 0, -1));
            Assert.AreEqual(new Point3(0, 0, -1), ((Gaze)LastHeard()).Direction);
            _sensor.SendImage(new byte[] { 1, 2 });
            Assert.AreEqual(new byte[] { 1, 2 }, ((Image)LastHeard()).Jpeg);
            _sensor.Calibrate(3);
            Assert.AreEqual(3, ((Calibrate)LastHeard()).Seconds);
            _sensor.Calibrate(1, -1);
            Assert.AreEqual(-1, ((Calibrate)LastHeard()).Arousal);
        }

        [Test]
        public void NumbersThatDoNotMakeUpJointsAreRefused()
        {
            Assert.Throws<ArgumentException>(() => _sensor.SendSkeleton(1, "core9", new float[35]));
            Assert.Throws<ArgumentException>(() => _sensor.SendFace(FaceFormat.Dlib68, 64, 64, new float[3]));
        }

        [Test]
        public void RefusalsAndCalibrationsAreTold()
        {
            string code = null;
            CalibrationState found = null;
            _sensor.Refused += error => code = error.Code;
            _sensor.Calibrated += state => found = state;
            GoLive();
            _sockets.Last.Say(new ErrorMessage("not_finite", "no"));
            _sockets.Last.Say(new CalibrationState(1, 2, 30, true));
            _sensor.Poll();
            Assert.AreEqual("not_finite", code);
            Assert.AreEqual(30, found.Faces);
        }

        [Test]
        public void SettingsOfAnotherRoleAreRefused()
        {
            Assert.Throws<ArgumentException>(() => new SensorClient(new ConnectionSettings { Role = Role.Renderer }));
            Assert.Throws<ArgumentException>(() => new RendererClient(new ConnectionSettings { Role = Role.Sensor }));
            Assert.Throws<ArgumentException>(() => new MonitorClient(new ConnectionSettings { Role = Role.Sensor }));
        }
    }
}
