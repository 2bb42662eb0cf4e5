using System;

namespace AgentServer
{
    /// <summary>x, y and z; unit and frame are those of the message.</summary>
    public readonly struct Point3 : IEquatable<Point3>
    {
        /// <summary>Makes a point.</summary>
        public Point3(double x, double y, double z)
        {
            X = x;
            Y = y;
            Z = z;
        }

        /// <summary>First coordinate.</summary>
        public double X { get; }

        /// <summary>Second coordinate.</summary>
        public double Y { get; }

        /// <summary>Third coordinate.</summary>
        public double Z { get; }

        /// <inheritdoc/>
        public bool Equals(Point3 other) => X == other.X && Y == other.Y && Z == other.Z;

        /// <inheritdoc/>
        public override bool Equals(object other) => other is Point3 point && Equals(point);

        /// <inheritdoc/>
        public override int GetHashCode() => (X, Y, Z).GetHashCode();

        internal static Point3 Read(WireReader reader, double limit = double.MaxValue)
        {
            reader.BeginTuple(3);
            var point = new Point3(
                reader.Number(-limit, limit), reader.Number(-limit, limit), reader.Number(-limit, limit));
            reader.EndTuple();
            return point;
        }

        internal void Write(WireWriter writer)
        {
            writer.BeginArray(3);
            writer.Item();
            writer.Float(X);
            writer.Item();
            writer.Float(Y);
            writer.Item();
            writer.Float(Z);
            writer.EndArray();
        }
    }

    /// <summary>A joint: x, y and z, and how far it can be trusted.</summary>
    public readonly struct JointSample : IEquatable<JointSample>
    {
        /// <summary>Makes a joint.</summary>
        public JointSample(double x, double y, double z, double confidence)
        {
            X = x;
            Y = y;
            Z = z;
            Confidence = confidence;
        }

        /// <summary>First coordinate.</summary>
        public double X { get; }

        /// <summary>Second coordinate.</summary>
        public double Y { get; }

        /// <summary>Third coordinate.</summary>
        public double Z { get; }

        /// <summary>0 not tracked, 0.5 inferred, 1 tracked.</summary>
        public double Confidence { get; }

        /// <inheritdoc/>
        public bool Equals(JointSample other) =>
            X == other.X && Y == other.Y && Z == other.Z && Confidence == other.Confidence;

        /// <inheritdoc/>
        public override bool Equals(object other) => other is JointSample joint && Equals(joint);

        /// <inheritdoc/>
        public override int GetHashCode() => (X, Y, Z, Confidence).GetHashCode();

        // Of a joint that a sensor sends, the stage behind the decoder checks every number.
        internal static JointSample Read(WireReader reader) =>
            Read(reader, double.MaxValue, double.MinValue, double.MaxValue);

        internal static JointSample Read(WireReader reader, double limit) => Read(reader, limit, 0, 1);

        static JointSample Read(WireReader reader, double limit, double least, double most)
        {
            reader.BeginTuple(4);
            var joint = new JointSample(
                reader.Number(-limit, limit),
                reader.Number(-limit, limit),
                reader.Number(-limit, limit),
                reader.Number(least, most));
            reader.EndTuple();
            return joint;
        }

        internal void Write(WireWriter writer)
        {
            writer.BeginArray(4);
            writer.Item();
            writer.Float(X);
            writer.Item();
            writer.Float(Y);
            writer.Item();
            writer.Float(Z);
            writer.Item();
            writer.Float(Confidence);
            writer.EndArray();
        }
    }
}
