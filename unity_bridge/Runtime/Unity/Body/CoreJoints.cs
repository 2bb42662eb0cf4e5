using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Index of each core joint in a pose or a frame of a forecast.</summary>
    public enum CoreJoint
    {
        /// <summary>Middle of the head.</summary>
        Head,

        /// <summary>Base of the neck, between the shoulders.</summary>
        Neck,

        /// <summary>Middle of the spine.</summary>
        Navel,

        /// <summary>The person's own left.</summary>
        LeftShoulder,

        /// <summary>The person's own left.</summary>
        LeftElbow,

        /// <summary>The person's own left.</summary>
        LeftWrist,

        /// <summary>The person's own right.</summary>
        RightShoulder,

        /// <summary>The person's own right.</summary>
        RightElbow,

        /// <summary>The person's own right.</summary>
        RightWrist,
    }

    /// <summary>Nine joints of a person in Unity's axes, in metres, with a confidence each.</summary>
    public sealed class CoreJoints
    {
        /// <summary>Number of joints.</summary>
        public const int Count = 9;

        static readonly string[] Streamed =
        {
            "head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand",
            "right_shoulder", "right_elbow", "right_hand",
        };

        static readonly int[] Mirrored = { 0, 1, 2, 6, 7, 8, 3, 4, 5 };

        /// <summary>Where each joint is, in metres.</summary>
        public readonly Vector3[] Positions = new Vector3[Count];

        /// <summary>How far each is to be trusted, in [0, 1]; 0 is a lost joint.</summary>
        public readonly float[] Confidence = new float[Count];

        /// <summary>Takes an observed pose.</summary>
        /// <returns>False, and nothing is changed, if it has not nine joints.</returns>
        public bool Take(PoseMessage pose)
        {
            if (pose.Joints.Count != Count) return false;
            for (int i = 0; i < Count; i++)
            {
                JointSample joint = pose.Joints[i];
                Set(i, joint.X, joint.Y, joint.Z, (float)joint.Confidence);
            }
            return true;
        }

        /// <summary>Takes one frame of a forecast, whose joints are all as sure.</summary>
        /// <param name="forecast">50 frames at 25 Hz.</param>
        /// <param name="frame">Index of the frame; 0 is 40 ms after the window.</param>
        /// <returns>False, and nothing is changed, if there is no such frame.</returns>
        public bool Take(ForecastMessage forecast, int frame)
        {
            if (frame < 0 || frame >= forecast.Positions.Count) return false;
            IReadOnlyList<Point3> points = forecast.Positions[frame];
            if (points.Count != Count) return false;
            for (int i = 0; i < Count; i++) Set(i, points[i].X, points[i].Y, points[i].Z, 1);
            return true;
        }

        /// <summary>Takes the present pose of a motion, whose left is the agent's own.</summary>
        /// <returns>False if nothing plays, or a joint is missing.</returns>
        public bool Take(PoseStreamPlayer player)
        {
            for (int i = 0; i < Count; i++)
            {
                Point3 place;
                if (!player.Joint(Streamed[i], out place)) return false;
                // Right-handed and facing +z: to Unity's axes x changes its sign.
                Positions[i] = new Vector3(-(float)place.X, (float)place.Y, (float)place.Z);
                Confidence[i] = 1;
            }
            return true;
        }

        /// <summary>Makes of these joints what a mirror in front of the person shows.</summary>
        public void Mirror()
        {
            for (int i = 0; i < Count; i++)
            {
                int other = Mirrored[i];
                if (other < i) continue;
                Vector3 position = Positions[i];
                float confidence = Confidence[i];
                Positions[i] = Reflect(Positions[other]);
                Confidence[i] = Confidence[other];
                if (other == i) continue;
                Positions[other] = Reflect(position);
                Confidence[other] = confidence;
            }
        }

        void Set(int joint, double x, double y, double z, float confidence)
        {
            Positions[joint] = Coordinates.ToUnity(new Vector3((float)x, (float)y, (float)z));
            Confidence[joint] = confidence;
        }

        static Vector3 Reflect(Vector3 v) => new Vector3(-v.x, v.y, v.z);
    }
}
