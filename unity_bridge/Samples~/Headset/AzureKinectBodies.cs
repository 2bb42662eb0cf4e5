#if AGENT_SERVER_AZURE_KINECT
using System;
using System.Collections.Generic;
using System.Threading;
using AgentServer.Unity;
using Microsoft.Azure.Kinect.BodyTracking;
using Microsoft.Azure.Kinect.Sensor;
using UnityEngine;
using TrackedFrame = Microsoft.Azure.Kinect.BodyTracking.Frame;
using TrackedJoint = Microsoft.Azure.Kinect.BodyTracking.Joint;
using TrackedSkeleton = Microsoft.Azure.Kinect.BodyTracking.Skeleton;

namespace AgentServer.Samples
{
    /// <summary>
    /// The bodies of an Azure Kinect, with Microsoft's packages Azure.Kinect.Sensor and
    /// Azure.Kinect.BodyTracking. A thread waits for the camera; only the latest frame is kept.
    /// </summary>
    public sealed class AzureKinectBodies : MonoBehaviour, IAzureKinectBodies
    {
        const int JoinMs = 2000;

        readonly object _lock = new object();
        Thread _thread;
        volatile bool _isWanted;
        List<AzureKinectBody> _latest;
        long _latestMicroseconds;
        string _problem;

        /// <inheritdoc/>
        public bool TryGetFrame(out long deviceMicroseconds, List<AzureKinectBody> bodies)
        {
            lock (_lock)
            {
                deviceMicroseconds = _latestMicroseconds;
                bodies.Clear();
                if (_latest == null) return false;
                bodies.AddRange(_latest);
                _latest = null;
                return true;
            }
        }

        void OnEnable()
        {
            _isWanted = true;
            _thread = new Thread(Track) { IsBackground = true, Name = "Azure Kinect" };
            _thread.Start();
        }

        void OnDisable()
        {
            _isWanted = false;
            _thread.Join(JoinMs);
        }

        void Update()
        {
            string problem;
            lock (_lock)
            {
                problem = _problem;
                _problem = null;
            }
            if (problem != null) Debug.LogError("Azure Kinect: " + problem, this);
        }

        void Track()
        {
            try
            {
                using (Device device = Device.Open(0))
                {
                    device.StartCameras(new DeviceConfiguration
                    {
                        CameraFPS = FPS.FPS30,
                        ColorResolution = ColorResolution.Off,
                        DepthMode = DepthMode.NFOV_Unbinned,
                    });
                    using (Tracker tracker = Tracker.Create(device.GetCalibration(), TrackerConfiguration.Default))
                    {
                        while (_isWanted) Track(device, tracker);
                    }
                }
            }
            catch (Exception wrong)
            {
                // The SDK throws exceptions of several families; this is the thread's edge.
                lock (_lock) _problem = wrong.Message;
            }
        }

        void Track(Device device, Tracker tracker)
        {
            using (Capture capture = device.GetCapture()) tracker.EnqueueCapture(capture);
            using (TrackedFrame frame = tracker.PopResult(TimeSpan.FromSeconds(1), false))
            {
                if (frame == null) return;
                var bodies = new List<AzureKinectBody>();
                for (uint i = 0; i < frame.NumberOfBodies; i++) bodies.Add(Copy(frame, i));
                lock (_lock)
                {
                    _latest = bodies;
                    _latestMicroseconds = frame.DeviceTimestamp.Ticks / 10;
                }
            }
        }

        static AzureKinectBody Copy(TrackedFrame frame, uint index)
        {
            TrackedSkeleton skeleton = frame.GetBodySkeleton(index);
            var copy = new AzureKinectBody { Id = frame.GetBodyId(index) };
            for (int i = 0; i < copy.Joints.Length; i++)
            {
                TrackedJoint joint = skeleton.GetJoint(i);
                copy.Joints[i] = new AzureKinectJoint
                {
                    X = joint.Position.X,
                    Y = joint.Position.Y,
                    Z = joint.Position.Z,
                    Confidence = (AzureKinectConfidence)(int)joint.ConfidenceLevel,
                };
            }
            return copy;
        }
    }
}
#endif
