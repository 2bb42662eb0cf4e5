using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;

namespace AgentServer.KinectSender
{
    /// <summary>
    /// A person without a sensor: stands two metres away, breathes, and lifts both hands to the ears for
    /// two of every six seconds. Joints and frame are those of a Kinect v2, at 30 Hz.
    /// </summary>
    sealed class SyntheticSource : IBodySource
    {
        const double FrameS = 1.0 / 30;
        const double CycleS = 6;

        // x, y, z in metres of each joint, standing, in the order of the Kinect v2's SDK.
        static readonly float[,] Standing =
        {
            { 0, -0.40f, 2 }, { 0, -0.08f, 2.01f }, { 0, 0.27f, 2 }, { 0, 0.42f, 1.98f },
            { -0.17f, 0.15f, 2 }, { -0.20f, -0.10f, 2.02f }, { -0.21f, -0.34f, 1.98f }, { -0.21f, -0.42f, 1.96f },
            { 0.17f, 0.15f, 2 }, { 0.20f, -0.10f, 2.02f }, { 0.21f, -0.34f, 1.98f }, { 0.21f, -0.42f, 1.96f },
            { -0.08f, -0.40f, 2 }, { -0.10f, -0.80f, 2 }, { -0.10f, -1.18f, 2.02f }, { -0.11f, -1.24f, 1.92f },
            { 0.08f, -0.40f, 2 }, { 0.10f, -0.80f, 2 }, { 0.10f, -1.18f, 2.02f }, { 0.11f, -1.24f, 1.92f },
            { 0, 0.19f, 2.01f },
            { -0.21f, -0.50f, 1.95f }, { -0.17f, -0.44f, 1.94f }, { 0.21f, -0.50f, 1.95f }, { 0.17f, -0.44f, 1.94f },
        };

        // Elbow, wrist, hand, tip and thumb of either side, and where they are when the hands are up.
        static readonly int[] Left = { 5, 6, 7, 21, 22 };
        static readonly int[] Right = { 9, 10, 11, 23, 24 };
        static readonly float[,] Raised =
        {
            { 0.38f, 0.22f, 1.92f }, { 0.19f, 0.38f, 1.95f }, { 0.12f, 0.42f, 1.97f }, { 0.10f, 0.48f, 1.98f },
            { 0.11f, 0.40f, 1.94f },
        };

        readonly Stopwatch _clock = Stopwatch.StartNew();
        long _frame;

        public string Format => "kinect_v2";

        public void Read(List<BodySample> bodies)
        {
            double atS = _frame * FrameS;
            int leftMs = (int)Math.Ceiling(1000 * atS - _clock.ElapsedMilliseconds);
            if (leftMs > 0) Thread.Sleep(leftMs);
            _frame++;
            bodies.Add(new BodySample(1, TimeSpan.FromSeconds(atS), Joints(atS)));
        }

        public void Dispose()
        {
        }

        static float[] Joints(double atS)
        {
            var joints = new float[4 * Standing.GetLength(0)];
            float breath = (float)(0.005 * Math.Sin(2 * Math.PI * atS / 4));
            for (int joint = 0; joint < Standing.GetLength(0); joint++)
            {
                for (int axis = 0; axis < 3; axis++) joints[4 * joint + axis] = Standing[joint, axis];
                joints[4 * joint + 2] += breath;
                joints[4 * joint + 3] = 1;
            }
            float share = Share(atS % CycleS);
            Raise(joints, Left, -1, share);
            Raise(joints, Right, 1, share);
            return joints;
        }

        /// <summary>How far the hands are up: from 2 s to 4 s of a cycle, half a second to get there and back.</summary>
        static float Share(double atS)
        {
            double share = Math.Min(Math.Max((atS - 1.5) / 0.5, 0), Math.Max((4.5 - atS) / 0.5, 0));
            double inside = Math.Min(share, 1);
            return (float)(inside * inside * (3 - 2 * inside));
        }

        static void Raise(float[] joints, int[] arm, int side, float share)
        {
            for (int index = 0; index < arm.Length; index++)
            {
                for (int axis = 0; axis < 3; axis++)
                {
                    float raised = Raised[index, axis] * (axis == 0 ? side : 1);
                    int at = 4 * arm[index] + axis;
                    joints[at] += share * (raised - joints[at]);
                }
            }
        }
    }
}
