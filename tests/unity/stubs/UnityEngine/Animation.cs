using System.Collections.Generic;

namespace UnityEngine
{
    public enum HumanBodyBones
    {
        Hips,
        LeftUpperLeg,
        RightUpperLeg,
        LeftLowerLeg,
        RightLowerLeg,
        LeftFoot,
        RightFoot,
        Spine,
        Chest,
        Neck,
        Head,
        LeftShoulder,
        RightShoulder,
        LeftUpperArm,
        RightUpperArm,
        LeftLowerArm,
        RightLowerArm,
        LeftHand,
        RightHand,
    }

    public struct SkeletonBone
    {
        public string name;
        public Vector3 position;
        public Quaternion rotation;
        public Vector3 scale;
    }

    public struct HumanDescription
    {
        public SkeletonBone[] skeleton;
    }

    public sealed class Avatar : Object
    {
        public bool isValid { get; set; } = true;
        public bool isHuman { get; set; } = true;
        public HumanDescription humanDescription { get; set; }
    }

    public sealed class Animator : Behaviour
    {
        // What a test looks at, and sets up.
        public readonly Dictionary<HumanBodyBones, Transform> Bones = new Dictionary<HumanBodyBones, Transform>();
        public readonly HashSet<int> States = new HashSet<int>();
        public readonly List<string> Calls = new List<string>();

        public Avatar avatar { get; set; }
        public float speed { get; set; } = 1;

        public Transform GetBoneTransform(HumanBodyBones bone)
        {
            Transform found;
            return Bones.TryGetValue(bone, out found) ? found : null;
        }

        public static int StringToHash(string name)
        {
            int hash = 17;
            foreach (char c in name) hash = unchecked(hash * 31 + c);
            return hash;
        }

        public bool HasState(int layer, int hash) => States.Contains(hash);
        public void CrossFadeInFixedTime(int hash, float seconds, int layer) => Calls.Add("fade " + hash);
        public void SetTrigger(string name) => Calls.Add("trigger " + name);
        public void ResetTrigger(string name) => Calls.Add("reset " + name);
    }
}
