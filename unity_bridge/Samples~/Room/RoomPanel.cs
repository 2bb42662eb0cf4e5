using AgentServer.Unity;
using UnityEngine;

namespace AgentServer.Samples
{
    /// <summary>
    /// Buttons on the screen that change the objects of a room by hand, and how the connection stands. It is
    /// added to the object of a <see cref="Room"/>.
    /// </summary>
    [RequireComponent(typeof(Room))]
    public sealed class RoomPanel : MonoBehaviour
    {
        const float Margin = 10, Width = 240, Height = 400;

        Room _room;
        RoomObject[] _objects = new RoomObject[0];

        void OnEnable()
        {
            _room = GetComponent<Room>();
            _objects = GetComponentsInChildren<RoomObject>(true);
        }

        void OnGUI()
        {
            GUILayout.BeginArea(new Rect(Margin, Margin, Width, Height));
            GUILayout.Label("Connection: " + _room.Client.Phase);
            GUILayout.Label("The agent: " + _room.Mode);
            foreach (RoomObject thing in _objects)
            {
                if (thing.HasStates && GUILayout.Button(thing.ObjectName + ": " + thing.State)) thing.ChangeToNext();
            }
            GUILayout.EndArea();
        }
    }
}
