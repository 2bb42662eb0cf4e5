using UnityEditor;
using UnityEngine;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>
    /// Builds the room of the server's own rule file out of primitives, with everything wired: press play,
    /// and commands are carried out.
    /// </summary>
    public static class SampleRoomBuilder
    {
        /// <summary>The room in the open scene; the agent sits at the origin and looks along z.</summary>
        [MenuItem("Agent Server/Build sample room")]
        public static void BuildInScene()
        {
            GameObject room = Build();
            Undo.RegisterCreatedObjectUndo(room, "Build sample room");
            Selection.activeGameObject = room;
            if (Camera.main != null)
                Debug.Log("Agent Server: the scene has a main camera; put it before the desk, for example at "
                    + "(0, 1.6, 3.2) with a rotation of (12, 180, 0).");
        }

        /// <summary>Builds it without undo or selection.</summary>
        public static GameObject Build()
        {
            var root = new GameObject("Sample room");
            Transform top = root.transform;
            var client = root.AddComponent<AgentClient>();
            client.Telemetry = true;
            // `agent-server demo` has a renderer of its own, whose place the room takes.
            client.TakeOver = true;
            var room = root.AddComponent<Room>();
            room.Client = client;
            Walls(top);
            Scenery(top);
            Window(top);
            Curtain(top);
            HiFi(top);
            Cigarette(top);
            Transform person = Viewer(top);
            FigureMotion figure = FigureBuilder.Agent(top, Vector3.zero);
            figure.gameObject.AddComponent<AgentAnimator>().Wire(client, room, person);
            // The person as the server sees them, small, on the wall behind the agent.
            HumanoidRetargeter shown = FigureBuilder.Person(top, new Vector3(1.2f, 0.4f, -1.6f));
            shown.Client = client;
            return root;
        }

        static void Walls(Transform top)
        {
            RoomParts.Box("Floor", top, new Vector3(0, -0.05f, 0.5f), new Vector3(6, 0.1f, 6), RoomParts.Light);
            RoomParts.Box("Wall behind", top, new Vector3(0, 1.4f, -2.5f), new Vector3(6, 2.8f, 0.1f), RoomParts.Light);
            RoomParts.Box("Wall left", top, new Vector3(-3, 1.4f, 0.5f), new Vector3(0.1f, 2.8f, 6), RoomParts.Light);
        }

        static void Scenery(Transform top)
        {
            Transform desk = Thing(top, "desk", new Vector3(0, 0, 0.75f), null);
            RoomParts.Box("Top", desk, new Vector3(0, 0.72f, 0), new Vector3(1.6f, 0.05f, 0.7f), RoomParts.Wood);
            RoomParts.Box("Left side", desk, new Vector3(-0.75f, 0.35f, 0), new Vector3(0.05f, 0.7f, 0.65f), RoomParts.Wood);
            RoomParts.Box("Right side", desk, new Vector3(0.75f, 0.35f, 0), new Vector3(0.05f, 0.7f, 0.65f), RoomParts.Wood);
            Transform chair = Thing(top, "chair", Vector3.zero, Stand(top, "chair", Vector3.zero, 0));
            RoomParts.Box("Seat", chair, new Vector3(0, 0.42f, 0), new Vector3(0.45f, 0.06f, 0.45f), RoomParts.Dark);
            RoomParts.Box("Back", chair, new Vector3(0, 0.72f, -0.25f), new Vector3(0.45f, 0.55f, 0.05f), RoomParts.Dark);
            Transform keyboard = Thing(top, "keyboard", new Vector3(0, 0.76f, 0.55f), null);
            RoomParts.Box("Keys", keyboard, Vector3.zero, new Vector3(0.42f, 0.02f, 0.14f), RoomParts.Dark);
            Transform screen = Thing(top, "screen", new Vector3(-0.35f, 1, 0.95f), null);
            RoomParts.Box("Panel", screen, Vector3.zero, new Vector3(0.5f, 0.32f, 0.03f), RoomParts.Dark);
            Transform notebook = Thing(top, "notebook", new Vector3(-0.5f, 0.76f, 0.6f), null);
            RoomParts.Box("Pages", notebook, Vector3.zero, new Vector3(0.18f, 0.02f, 0.24f), RoomParts.Light);
        }

        static void Window(Transform top)
        {
            Transform window = RoomParts.Empty("window", top, new Vector3(-2.9f, 1.5f, -0.8f));
            RoomParts.Box("Frame", window, new Vector3(-0.03f, 0, 0), new Vector3(0.04f, 1.3f, 1.1f), RoomParts.Wood);
            GameObject closed = RoomParts.Box("Closed", window, Vector3.zero, new Vector3(0.03f, 1.2f, 1), RoomParts.Glass);
            GameObject open = RoomParts.Box("Open", window, new Vector3(0.4f, 0, -0.5f), new Vector3(0.8f, 1.2f, 0.03f), RoomParts.Glass);
            Describe(
                window, Stand(top, "window", new Vector3(-2.3f, 0, -0.8f), -90), "open",
                new ObjectState("open", open), new ObjectState("closed", closed));
        }

        static void Curtain(Transform top)
        {
            Transform curtain = RoomParts.Empty("curtain", top, new Vector3(-2.85f, 1.5f, 0.5f));
            GameObject open = RoomParts.Box("Open", curtain, new Vector3(0, 0, 0.6f), new Vector3(0.1f, 1.6f, 0.2f), RoomParts.Cloth);
            GameObject closed = RoomParts.Box("Closed", curtain, Vector3.zero, new Vector3(0.06f, 1.6f, 1.4f), RoomParts.Cloth);
            Describe(
                curtain, Stand(top, "curtain", new Vector3(-2.3f, 0, 0.5f), -90), "open",
                new ObjectState("open", open), new ObjectState("closed", closed));
        }

        static void HiFi(Transform top)
        {
            Transform hifi = RoomParts.Empty("hifi", top, new Vector3(2.3f, 0.9f, 0));
            RoomParts.Box("Shelf", hifi, new Vector3(0, -0.5f, 0), new Vector3(0.5f, 0.8f, 1), RoomParts.Wood);
            RoomParts.Box("Box", hifi, Vector3.zero, new Vector3(0.35f, 0.2f, 0.5f), RoomParts.Dark);
            GameObject low = RoomParts.Box("Low", hifi, new Vector3(-0.2f, -0.05f, 0), new Vector3(0.02f, 0.04f, 0.3f), RoomParts.Glow);
            GameObject high = RoomParts.Box("High", hifi, new Vector3(-0.2f, 0, 0), new Vector3(0.02f, 0.16f, 0.3f), RoomParts.Glow);
            Describe(
                hifi, Stand(top, "hifi", new Vector3(1.6f, 0, 0), 90), "high",
                new ObjectState("high", high), new ObjectState("low", low));
        }

        static void Cigarette(Transform top)
        {
            Transform cigarette = RoomParts.Empty("cigarette", top, new Vector3(0.45f, 0.77f, 0.6f));
            RoomParts.Solid(
                PrimitiveType.Cylinder, "Ashtray", cigarette, Vector3.zero, new Vector3(0.14f, 0.03f, 0.14f), RoomParts.Dark);
            GameObject lit = RoomParts.Box("Lit", cigarette, new Vector3(0, 0.025f, 0), new Vector3(0.01f, 0.01f, 0.08f), RoomParts.Glow);
            GameObject stub = RoomParts.Box("Out", cigarette, new Vector3(0, 0.025f, 0), new Vector3(0.01f, 0.01f, 0.03f), RoomParts.Light);
            Describe(
                cigarette, null, "lit",
                new ObjectState("lit", lit), new ObjectState("out", stub));
        }

        /// <summary>Where the person is: a camera, unless the scene has a main camera already.</summary>
        static Transform Viewer(Transform top)
        {
            if (Camera.main != null) return null;
            Transform viewer = RoomParts.Empty("Camera", top, new Vector3(0, 1.6f, 3.2f));
            viewer.localRotation = Quaternion.Euler(12, 180, 0);
            viewer.gameObject.tag = "MainCamera";
            viewer.gameObject.AddComponent<Camera>().fieldOfView = 60;
            Transform sun = RoomParts.Empty("Light", top, new Vector3(0, 3, 0));
            sun.localRotation = Quaternion.Euler(50, -30, 0);
            sun.gameObject.AddComponent<Light>().type = LightType.Directional;
            return viewer;
        }

        static Transform Thing(Transform top, string objectName, Vector3 place, Transform stand)
        {
            Transform made = RoomParts.Empty(objectName, top, place);
            Describe(made, stand, "");
            return made;
        }

        static void Describe(Transform thing, Transform stand, string state, params ObjectState[] states) =>
            thing.gameObject.AddComponent<RoomObject>().Describe(thing.name, stand, state, states);

        /// <summary>Where the agent stands to use an object, and looks.</summary>
        static Transform Stand(Transform top, string objectName, Vector3 place, float degrees)
        {
            Transform stand = RoomParts.Empty("Stand at " + objectName, top, place);
            stand.localRotation = Quaternion.Euler(0, degrees, 0);
            return stand;
        }
    }
}
