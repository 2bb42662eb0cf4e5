// What the samples name of the camera SDKs: Kinect.2.0 for Unity, and Azure Kinect's two packages.
using System;
using System.Collections.Generic;

namespace Windows.Kinect
{
    public enum JointType
    {
        SpineBase,
    }

    public enum TrackingState
    {
        NotTracked,
        Inferred,
        Tracked,
    }

    public struct CameraSpacePoint
    {
        public float X { get; set; }
        public float Y { get; set; }
        public float Z { get; set; }
    }

    public struct Joint
    {
        public CameraSpacePoint Position { get; set; }
        public TrackingState TrackingState { get; set; }
    }

    public sealed class Body
    {
        public bool IsTracked => false;
        public ulong TrackingId => 0;
        public Dictionary<JointType, Joint> Joints => null;
    }

    public sealed class BodyFrame : IDisposable
    {
        public TimeSpan RelativeTime => TimeSpan.Zero;
        public void GetAndRefreshBodyData(IList<Body> bodies)
        {
        }

        public void Dispose()
        {
        }
    }

    public sealed class BodyFrameReader
    {
        public BodyFrame AcquireLatestFrame() => null;
    }

    public sealed class BodyFrameSource
    {
        public int BodyCount => 6;
        public BodyFrameReader OpenReader() => null;
    }

    public sealed class KinectSensor
    {
        public bool IsOpen => false;
        public BodyFrameSource BodyFrameSource => null;
        public static KinectSensor GetDefault() => null;
        public void Open()
        {
        }
    }
}

namespace Microsoft.Azure.Kinect.Sensor
{
    public enum FPS
    {
        FPS30,
    }

    public enum ColorResolution
    {
        Off,
    }

    public enum DepthMode
    {
        NFOV_Unbinned,
    }

    public sealed class DeviceConfiguration
    {
        public FPS CameraFPS { get; set; }
        public ColorResolution ColorResolution { get; set; }
        public DepthMode DepthMode { get; set; }
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
        public static Device Open(int index) => null;
        public void StartCameras(DeviceConfiguration configuration)
        {
        }

        public Calibration GetCalibration() => default(Calibration);
        public Capture GetCapture() => null;
        public void Dispose()
        {
        }
    }
}

namespace Microsoft.Azure.Kinect.BodyTracking
{
    public enum JointConfidenceLevel
    {
        None,
        Low,
        Medium,
        High,
    }

    public struct Position
    {
        public float X, Y, Z;
    }

    public struct Joint
    {
        public Position Position { get; set; }
        public JointConfidenceLevel ConfidenceLevel { get; set; }
    }

    public struct Skeleton
    {
        public Joint GetJoint(int index) => default(Joint);
    }

    public sealed class Frame : IDisposable
    {
        public uint NumberOfBodies => 0;
        public TimeSpan DeviceTimestamp => TimeSpan.Zero;
        public uint GetBodyId(uint index) => 0;
        public Skeleton GetBodySkeleton(uint index) => default(Skeleton);
        public void Dispose()
        {
        }
    }

    public sealed class TrackerConfiguration
    {
        public static TrackerConfiguration Default => null;
    }

    public sealed class Tracker : IDisposable
    {
        public static Tracker Create(Sensor.Calibration calibration, TrackerConfiguration configuration) => null;
        public void EnqueueCapture(Sensor.Capture capture)
        {
        }

        public Frame PopResult(TimeSpan timeout, bool throwOnTimeout) => null;
        public void Dispose()
        {
        }
    }
}
