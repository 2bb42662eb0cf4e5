using System;
using System.Numerics;
using System.Threading;

// What the sender uses of Microsoft.Azure.Kinect.Sensor 1.4 and Microsoft.Azure.Kinect.BodyTracking 1.1,
// without a device: for the compiler and for tests. One body is seen; joint n lies at (n, -n, 2000) and
// its confidence goes through the four levels.
namespace Microsoft.Azure.Kinect.Sensor
{
    public enum FPS
    {
        FPS30 = 2,
    }

    public enum ColorResolution
    {
        Off = 0,
    }

    public enum DepthMode
    {
        NFOV_Unbinned = 2,
    }

    public enum WiredSyncMode
    {
        Standalone = 0,
    }

    public sealed class DeviceConfiguration
    {
        public FPS CameraFPS { get; set; }

        public ColorResolution ColorResolution { get; set; }

        public DepthMode DepthMode { get; set; }

        public WiredSyncMode WiredSyncMode { get; set; }
    }

    public struct Calibration
    {
    }

    public sealed class Capture : IDisposable
    {
        public void Dispose()
        {
        }
    }

    public sealed class Device : IDisposable
    {
        const int FrameMs = 33;

        public static Device Open(int index = 0) => new Device();

        public void StartCameras(DeviceConfiguration configuration)
        {
        }

        public void StopCameras()
        {
        }

        public Calibration GetCalibration() => new Calibration();

        public Capture GetCapture()
        {
            Thread.Sleep(FrameMs);
            return new Capture();
        }

        public void Dispose()
        {
        }
    }
}

namespace Microsoft.Azure.Kinect.BodyTracking
{
    public enum TrackerProcessingMode
    {
        Gpu = 0,
    }

    public enum SensorOrientation
    {
        Default = 0,
    }

    public enum JointConfidenceLevel
    {
        None = 0,
        Low = 1,
        Medium = 2,
        High = 3,
    }

    public sealed class TrackerConfiguration
    {
        public TrackerProcessingMode ProcessingMode { get; set; }

        public SensorOrientation SensorOrientation { get; set; }
    }

    public struct Joint
    {
        public Vector3 Position { get; set; }

        public JointConfidenceLevel ConfidenceLevel { get; set; }
    }

    public struct Skeleton
    {
        public Joint GetJoint(int index) => new Joint
        {
            Position = new Vector3(index, -index, 2000),
            ConfidenceLevel = (JointConfidenceLevel)(index % 4),
        };
    }

    public sealed class Frame : IDisposable
    {
        internal Frame(TimeSpan at)
        {
            DeviceTimestamp = at;
        }

        public TimeSpan DeviceTimestamp { get; }

        public uint NumberOfBodies => 1;

        public uint GetBodyId(uint index) => 7;

        public Skeleton GetBodySkeleton(uint index) => new Skeleton();

        public void Dispose()
        {
        }
    }

    public sealed class Tracker : IDisposable
    {
        TimeSpan _at = TimeSpan.FromMinutes(5);
        bool _isWaiting;

        public static Tracker Create(Microsoft.Azure.Kinect.Sensor.Calibration calibration, TrackerConfiguration configuration) =>
            new Tracker();

        public void EnqueueCapture(Microsoft.Azure.Kinect.Sensor.Capture capture)
        {
            _isWaiting = true;
        }

        public Frame PopResult(TimeSpan timeout, bool throwOnTimeout = true)
        {
            if (!_isWaiting) return null;
            _isWaiting = false;
            _at += TimeSpan.FromMilliseconds(33);
            return new Frame(_at);
        }

        public void Dispose()
        {
        }
    }
}
