using UnityEngine;
using UnityEngine.XR;

namespace AgentServer.Unity
{
    /// <summary>
    /// Where the wearer of a headset looks: with the eyes where it tracks them, else straight ahead.
    /// </summary>
    /// <remarks>
    /// A headset hides the face. The gate of the server then goes by the gaze (hello face `gaze`), or is
    /// off (`none`) if there is no headset either.
    /// </remarks>
    [AddComponentMenu("Agent Server/Headset Gaze Source")]
    public sealed class HeadsetGazeSource : MonoBehaviour, IGazeSource
    {
        [SerializeField, Tooltip("Origin of the headset's poses, mostly the parent of the XR camera.")]
        Transform _trackingSpace;

        [SerializeField, Tooltip("Stands where the sensor of the skeletons stands, and looks along z as it does.")]
        Transform _sensor;

        [SerializeField, Tooltip("Use the eyes if the headset tracks them.")]
        bool _useEyes = true;

        /// <inheritdoc/>
        public bool HasGaze => _trackingSpace != null && _sensor != null && Head().isValid;

        /// <summary>Names the places, for scenes that are built by a program.</summary>
        public void Place(Transform trackingSpace, Transform sensor)
        {
            _trackingSpace = trackingSpace;
            _sensor = sensor;
        }

        /// <inheritdoc/>
        public bool TryGetGaze(out Point3 origin, out Point3 direction)
        {
            origin = default(Point3);
            direction = default(Point3);
            Vector3 place, way;
            if (!HasGaze || !TryRay(out place, out way)) return false;
            origin = Point(Coordinates.Locate(_sensor, _trackingSpace.TransformPoint(place)));
            direction = Point(Coordinates.LocateDirection(_sensor, _trackingSpace.TransformDirection(way)));
            return true;
        }

        /// <summary>The ray in the tracking space.</summary>
        bool TryRay(out Vector3 place, out Vector3 way)
        {
            way = Vector3.forward;
            InputDevice head = Head();
            Quaternion turn;
            if (!(head.TryGetFeatureValue(CommonUsages.centerEyePosition, out place)
                    && head.TryGetFeatureValue(CommonUsages.centerEyeRotation, out turn))
                && !(head.TryGetFeatureValue(CommonUsages.devicePosition, out place)
                    && head.TryGetFeatureValue(CommonUsages.deviceRotation, out turn)))
                return false;
            way = turn * Vector3.forward;
            Eyes eyes;
            Vector3 fixation;
            if (_useEyes
                && head.TryGetFeatureValue(CommonUsages.eyesData, out eyes)
                && eyes.TryGetFixationPoint(out fixation)
                && (fixation - place).magnitude > 0.01f)
                way = fixation - place;
            return true;
        }

        static InputDevice Head() => InputDevices.GetDeviceAtXRNode(XRNode.Head);

        static Point3 Point(Vector3 v) => new Point3(v.x, v.y, v.z);
    }
}
