using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// The one place where coordinates change hands: between the server's camera frame and Unity.
    /// </summary>
    /// <remarks>
    /// <para>The camera frame is right-handed: metres, x to the person's right when they face the
    /// sensor, y up, z from the sensor to the person. Unity is left-handed, y up.</para>
    /// <para><see cref="ToUnity(Vector3)"/> keeps x and y and negates z. The image of somebody who
    /// faces the sensor looks along +z with the right hand at +x, as an avatar at rest does, so the
    /// person's right hand is the avatar's right hand. It is its own inverse; both directions have a
    /// name so that code says which one it means.</para>
    /// <para><see cref="Place"/> and <see cref="Locate"/> put a person where they are in the scene:
    /// before a transform that stands where the sensor stands and looks, along its z, where the
    /// sensor looks. That is the same with half a turn about the vertical.</para>
    /// </remarks>
    public static class Coordinates
    {
        /// <summary>A point or direction of the camera frame in Unity's axes, in the same unit.</summary>
        public static Vector3 ToUnity(Vector3 camera) => Flip(camera);

        /// <summary>A point or direction of Unity in the camera frame, in the same unit.</summary>
        public static Vector3 ToCamera(Vector3 unity) => Flip(unity);

        /// <summary>A rotation of the camera frame (right-handed) as the same rotation in Unity.</summary>
        public static Quaternion ToUnity(Quaternion camera) => Flip(camera);

        /// <summary>A rotation of Unity as the same rotation in the camera frame.</summary>
        public static Quaternion ToCamera(Quaternion unity) => Flip(unity);

        /// <summary>A point of the camera frame in the world.</summary>
        /// <param name="sensor">Stands where the sensor stands, and looks along z as it does.</param>
        /// <param name="camera">In metres.</param>
        public static Vector3 Place(Transform sensor, Vector3 camera) =>
            sensor.position + sensor.rotation * HalfTurn(ToUnity(camera));

        /// <summary>A point of the world in the camera frame, in metres.</summary>
        /// <param name="sensor">Stands where the sensor stands, and looks along z as it does.</param>
        /// <param name="world">In metres.</param>
        public static Vector3 Locate(Transform sensor, Vector3 world) =>
            ToCamera(HalfTurn(Quaternion.Inverse(sensor.rotation) * (world - sensor.position)));

        /// <summary>A direction of the world in the camera frame.</summary>
        /// <param name="sensor">Stands where the sensor stands, and looks along z as it does.</param>
        /// <param name="world">Of any length.</param>
        public static Vector3 LocateDirection(Transform sensor, Vector3 world) =>
            ToCamera(HalfTurn(Quaternion.Inverse(sensor.rotation) * world));

        static Vector3 HalfTurn(Vector3 v) => new Vector3(-v.x, v.y, -v.z);

        static Vector3 Flip(Vector3 v) => new Vector3(v.x, v.y, -v.z);

        // Mirrored at the plane z = 0, an axis keeps its z and turns the other way round: the
        // axis (x, y, z) at an angle a becomes (-x, -y, z) at the same a.
        static Quaternion Flip(Quaternion q) => new Quaternion(-q.x, -q.y, q.z, q.w);
    }
}
