#if KINECT_V2
using System;
using System.Collections.Generic;
using System.Threading;
using Kinect = Microsoft.Kinect;

namespace AgentServer.KinectSender
{
    /// <summary>A Kinect for Windows v2: metres in its camera space, joints in the order of its SDK.</summary>
    sealed class KinectV2Source : IBodySource
    {
        const int JointCount = 25;
        const int PauseMs = 2;

        readonly Kinect.KinectSensor _device;
        readonly Kinect.BodyFrameReader _reader;
        Kinect.Body[] _bodies;

        public KinectV2Source()
        {
            _device = Kinect.KinectSensor.GetDefault();
            if (_device == null) throw new InvalidOperationException("no Kinect v2 is connected");
            _reader = _device.BodyFrameSource.OpenReader();
            _device.Open();
        }

        public string Format => "kinect_v2";

        public void Read(List<BodySample> bodies)
        {
            using (Kinect.BodyFrame frame = _reader.AcquireLatestFrame())
            {
                if (frame == null)
                {
                    Thread.Sleep(PauseMs);
                    return;
                }
                if (_bodies == null) _bodies = new Kinect.Body[frame.BodyCount];
                frame.GetAndRefreshBodyData(_bodies);
                foreach (Kinect.Body body in _bodies)
                    if (body != null && body.IsTracked)
                        bodies.Add(new BodySample(body.TrackingId, frame.RelativeTime, Joints(body)));
            }
        }

        public void Dispose()
        {
            _reader.Dispose();
            _device.Close();
        }

        static float[] Joints(Kinect.Body body)
        {
            var joints = new float[4 * JointCount];
            for (int index = 0; index < JointCount; index++)
            {
                Kinect.Joint joint = body.Joints[(Kinect.JointType)index];
                joints[4 * index] = joint.Position.X;
                joints[4 * index + 1] = joint.Position.Y;
                joints[4 * index + 2] = joint.Position.Z;
                joints[4 * index + 3] = Confidence(joint.TrackingState);
            }
            return joints;
        }

        static float Confidence(Kinect.TrackingState state)
        {
            switch (state)
            {
                case Kinect.TrackingState.Tracked: return 1;
                case Kinect.TrackingState.Inferred: return 0.5f;
                default: return 0;
            }
        }
    }
}
#endif
