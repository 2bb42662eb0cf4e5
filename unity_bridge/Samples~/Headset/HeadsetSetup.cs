using AgentServer.Unity;
using UnityEngine;

namespace AgentServer.Samples
{
    /// <summary>
    /// Sends a wearer's body from a depth camera and their gaze from the headset. Without a camera it plays
    /// the recording of a <see cref="RecordedSkeletonSource"/> on the same object, if there is one.
    /// </summary>
    [RequireComponent(typeof(SkeletonSender))]
    [RequireComponent(typeof(HeadsetGazeSource))]
    [DefaultExecutionOrder(-50)]
    public sealed class HeadsetSetup : MonoBehaviour
    {
        /// <summary>What sees the body.</summary>
        public enum Camera
        {
            /// <summary>A recording, or nothing.</summary>
            None,

            /// <summary>A Kinect v2; see KinectV2Bodies.cs.</summary>
            KinectV2,

            /// <summary>An Azure Kinect; see AzureKinectBodies.cs.</summary>
            AzureKinect,
        }

        [SerializeField, Tooltip("What sees the body.")]
        Camera _camera = Camera.None;

        [SerializeField, Tooltip("Parent of the XR camera.")]
        Transform _trackingSpace;

        [SerializeField, Tooltip("Stands where the depth camera stands, and looks along z as it does.")]
        Transform _sensor;

        void Awake()
        {
            GetComponent<HeadsetGazeSource>().Place(_trackingSpace, _sensor);
            ISkeletonSource source = Source();
            if (source != null) GetComponent<SkeletonSender>().Source = source;
        }

        ISkeletonSource Source()
        {
#if AGENT_SERVER_KINECT_V2
            if (_camera == Camera.KinectV2) return new KinectSkeletonSource(new KinectV2Bodies());
#endif
#if AGENT_SERVER_AZURE_KINECT
            if (_camera == Camera.AzureKinect)
                return new AzureKinectSkeletonSource(gameObject.AddComponent<AzureKinectBodies>());
#endif
            if (_camera != Camera.None)
                Debug.LogError("The code for " + _camera + " is not compiled: add its SDK and its scripting define, "
                    + "as the sample's README says.", this);
            return null;
        }
    }
}
