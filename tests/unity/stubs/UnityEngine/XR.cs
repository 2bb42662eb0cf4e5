using System.Collections.Generic;

namespace UnityEngine.XR
{
    public enum XRNode
    {
        LeftEye,
        RightEye,
        CenterEye,
        Head,
    }

    public struct InputFeatureUsage<T>
    {
        public InputFeatureUsage(string name)
        {
            this.name = name;
        }

        public string name { get; }
    }

    public static class CommonUsages
    {
        public static InputFeatureUsage<Vector3> devicePosition = new InputFeatureUsage<Vector3>("DevicePosition");
        public static InputFeatureUsage<Quaternion> deviceRotation = new InputFeatureUsage<Quaternion>("DeviceRotation");
        public static InputFeatureUsage<Vector3> centerEyePosition = new InputFeatureUsage<Vector3>("CenterEyePosition");
        public static InputFeatureUsage<Quaternion> centerEyeRotation = new InputFeatureUsage<Quaternion>("CenterEyeRotation");
        public static InputFeatureUsage<Eyes> eyesData = new InputFeatureUsage<Eyes>("EyesData");
    }

    public struct Eyes
    {
        // What a test sets up.
        public Vector3? Fixation;

        public bool TryGetFixationPoint(out Vector3 fixationPoint)
        {
            fixationPoint = Fixation ?? Vector3.zero;
            return Fixation.HasValue;
        }
    }

    public struct InputDevice
    {
        internal Dictionary<string, object> Features;

        public bool isValid => Features != null;
        public string name => "stub";

        public bool TryGetFeatureValue(InputFeatureUsage<Vector3> usage, out Vector3 value) => Get(usage.name, out value);
        public bool TryGetFeatureValue(InputFeatureUsage<Quaternion> usage, out Quaternion value) => Get(usage.name, out value);
        public bool TryGetFeatureValue(InputFeatureUsage<Eyes> usage, out Eyes value) => Get(usage.name, out value);

        bool Get<T>(string name, out T value)
        {
            object found = null;
            bool has = Features != null && Features.TryGetValue(name, out found);
            value = has ? (T)found : default(T);
            return has;
        }
    }

    public static class InputDevices
    {
        // What a test sets up: the features of the device at a node.
        public static readonly Dictionary<XRNode, Dictionary<string, object>> Devices = new Dictionary<XRNode, Dictionary<string, object>>();

        public static InputDevice GetDeviceAtXRNode(XRNode node)
        {
            Dictionary<string, object> features;
            Devices.TryGetValue(node, out features);
            return new InputDevice { Features = features };
        }
    }
}
