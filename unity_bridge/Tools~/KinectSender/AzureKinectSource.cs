#if AZURE_KINECT
using System;
using System.Collections.Generic;
using Microsoft.Azure.Kinect.Sensor;
using Tracking = Microsoft.Azure.Kinect.BodyTracking;

namespace AgentServer.KinectSender
{
    /// <summary>An Azure Kinect: millimetres of its depth camera, joints in the order of its SDK.</summary>
    sealed class AzureKinectSource : IBodySource
    {
        const int JointCount = 32;
        static readonly TimeSpan Wait = TimeSpan.FromMilliseconds(100);

        readonly Device _device;
        readonly Tracking.Tracker _tracker;

        public AzureKinectSource()
        {
            _device = Device.Open(0);
            _device.StartCameras(new DeviceConfiguration
            {
                CameraFPS = FPS.FPS30,
                ColorResolution = ColorResolution.Off,
                DepthMode = DepthMode.NFOV_Unbinned,
                WiredSyncMode = WiredSyncMode.Standalone,
            });
            _tracker = Tracking.Tracker.Create(_device.GetCalibration(), new Tracking.TrackerConfiguration
            {
                ProcessingMode = Tracking.TrackerProcessingMode.Gpu,
                SensorOrientation = Tracking.SensorOrientation.Default,
            });
        }

        public string Format => "azure_kinect";

        public void Read(List<BodySample> bodies)
        {
            using (Capture capture = _device.GetCapture()) _tracker.EnqueueCapture(capture);
            using (Tracking.Frame frame = _tracker.PopResult(Wait, false))
            {
                if (frame == null) return;
                for (uint index = 0; index < frame.NumberOfBodies; index++)
                    bodies.Add(new BodySample(
                        frame.GetBodyId(index), frame.DeviceTimestamp, Joints(frame.GetBodySkeleton(index))));
            }
        }

        public void Dispose()
        {
            _tracker.Dispose();
            _device.StopCameras();
            _device.Dispose();
        }

        static float[] Joints(Tracking.Skeleton skeleton)
        {
            var joints = new float[4 * JointCount];
            for (int index = 0; index < JointCount; index++)
            {
                Tracking.Joint joint = skeleton.GetJoint(index);
                joints[4 * index] = joint.Position.X;
                joints[4 * index + 1] = joint.Position.Y;
                joints[4 * index + 2] = joint.Position.Z;
                joints[4 * index + 3] = Confidence(joint.ConfidenceLevel);
            }
            return joints;
        }

        /// <summary>Low is the SDK's word for a joint that is hidden and predicted.</summary>
        static float Confidence(Tracking.JointConfidenceLevel level)
        {
            switch (level)
            {
                case Tracking.JointConfidenceLevel.None: return 0;
                case Tracking.JointConfidenceLevel.Low: return 0.5f;
                default: return 1;
            }
        }
    }
}
#endif
