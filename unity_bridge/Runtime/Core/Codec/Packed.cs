using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>The messages that differ between the codings: numbers packed as little-endian float32.</summary>
    public static class Packed
    {
        /// <summary>The form of a message in the MessagePack coding; most have only one form.</summary>
        public static Message Of(Message message)
        {
            if (message is Skeleton skeleton)
                return new PackedSkeleton(
                    skeleton.OriginatingNs, skeleton.BodyId, skeleton.Format, Joints(skeleton.Joints));
            if (message is FacePoints face)
                return new PackedFacePoints(
                    face.OriginatingNs, face.Format, face.Width, face.Height, Rows(face.Points));
            if (message is PoseStreamMessage stream)
                return new PackedPoseStreamMessage(
                    stream.CommandId, stream.FirstFrame, stream.RateHz, stream.Joints,
                    Positions(stream.Positions), stream.IsLast, stream.Fallback);
            return message;
        }

        /// <summary>A motion of the MessagePack coding as one of the JSON coding: its whole frames.</summary>
        public static PoseStreamMessage Unpack(PackedPoseStreamMessage stretch)
        {
            int joints = stretch.Joints.Count;
            int count = joints == 0 ? 0 : stretch.Positions.Length / (12 * joints);
            var numbers = new float[3 * joints * count];
            var data = (byte[])stretch.Positions.Clone();
            if (!BitConverter.IsLittleEndian)
                for (int start = 0; start < data.Length; start += 4) Array.Reverse(data, start, 4);
            Buffer.BlockCopy(data, 0, numbers, 0, 4 * numbers.Length);
            var frames = new Point3[count][];
            for (int f = 0; f < frames.Length; f++)
            {
                frames[f] = new Point3[joints];
                for (int j = 0; j < joints; j++)
                {
                    int at = 3 * (f * joints + j);
                    frames[f][j] = new Point3(numbers[at], numbers[at + 1], numbers[at + 2]);
                }
            }
            return new PoseStreamMessage(
                stretch.CommandId, stretch.FirstFrame, stretch.RateHz, stretch.Joints, frames,
                stretch.IsLast, stretch.Fallback);
        }

        /// <summary>Numbers as little-endian float32.</summary>
        public static byte[] Floats(float[] numbers)
        {
            var data = new byte[4 * numbers.Length];
            Floats(numbers, data);
            return data;
        }

        internal static void Floats(float[] numbers, byte[] data)
        {
            Buffer.BlockCopy(numbers, 0, data, 0, data.Length);
            if (BitConverter.IsLittleEndian) return;
            for (int start = 0; start < data.Length; start += 4) Array.Reverse(data, start, 4);
        }

        static byte[] Joints(IReadOnlyList<JointSample> joints)
        {
            var numbers = new float[4 * joints.Count];
            for (int joint = 0; joint < joints.Count; joint++)
            {
                numbers[4 * joint] = (float)joints[joint].X;
                numbers[4 * joint + 1] = (float)joints[joint].Y;
                numbers[4 * joint + 2] = (float)joints[joint].Z;
                numbers[4 * joint + 3] = (float)joints[joint].Confidence;
            }
            return Floats(numbers);
        }

        static byte[] Rows(IReadOnlyList<IReadOnlyList<double>> rows)
        {
            var numbers = new List<float>();
            foreach (IReadOnlyList<double> row in rows)
                foreach (double number in row) numbers.Add((float)number);
            return Floats(numbers.ToArray());
        }

        static byte[] Positions(IReadOnlyList<IReadOnlyList<Point3>> frames)
        {
            var numbers = new List<float>();
            foreach (IReadOnlyList<Point3> frame in frames)
            {
                foreach (Point3 point in frame)
                {
                    numbers.Add((float)point.X);
                    numbers.Add((float)point.Y);
                    numbers.Add((float)point.Z);
                }
            }
            return Floats(numbers.ToArray());
        }
    }
}
