using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// How the bones of an avatar stand at rest, seen from its root: whatever axes its modeller gave
    /// them.
    /// </summary>
    public sealed class BindPose
    {
        readonly Quaternion[] _rotations;

        /// <param name="rotations">Rotation of each <see cref="AvatarBone"/> at rest, from the root.</param>
        /// <param name="leftArm">Direction from the left upper arm to the left lower arm at rest.</param>
        /// <param name="rightArm">The same on the right.</param>
        public BindPose(Quaternion[] rotations, Vector3 leftArm, Vector3 rightArm)
        {
            _rotations = rotations;
            Solver = new PoseSolver(leftArm, rightArm);
        }

        /// <summary>What turns joints into rotations for this avatar.</summary>
        public PoseSolver Solver { get; }

        /// <summary>Reads it off an avatar's transforms.</summary>
        /// <param name="root">The avatar's root, which faces +z at rest.</param>
        /// <param name="bones">One transform a bone of <see cref="AvatarBone"/>; null where there is none.</param>
        /// <param name="skeleton">
        /// The avatar's own T-pose, as <c>HumanDescription.skeleton</c> has it. A transform that it does
        /// not name counts as it stands now. Null takes all of them as they stand now.
        /// </param>
        public static BindPose Of(Transform root, Transform[] bones, SkeletonBone[] skeleton)
        {
            var named = new Dictionary<string, SkeletonBone>();
            if (skeleton != null)
                foreach (SkeletonBone bone in skeleton) named[bone.name] = bone;
            var rotations = new Quaternion[AvatarBones.Count];
            var places = new Vector3[AvatarBones.Count];
            for (int i = 0; i < bones.Length; i++)
            {
                rotations[i] = Quaternion.identity;
                if (bones[i] == null) continue;
                FromRoot(root, bones[i], named, out places[i], out rotations[i]);
            }
            return new BindPose(
                rotations,
                Arm(bones, places, AvatarBone.LeftUpperArm, Vector3.left),
                Arm(bones, places, AvatarBone.RightUpperArm, Vector3.right));
        }

        /// <summary>Rotation of a bone in the world.</summary>
        /// <param name="bone">Index of the bone.</param>
        /// <param name="root">Rotation of the avatar's root in the world.</param>
        /// <param name="turn">Turn of the bone against the T-pose, its parents' turns included.</param>
        public Quaternion World(int bone, Quaternion root, Quaternion turn) => root * turn * _rotations[bone];

        static Vector3 Arm(Transform[] bones, Vector3[] places, AvatarBone upper, Vector3 spare)
        {
            int i = (int)upper;
            if (bones[i] == null || bones[i + 1] == null) return spare;
            Vector3 way = places[i + 1] - places[i];
            return way.magnitude > 1e-3f ? way.normalized : spare;
        }

        static void FromRoot(
            Transform root,
            Transform bone,
            Dictionary<string, SkeletonBone> named,
            out Vector3 place,
            out Quaternion rotation)
        {
            place = Vector3.zero;
            rotation = Quaternion.identity;
            for (Transform at = bone; at != null && at != root; at = at.parent)
            {
                SkeletonBone rest;
                bool isNamed = named.TryGetValue(at.name, out rest);
                Quaternion turn = isNamed ? rest.rotation : at.localRotation;
                Vector3 scale = isNamed ? rest.scale : at.localScale;
                place = (isNamed ? rest.position : at.localPosition)
                    + turn * Vector3.Scale(scale, place);
                rotation = turn * rotation;
            }
        }
    }
}
