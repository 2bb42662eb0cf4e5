using UnityEngine;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>Makes the parts of the sample room out of primitives.</summary>
    static class RoomParts
    {
        public static readonly Color Wood = new Color(0.55f, 0.38f, 0.22f);
        public static readonly Color Dark = new Color(0.15f, 0.15f, 0.17f);
        public static readonly Color Light = new Color(0.85f, 0.85f, 0.82f);
        public static readonly Color Glass = new Color(0.6f, 0.8f, 0.95f);
        public static readonly Color Cloth = new Color(0.6f, 0.15f, 0.2f);
        public static readonly Color Glow = new Color(1f, 0.45f, 0.1f);
        public static readonly Color Skin = new Color(0.9f, 0.72f, 0.6f);
        public static readonly Color Shirt = new Color(0.25f, 0.4f, 0.65f);

        /// <summary>An empty object.</summary>
        public static Transform Empty(string name, Transform parent, Vector3 place)
        {
            Transform made = new GameObject(name).transform;
            made.SetParent(parent, false);
            made.localPosition = place;
            return made;
        }

        /// <summary>A primitive without a collider; sizes in metres.</summary>
        public static GameObject Solid(
            PrimitiveType type, string name, Transform parent, Vector3 place, Vector3 size, Color color)
        {
            GameObject made = GameObject.CreatePrimitive(type);
            made.name = name;
            Object.DestroyImmediate(made.GetComponent<Collider>());
            made.transform.SetParent(parent, false);
            made.transform.localPosition = place;
            // A capsule and a cylinder are two metres high.
            bool isTall = type == PrimitiveType.Capsule || type == PrimitiveType.Cylinder;
            made.transform.localScale = isTall ? new Vector3(size.x, size.y / 2, size.z) : size;
            // A copy of the pipeline's own material, so that it is drawn in every pipeline.
            Renderer renderer = made.GetComponent<Renderer>();
            renderer.sharedMaterial = new Material(renderer.sharedMaterial) { color = color };
            return made;
        }

        /// <summary>A box without a collider.</summary>
        public static GameObject Box(string name, Transform parent, Vector3 place, Vector3 size, Color color) =>
            Solid(PrimitiveType.Cube, name, parent, place, size, color);

        /// <summary>A joint with a limb that hangs down from it.</summary>
        public static Transform Limb(string name, Transform parent, Vector3 place, float length, float width, Color color)
        {
            Transform joint = Empty(name, parent, place);
            Solid(
                PrimitiveType.Capsule, name + " shape", joint,
                new Vector3(0, -length / 2, 0), new Vector3(width, length, width), color);
            return joint;
        }
    }
}
