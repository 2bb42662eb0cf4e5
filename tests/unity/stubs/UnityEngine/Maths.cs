// The engine's maths as its manual describes it: left-handed axes, y up, angles in degrees.
using System;

namespace UnityEngine
{
    public struct Vector3 : IEquatable<Vector3>
    {
        public float x, y, z;

        public Vector3(float x, float y, float z)
        {
            this.x = x;
            this.y = y;
            this.z = z;
        }

        public static Vector3 zero => new Vector3(0, 0, 0);
        public static Vector3 one => new Vector3(1, 1, 1);
        public static Vector3 right => new Vector3(1, 0, 0);
        public static Vector3 left => new Vector3(-1, 0, 0);
        public static Vector3 up => new Vector3(0, 1, 0);
        public static Vector3 down => new Vector3(0, -1, 0);
        public static Vector3 forward => new Vector3(0, 0, 1);
        public static Vector3 back => new Vector3(0, 0, -1);

        public float sqrMagnitude => x * x + y * y + z * z;
        public float magnitude => (float)Math.Sqrt((double)x * x + (double)y * y + (double)z * z);

        public Vector3 normalized
        {
            get
            {
                float size = magnitude;
                return size > 1e-5f ? this / size : zero;
            }
        }

        public static float Dot(Vector3 a, Vector3 b) => a.x * b.x + a.y * b.y + a.z * b.z;

        public static Vector3 Cross(Vector3 a, Vector3 b) =>
            new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);

        public static float Angle(Vector3 a, Vector3 b)
        {
            float size = (float)Math.Sqrt(a.sqrMagnitude * b.sqrMagnitude);
            if (size < 1e-15f) return 0;
            return (float)Math.Acos(Math.Max(-1.0, Math.Min(1.0, Dot(a, b) / size))) * Mathf.Rad2Deg;
        }

        public static Vector3 MoveTowards(Vector3 current, Vector3 target, float maxDistanceDelta)
        {
            Vector3 way = target - current;
            float size = way.magnitude;
            return size <= maxDistanceDelta || size == 0 ? target : current + way / size * maxDistanceDelta;
        }

        public static Vector3 Scale(Vector3 a, Vector3 b) => new Vector3(a.x * b.x, a.y * b.y, a.z * b.z);

        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator -(Vector3 a, Vector3 b) => new Vector3(a.x - b.x, a.y - b.y, a.z - b.z);
        public static Vector3 operator -(Vector3 a) => new Vector3(-a.x, -a.y, -a.z);
        public static Vector3 operator *(Vector3 a, float s) => new Vector3(a.x * s, a.y * s, a.z * s);
        public static Vector3 operator *(float s, Vector3 a) => a * s;
        public static Vector3 operator /(Vector3 a, float s) => new Vector3(a.x / s, a.y / s, a.z / s);
        public static bool operator ==(Vector3 a, Vector3 b) => (a - b).sqrMagnitude < 9.99999944e-11f;
        public static bool operator !=(Vector3 a, Vector3 b) => !(a == b);

        public bool Equals(Vector3 other) => x == other.x && y == other.y && z == other.z;
        public override bool Equals(object other) => other is Vector3 vector && Equals(vector);
        public override int GetHashCode() => x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2);
        public override string ToString() => "(" + x + ", " + y + ", " + z + ")";
    }

    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x, y, z, w;

        public Quaternion(float x, float y, float z, float w)
        {
            this.x = x;
            this.y = y;
            this.z = z;
            this.w = w;
        }

        public static Quaternion identity => new Quaternion(0, 0, 0, 1);

        public Quaternion normalized
        {
            get
            {
                float size = (float)Math.Sqrt(Dot(this, this));
                return size < 1e-6f ? identity : new Quaternion(x / size, y / size, z / size, w / size);
            }
        }

        public static float Dot(Quaternion a, Quaternion b) => a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;

        public static Quaternion Inverse(Quaternion q)
        {
            float size = Dot(q, q);
            return new Quaternion(-q.x / size, -q.y / size, -q.z / size, q.w / size);
        }

        /// Degrees between two rotations.
        public static float Angle(Quaternion a, Quaternion b)
        {
            double dot = Math.Min(Math.Abs(Dot(a, b)), 1.0);
            return (float)(2.0 * Math.Acos(dot)) * Mathf.Rad2Deg;
        }

        public static Quaternion AngleAxis(float degrees, Vector3 axis)
        {
            Vector3 unit = axis.normalized;
            double half = degrees * Mathf.Deg2Rad / 2.0;
            float sine = (float)Math.Sin(half);
            return new Quaternion(unit.x * sine, unit.y * sine, unit.z * sine, (float)Math.Cos(half));
        }

        /// Turns z, then x, then y, as the engine does.
        public static Quaternion Euler(float x, float y, float z) =>
            AngleAxis(y, Vector3.up) * AngleAxis(x, Vector3.right) * AngleAxis(z, Vector3.forward);

        public static Quaternion Euler(Vector3 degrees) => Euler(degrees.x, degrees.y, degrees.z);

        public static Quaternion FromToRotation(Vector3 from, Vector3 to)
        {
            Vector3 a = from.normalized, b = to.normalized;
            float dot = Vector3.Dot(a, b);
            if (dot < -0.999999f)
            {
                Vector3 side = Vector3.Cross(Vector3.right, a);
                if (side.sqrMagnitude < 1e-6f) side = Vector3.Cross(Vector3.up, a);
                return AngleAxis(180, side);
            }
            Vector3 axis = Vector3.Cross(a, b);
            return new Quaternion(axis.x, axis.y, axis.z, 1 + dot).normalized;
        }

        public static Quaternion LookRotation(Vector3 forward) => LookRotation(forward, Vector3.up);

        public static Quaternion LookRotation(Vector3 forward, Vector3 upwards)
        {
            Vector3 z = forward.normalized;
            Vector3 x = Vector3.Cross(upwards, z).normalized;
            if (x == Vector3.zero) return FromToRotation(Vector3.forward, z);
            Vector3 y = Vector3.Cross(z, x);
            return FromAxes(x, y, z);
        }

        static Quaternion FromAxes(Vector3 x, Vector3 y, Vector3 z)
        {
            double trace = x.x + y.y + z.z;
            if (trace > 0)
            {
                double s = Math.Sqrt(trace + 1) * 2;
                return new Quaternion((float)((y.z - z.y) / s), (float)((z.x - x.z) / s), (float)((x.y - y.x) / s), (float)(s / 4));
            }
            if (x.x > y.y && x.x > z.z)
            {
                double s = Math.Sqrt(1 + x.x - y.y - z.z) * 2;
                return new Quaternion((float)(s / 4), (float)((y.x + x.y) / s), (float)((z.x + x.z) / s), (float)((y.z - z.y) / s));
            }
            if (y.y > z.z)
            {
                double s = Math.Sqrt(1 + y.y - x.x - z.z) * 2;
                return new Quaternion((float)((y.x + x.y) / s), (float)(s / 4), (float)((z.y + y.z) / s), (float)((z.x - x.z) / s));
            }
            else
            {
                double s = Math.Sqrt(1 + z.z - x.x - y.y) * 2;
                return new Quaternion((float)((z.x + x.z) / s), (float)((z.y + y.z) / s), (float)(s / 4), (float)((x.y - y.x) / s));
            }
        }

        public static Quaternion Slerp(Quaternion a, Quaternion b, float t)
        {
            t = Mathf.Clamp01(t);
            double dot = Dot(a, b);
            double sign = dot < 0 ? -1 : 1;
            dot = Math.Min(Math.Abs(dot), 1.0);
            double from = 1 - t, to = t;
            if (dot < 0.99999)
            {
                double angle = Math.Acos(dot);
                from = Math.Sin((1 - t) * angle) / Math.Sin(angle);
                to = Math.Sin(t * angle) / Math.Sin(angle);
            }
            to *= sign;
            return new Quaternion(
                (float)(from * a.x + to * b.x), (float)(from * a.y + to * b.y),
                (float)(from * a.z + to * b.z), (float)(from * a.w + to * b.w)).normalized;
        }

        public static Quaternion RotateTowards(Quaternion from, Quaternion to, float maxDegreesDelta)
        {
            float angle = Angle(from, to);
            return angle == 0 ? to : Slerp(from, to, Math.Min(1, maxDegreesDelta / angle));
        }

        /// The rotation b, then a.
        public static Quaternion operator *(Quaternion a, Quaternion b) => new Quaternion(
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);

        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            Vector3 axis = new Vector3(q.x, q.y, q.z);
            Vector3 twice = 2f * Vector3.Cross(axis, v);
            return v + q.w * twice + Vector3.Cross(axis, twice);
        }

        public static bool operator ==(Quaternion a, Quaternion b) => Dot(a, b) > 0.999999f;
        public static bool operator !=(Quaternion a, Quaternion b) => !(a == b);

        public bool Equals(Quaternion other) => x == other.x && y == other.y && z == other.z && w == other.w;
        public override bool Equals(object other) => other is Quaternion quaternion && Equals(quaternion);
        public override int GetHashCode() => x.GetHashCode() ^ (y.GetHashCode() << 2) ^ (z.GetHashCode() >> 2) ^ (w.GetHashCode() >> 1);
        public override string ToString() => "(" + x + ", " + y + ", " + z + ", " + w + ")";
    }

    public static class Mathf
    {
        public const float PI = (float)Math.PI;
        public const float Deg2Rad = PI / 180;
        public const float Rad2Deg = 180 / PI;

        public static float Abs(float f) => Math.Abs(f);
        public static float Max(float a, float b) => Math.Max(a, b);
        public static int Max(int a, int b) => Math.Max(a, b);
        public static float Min(float a, float b) => Math.Min(a, b);
        public static int Min(int a, int b) => Math.Min(a, b);
        public static float Clamp01(float f) => Math.Max(0, Math.Min(1, f));
        public static float Exp(float f) => (float)Math.Exp(f);
        public static float Sin(float f) => (float)Math.Sin(f);
        public static float Sqrt(float f) => (float)Math.Sqrt(f);
    }

    public struct Color
    {
        public float r, g, b, a;

        public Color(float r, float g, float b, float a = 1)
        {
            this.r = r;
            this.g = g;
            this.b = b;
            this.a = a;
        }
    }
}
