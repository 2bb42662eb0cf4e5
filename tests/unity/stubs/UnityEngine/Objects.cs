// Objects, components and transforms: enough of the engine to build a scene and look at it.
// The engine's own calls (Awake, Update, ...) are made by a test, with Lifecycle.
using System;
using System.Collections.Generic;
using System.Linq;

namespace UnityEngine
{
    public class Object
    {
        internal bool IsDestroyed;

        public string name { get; set; } = "";

        public static implicit operator bool(Object one) => one != null;
        public static bool operator ==(Object a, Object b) =>
            ReferenceEquals(a, b) || IsGone(a) && IsGone(b);
        public static bool operator !=(Object a, Object b) => !(a == b);
        public override bool Equals(object other) => ReferenceEquals(this, other);
        public override int GetHashCode() => base.GetHashCode();

        public static void DestroyImmediate(Object one)
        {
            var thing = one as GameObject;
            if (thing != null)
            {
                foreach (Transform child in thing.transform.Children.ToArray()) DestroyImmediate(child.gameObject);
                foreach (Component part in thing.Parts) part.IsDestroyed = true;
                thing.transform.SetParent(null, false);
                GameObject.All.Remove(thing);
            }
            var component = one as Component;
            if (component != null) component.gameObject.Parts.Remove(component);
            one.IsDestroyed = true;
        }

        static bool IsGone(Object one) => ReferenceEquals(one, null) || one.IsDestroyed;
    }

    public class ScriptableObject : Object
    {
    }

    public class Component : Object
    {
        public GameObject gameObject { get; internal set; }
        public Transform transform => gameObject.transform;
        public T GetComponent<T>() => gameObject.GetComponent<T>();
        public T[] GetComponentsInChildren<T>(bool includeInactive) => gameObject.GetComponentsInChildren<T>(includeInactive);
    }

    public class Behaviour : Component
    {
        public bool enabled { get; set; } = true;
        public bool isActiveAndEnabled => enabled && gameObject.activeInHierarchy;
    }

    public class MonoBehaviour : Behaviour
    {
    }

    public sealed class GameObject : Object
    {
        internal static readonly List<GameObject> All = new List<GameObject>();
        internal readonly List<Component> Parts = new List<Component>();

        public GameObject() : this("New Game Object")
        {
        }

        public GameObject(string name)
        {
            this.name = name;
            transform = new Transform { gameObject = this };
            Parts.Add(transform);
            All.Add(this);
        }

        public Transform transform { get; }
        public string tag { get; set; } = "Untagged";
        public bool activeSelf { get; private set; } = true;
        public bool activeInHierarchy =>
            activeSelf && (transform.parent == null || transform.parent.gameObject.activeInHierarchy);

        public void SetActive(bool value)
        {
            activeSelf = value;
        }

        public T AddComponent<T>() where T : Component, new()
        {
            foreach (RequireComponent need in typeof(T).GetCustomAttributes(typeof(RequireComponent), true))
            {
                if (Parts.Any(part => need.Type.IsInstanceOfType(part))) continue;
                Add((Component)Activator.CreateInstance(need.Type));
            }
            return (T)Add(new T());
        }

        public T GetComponent<T>() => Parts.OfType<T>().FirstOrDefault();

        public T[] GetComponentsInChildren<T>(bool includeInactive)
        {
            var found = new List<T>();
            if (includeInactive || activeInHierarchy) found.AddRange(Parts.OfType<T>());
            foreach (Transform child in transform.Children) found.AddRange(child.gameObject.GetComponentsInChildren<T>(includeInactive));
            return found.ToArray();
        }

        public static GameObject CreatePrimitive(PrimitiveType type)
        {
            var made = new GameObject(type.ToString());
            made.AddComponent<MeshRenderer>();
            made.AddComponent<BoxCollider>();
            return made;
        }

        Component Add(Component part)
        {
            part.gameObject = this;
            part.name = name;
            Parts.Add(part);
            return part;
        }
    }

    public enum PrimitiveType
    {
        Sphere,
        Capsule,
        Cylinder,
        Cube,
        Plane,
        Quad,
    }

    public sealed class Transform : Component, System.Collections.IEnumerable
    {
        internal readonly List<Transform> Children = new List<Transform>();
        Transform _parent;

        public new string name
        {
            get => gameObject.name;
            set => gameObject.name = value;
        }

        public Vector3 localPosition { get; set; }
        public Quaternion localRotation { get; set; } = Quaternion.identity;
        public Vector3 localScale { get; set; } = Vector3.one;

        public Transform parent
        {
            get => _parent;
            set => SetParent(value, true);
        }

        public Vector3 position
        {
            get => _parent == null ? localPosition : _parent.TransformPoint(localPosition);
            set => localPosition = _parent == null ? value : _parent.InverseTransformPoint(value);
        }

        public Quaternion rotation
        {
            get => _parent == null ? localRotation : _parent.rotation * localRotation;
            set => localRotation = _parent == null ? value : Quaternion.Inverse(_parent.rotation) * value;
        }

        public Vector3 forward => rotation * Vector3.forward;
        public Vector3 up => rotation * Vector3.up;
        public Vector3 right => rotation * Vector3.right;

        public Vector3 TransformPoint(Vector3 point) => position + rotation * Vector3.Scale(Scale, point);
        public Vector3 TransformDirection(Vector3 way) => rotation * way;

        public Vector3 InverseTransformPoint(Vector3 point)
        {
            Vector3 way = Quaternion.Inverse(rotation) * (point - position);
            Vector3 scale = Scale;
            return new Vector3(way.x / scale.x, way.y / scale.y, way.z / scale.z);
        }

        public void SetParent(Transform to, bool worldPositionStays)
        {
            Vector3 place = position;
            Quaternion turn = rotation;
            if (_parent != null) _parent.Children.Remove(this);
            _parent = to;
            if (to != null) to.Children.Add(this);
            if (!worldPositionStays) return;
            position = place;
            rotation = turn;
        }

        public Transform Find(string path)
        {
            foreach (Transform child in Children)
            {
                if (child.name == path) return child;
                if (path.StartsWith(child.name + "/", StringComparison.Ordinal)) return child.Find(path.Substring(child.name.Length + 1));
            }
            return null;
        }

        public System.Collections.IEnumerator GetEnumerator() => Children.GetEnumerator();

        Vector3 Scale => _parent == null ? localScale : Vector3.Scale(_parent.Scale, localScale);
    }
}
