using UnityEngine;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>Builds the two figures of the sample room: the agent, and the person as the server sees them.</summary>
    static class FigureBuilder
    {
        /// <summary>A figure that stands, sits, walks and reaches.</summary>
        public static FigureMotion Agent(Transform parent, Vector3 place)
        {
            Transform root = RoomParts.Empty("Agent", parent, place);
            Transform hips = RoomParts.Empty("Hips", root, new Vector3(0, 0.9f, 0));
            RoomParts.Solid(
                PrimitiveType.Capsule, "Trunk", hips, new Vector3(0, 0.28f, 0), new Vector3(0.34f, 0.62f, 0.22f), RoomParts.Shirt);
            Transform head = RoomParts.Empty("Head", hips, new Vector3(0, 0.62f, 0));
            RoomParts.Solid(
                PrimitiveType.Sphere, "Skull", head, new Vector3(0, 0.12f, 0), new Vector3(0.2f, 0.25f, 0.22f), RoomParts.Skin);
            RoomParts.Box("Nose", head, new Vector3(0, 0.1f, 0.12f), new Vector3(0.03f, 0.04f, 0.05f), RoomParts.Skin);
            Transform leftThigh = Leg(hips, "Left", -0.1f);
            Transform rightThigh = Leg(hips, "Right", 0.1f);
            var motion = root.gameObject.AddComponent<FigureMotion>();
            motion.Assemble(
                hips, head,
                RoomParts.Limb("Left arm", hips, new Vector3(-0.22f, 0.5f, 0), 0.6f, 0.09f, RoomParts.Shirt),
                RoomParts.Limb("Right arm", hips, new Vector3(0.22f, 0.5f, 0), 0.6f, 0.09f, RoomParts.Shirt),
                leftThigh, rightThigh, leftThigh.Find("Left shin"), rightThigh.Find("Right shin"));
            return motion;
        }

        /// <summary>The upper body of the person, in a T-pose, with a retargeter.</summary>
        public static HumanoidRetargeter Person(Transform parent, Vector3 place)
        {
            Transform root = RoomParts.Empty("Person", parent, place);
            var bones = new Transform[AvatarBones.Count];
            Transform hips = Put(bones, AvatarBone.Hips, root, new Vector3(0, 0.92f, 0));
            Transform spine = Put(bones, AvatarBone.Spine, hips, new Vector3(0, 0.1f, 0));
            Transform chest = Put(bones, AvatarBone.Chest, spine, new Vector3(0, 0.13f, 0));
            Transform neck = Put(bones, AvatarBone.Neck, chest, new Vector3(0, 0.28f, 0));
            Transform head = Put(bones, AvatarBone.Head, neck, new Vector3(0, 0.09f, 0));
            RoomParts.Solid(
                PrimitiveType.Capsule, "Belly", hips, new Vector3(0, 0.1f, 0), new Vector3(0.28f, 0.4f, 0.18f), RoomParts.Light);
            RoomParts.Solid(
                PrimitiveType.Capsule, "Ribs", chest, new Vector3(0, 0.1f, 0), new Vector3(0.32f, 0.4f, 0.2f), RoomParts.Light);
            RoomParts.Solid(
                PrimitiveType.Sphere, "Skull", head, new Vector3(0, 0.1f, 0), new Vector3(0.18f, 0.23f, 0.2f), RoomParts.Light);
            Arm(bones, chest, -1, AvatarBone.LeftShoulder);
            Arm(bones, chest, 1, AvatarBone.RightShoulder);
            var retargeter = root.gameObject.AddComponent<HumanoidRetargeter>();
            retargeter.SetBones(root, bones);
            return retargeter;
        }

        static Transform Leg(Transform hips, string side, float x)
        {
            Transform thigh = RoomParts.Limb(side + " thigh", hips, new Vector3(x, 0, 0), 0.45f, 0.14f, RoomParts.Dark);
            RoomParts.Limb(side + " shin", thigh, new Vector3(0, -0.45f, 0), 0.45f, 0.11f, RoomParts.Dark);
            return thigh;
        }

        static void Arm(Transform[] bones, Transform chest, float side, AvatarBone shoulder)
        {
            Transform collar = Put(bones, shoulder, chest, new Vector3(0.03f * side, 0.24f, 0));
            Transform upper = Put(bones, shoulder + 1, collar, new Vector3(0.15f * side, 0, 0));
            Transform lower = Put(bones, shoulder + 2, upper, new Vector3(0.316f * side, 0, 0));
            Bar(upper, side, 0.316f);
            Bar(lower, side, 0.26f);
        }

        static void Bar(Transform bone, float side, float length) =>
            RoomParts.Box(
                bone.name + " shape", bone, new Vector3(side * length / 2, 0, 0),
                new Vector3(length, 0.08f, 0.08f), RoomParts.Light);

        static Transform Put(Transform[] bones, AvatarBone bone, Transform parent, Vector3 place) =>
            bones[(int)bone] = RoomParts.Empty(bone.ToString(), parent, place);
    }
}
