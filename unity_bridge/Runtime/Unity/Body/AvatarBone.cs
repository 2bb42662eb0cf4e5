using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>The bones of a humanoid avatar that nine joints move; a parent comes first.</summary>
    public enum AvatarBone
    {
        /// <summary>Turns about the vertical alone.</summary>
        Hips,

        /// <summary>Takes half of the lean and twist of the trunk.</summary>
        Spine,

        /// <summary>Takes the other half.</summary>
        Chest,

        /// <summary>Points to the head.</summary>
        Neck,

        /// <summary>Follows the neck.</summary>
        Head,

        /// <summary>Stays at rest.</summary>
        LeftShoulder,

        /// <summary>From the left shoulder to the left elbow.</summary>
        LeftUpperArm,

        /// <summary>From the left elbow to the left wrist.</summary>
        LeftLowerArm,

        /// <summary>Stays at rest.</summary>
        RightShoulder,

        /// <summary>From the right shoulder to the right elbow.</summary>
        RightUpperArm,

        /// <summary>From the right elbow to the right wrist.</summary>
        RightLowerArm,
    }

    /// <summary>How the bones of <see cref="AvatarBone"/> hang together.</summary>
    public static class AvatarBones
    {
        /// <summary>Number of bones.</summary>
        public const int Count = 11;

        static readonly int[] Parents = { -1, 0, 1, 2, 3, 2, 5, 6, 2, 8, 9 };

        static readonly HumanBodyBones[] Names =
        {
            HumanBodyBones.Hips, HumanBodyBones.Spine, HumanBodyBones.Chest,
            HumanBodyBones.Neck, HumanBodyBones.Head,
            HumanBodyBones.LeftShoulder, HumanBodyBones.LeftUpperArm, HumanBodyBones.LeftLowerArm,
            HumanBodyBones.RightShoulder, HumanBodyBones.RightUpperArm, HumanBodyBones.RightLowerArm,
        };

        /// <summary>Index of a bone's parent; -1 for the hips.</summary>
        public static int ParentOf(int bone) => Parents[bone];

        /// <summary>What Unity calls a bone.</summary>
        public static HumanBodyBones Human(int bone) => Names[bone];

        /// <summary>Every bone at rest.</summary>
        public static Quaternion[] Rest()
        {
            var rotations = new Quaternion[Count];
            Fill(rotations, Quaternion.identity);
            return rotations;
        }

        internal static void Fill(IList<Quaternion> rotations, Quaternion value)
        {
            for (int i = 0; i < rotations.Count; i++) rotations[i] = value;
        }
    }
}
