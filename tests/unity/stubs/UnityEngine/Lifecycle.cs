// What a test uses in the place of the engine's loop; no code of the package knows it.
using System;
using System.Linq;
using System.Reflection;

namespace UnityEngine
{
    public static class Lifecycle
    {
        /// Calls a message of every behaviour that has it, in the order in which they were made.
        public static void Send(string message, params object[] arguments)
        {
            foreach (GameObject thing in GameObject.All.ToArray())
            {
                if (thing.activeInHierarchy) Send(thing, message, arguments);
            }
        }

        public static void Send(GameObject thing, string message, params object[] arguments)
        {
            foreach (MonoBehaviour part in thing.Parts.OfType<MonoBehaviour>().ToArray())
            {
                if (part.enabled || message == "Awake" || message == "OnDestroy") Send(part, message, arguments);
            }
        }

        public static void Send(MonoBehaviour part, string message, params object[] arguments)
        {
            MethodInfo method = part.GetType().GetMethod(
                message, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public,
                null, arguments.Select(one => one.GetType()).ToArray(), null);
            if (method == null) return;
            try
            {
                method.Invoke(part, arguments);
            }
            catch (TargetInvocationException e)
            {
                throw new Exception(part.GetType().Name + "." + message + ": " + e.InnerException, e.InnerException);
            }
        }

        /// As the engine starts a scene.
        public static void Start()
        {
            Send("Awake");
            Send("OnEnable");
            Send("Start");
        }

        /// Frames of the given length in seconds.
        public static void Frames(int count, float seconds)
        {
            for (int i = 0; i < count; i++)
            {
                Time.deltaTime = seconds;
                Time.time += seconds;
                Send("Update");
                Send("LateUpdate");
            }
        }

        /// Forgets every object and the clock.
        public static void Reset()
        {
            GameObject.All.Clear();
            Debug.Lines.Clear();
            Time.time = 0;
            Time.deltaTime = 0;
        }
    }
}
