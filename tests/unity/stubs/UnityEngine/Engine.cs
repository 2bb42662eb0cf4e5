// The rest of the engine that the package names.
using System;
using System.Collections.Generic;
using UnityEngine.Events;

namespace UnityEngine
{
    public static class Time
    {
        public static float time { get; set; }
        public static float deltaTime { get; set; }
    }

    public static class Application
    {
        public static string streamingAssetsPath { get; set; } = ".";
    }

    public static class Debug
    {
        public static readonly List<string> Lines = new List<string>();

        public static void Log(object message) => Lines.Add("log: " + message);
        public static void Log(object message, Object context) => Log(message);
        public static void LogWarning(object message) => Lines.Add("warning: " + message);
        public static void LogWarning(object message, Object context) => LogWarning(message);
        public static void LogError(object message) => Lines.Add("error: " + message);
        public static void LogError(object message, Object context) => LogError(message);
    }

    public class TextAsset : Object
    {
        public TextAsset(string text)
        {
            this.text = text;
        }

        public string text { get; }
    }

    public class Shader : Object
    {
        public static Shader Find(string name) => new Shader { name = name };
    }

    public class Material : Object
    {
        public Material(Shader shader)
        {
        }

        public Material(Material source)
        {
            color = source.color;
        }

        public Color color { get; set; }
    }

    public class Renderer : Component
    {
        public bool enabled { get; set; } = true;
        public Material sharedMaterial { get; set; } = new Material(Shader.Find("Standard"));
    }

    public class MeshRenderer : Renderer
    {
    }

    public class Collider : Component
    {
    }

    public class BoxCollider : Collider
    {
    }

    public sealed class Camera : Behaviour
    {
        public static Camera main { get; set; }
        public float fieldOfView { get; set; }
    }

    public enum LightType
    {
        Spot,
        Directional,
        Point,
    }

    public sealed class Light : Behaviour
    {
        public LightType type { get; set; }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class SerializeField : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class TooltipAttribute : Attribute
    {
        public TooltipAttribute(string tooltip)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class HeaderAttribute : Attribute
    {
        public HeaderAttribute(string header)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class RangeAttribute : Attribute
    {
        public RangeAttribute(float min, float max)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Field)]
    public sealed class MinAttribute : Attribute
    {
        public MinAttribute(float min)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class AddComponentMenu : Attribute
    {
        public AddComponentMenu(string menuName)
        {
        }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DisallowMultipleComponent : Attribute
    {
    }

    [AttributeUsage(AttributeTargets.Class, AllowMultiple = true)]
    public sealed class RequireComponent : Attribute
    {
        public readonly Type Type;

        public RequireComponent(Type requiredComponent)
        {
            Type = requiredComponent;
        }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class CreateAssetMenuAttribute : Attribute
    {
        public string fileName { get; set; }
        public string menuName { get; set; }
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DefaultExecutionOrder : Attribute
    {
        public DefaultExecutionOrder(int order)
        {
        }
    }
}

namespace UnityEngine.Events
{
    public class UnityEvent
    {
        event Action Called;

        public void AddListener(UnityAction call) => Called += new Action(call);
        public void Invoke() => Called?.Invoke();
    }

    public class UnityEvent<T>
    {
        readonly List<UnityAction<T>> _calls = new List<UnityAction<T>>();

        public void AddListener(UnityAction<T> call) => _calls.Add(call);

        public void Invoke(T value)
        {
            foreach (UnityAction<T> call in _calls.ToArray()) call(value);
        }
    }

    public delegate void UnityAction();
    public delegate void UnityAction<T>(T value);
}
