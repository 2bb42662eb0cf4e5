using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class SkeletonSourceTests
    {
        [Test]
        public void AKinectsFramesBecomeSamples()
        {
            var kinect = new FakeKinect { Ticks = 50000000 };
            var body = new KinectBody { TrackingId = (1UL << 56) + 9 };
            body.Joints[3] = new KinectJoint { X = 0.1f, Y = 0.7f, Z = 2, Tracking = KinectTracking.Tracked };
            body.Joints[4] = new KinectJoint { X = 0.2f, Tracking = KinectTracking.Inferred };
            kinect.Bodies.Add(body);
            var source = new KinectSkeletonSource(kinect);
            SkeletonSample first = Collect(source)[0];
            Assert.AreEqual("kinect_v2", first.Format);
            Assert.AreEqual(0L, first.OriginatingNs);
            Assert.AreEqual(9L, first.BodyId);
            Assert.AreEqual(25, first.Joints.Count);
            Assert.AreEqual(0.7f, (float)first.Joints[3].Y);
            Assert.AreEqual(1.0, first.Joints[3].Confidence);
            Assert.AreEqual(0.5, first.Joints[4].Confidence);
            Assert.AreEqual(0.0, first.Joints[5].Confidence);
            // 33 ms later, in units of 100 ns.
            kinect.Ticks += 330000;
            Assert.AreEqual(33000000L, Collect(source)[0].OriginatingNs);
        }

        [Test]
        public void AFrameIsSentOnce()
        {
            var kinect = new FakeKinect();
            kinect.Bodies.Add(new KinectBody());
            var source = new KinectSkeletonSource(kinect);
            Assert.AreEqual(1, Collect(source).Count);
            Assert.AreEqual(0, Collect(source).Count);
            kinect.HasFrame = false;
            kinect.Ticks++;
            Assert.AreEqual(0, Collect(source).Count);
        }

        [Test]
        public void AnAzureKinectsFramesBecomeSamples()
        {
            var kinect = new FakeAzureKinect { Microseconds = 1000 };
            var body = new AzureKinectBody { Id = 3 };
            body.Joints[26] = new AzureKinectJoint { X = 10, Y = -700, Z = 2000, Confidence = AzureKinectConfidence.Medium };
            body.Joints[0] = new AzureKinectJoint { Confidence = AzureKinectConfidence.Low };
            kinect.Bodies.Add(body);
            var source = new AzureKinectSkeletonSource(kinect);
            SkeletonSample sample = Collect(source)[0];
            Assert.AreEqual("azure_kinect", sample.Format);
            Assert.AreEqual(32, sample.Joints.Count);
            // Millimetres with y down, as the format has them.
            Assert.AreEqual(new JointSample(10, -700, 2000, 1), sample.Joints[26]);
            Assert.AreEqual(0.5, sample.Joints[0].Confidence);
            kinect.Microseconds += 33333;
            Assert.AreEqual(33333000L, Collect(source)[0].OriginatingNs);
        }

        [Test]
        public void TablesHaveTheirJoints()
        {
            Assert.AreEqual(25, JointTable.Find("kinect_v2").Names.Count);
            Assert.AreEqual(20, JointTable.Find("kinect_v1").Names.Count);
            Assert.AreEqual(33, JointTable.Find("blazepose").Names.Count);
            Assert.AreEqual(9, JointTable.Find("core9").Names.Count);
            Assert.IsTrue(JointTable.Find("vicon") == null);
            Assert.AreEqual(20, JointTable.KinectV2.IndexOf("SpineShoulder"));
            Assert.AreEqual(20, JointTable.KinectV2.IndexOf("spine shoulder"));
            Assert.AreEqual(-1, JointTable.KinectV2.IndexOf("tail"));
        }

        static List<SkeletonSample> Collect(ISkeletonSource source)
        {
            var samples = new List<SkeletonSample>();
            source.Collect(samples);
            return samples;
        }

        sealed class FakeKinect : IKinectBodies
        {
            public readonly List<KinectBody> Bodies = new List<KinectBody>();
            public long Ticks;
            public bool HasFrame = true;

            public bool TryGetFrame(out long relativeTicks, List<KinectBody> bodies)
            {
                relativeTicks = Ticks;
                bodies.Clear();
                bodies.AddRange(Bodies);
                return HasFrame;
            }
        }

        sealed class FakeAzureKinect : IAzureKinectBodies
        {
            public readonly List<AzureKinectBody> Bodies = new List<AzureKinectBody>();
            public long Microseconds;

            public bool TryGetFrame(out long deviceMicroseconds, List<AzureKinectBody> bodies)
            {
                deviceMicroseconds = Microseconds;
                bodies.Clear();
                bodies.AddRange(Bodies);
                return true;
            }
        }
    }
}
