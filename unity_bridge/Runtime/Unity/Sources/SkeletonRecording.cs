using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;

namespace AgentServer.Unity
{
    /// <summary>
    /// Body tracks as JSON lines: the server's format `kinect-json` (docs/kinect-json.md), lines of
    /// `skeleton` messages, or both, as the session recorder writes them.
    /// </summary>
    public sealed class SkeletonRecording
    {
        const double NsPerS = 1e9;
        const double LargestNumber = 9007199254740991;

        SkeletonRecording(IReadOnlyList<SkeletonSample> samples)
        {
            Samples = samples;
        }

        /// <summary>In the order of capture; the first is at 0.</summary>
        public IReadOnlyList<SkeletonSample> Samples { get; }

        /// <summary>Time of the last sample in nanoseconds.</summary>
        public long DurationNs => Samples[Samples.Count - 1].OriginatingNs;

        /// <summary>Reads a recording.</summary>
        /// <param name="text">The lines.</param>
        /// <param name="name">What it is called in messages of exceptions.</param>
        /// <exception cref="FormatException">Names the recording, the line, what is wrong and the fix.</exception>
        public static SkeletonRecording Parse(string text, string name)
        {
            var samples = new List<SkeletonSample>();
            Dictionary<string, object> header = null;
            var lines = new StringReader(text);
            string line;
            for (int number = 1; (line = lines.ReadLine()) != null; number++)
            {
                if (line.Trim().Length == 0) continue;
                try
                {
                    Dictionary<string, object> fields = JsonLine.Object(line);
                    if (fields.ContainsKey("joints"))
                    {
                        SkeletonSample sample = Sample(fields, header);
                        // As the server does: who is not seen at all is left out.
                        if (sample.Joints.Any(joint => joint.Confidence > 0)) samples.Add(sample);
                    }
                    else if (header == null && samples.Count == 0) header = fields;
                    else throw new FormatException("there are no joints in it");
                }
                catch (FormatException wrong)
                {
                    throw new FormatException(name + ", line " + number + ": " + wrong.Message);
                }
            }
            if (samples.Count == 0) throw new FormatException(name + ": there is no body in it");
            return new SkeletonRecording(FromZero(samples));
        }

        static SkeletonSample Sample(Dictionary<string, object> fields, Dictionary<string, object> header)
        {
            object format;
            if (!fields.TryGetValue("format", out format) && (header == null || !header.TryGetValue("format", out format)))
                throw new FormatException("the joint table is missing: give \"format\" in the first line");
            JointTable table = JointTable.Find(format as string ?? "");
            if (table == null) throw new FormatException("the joint table '" + format + "' is not known");
            object id;
            if (!fields.TryGetValue("body_id", out id)) id = 0L;
            if (!(id is long) || (long)id < 0)
                throw new FormatException("body_id: give a whole number that is not negative");
            return new SkeletonSample(
                Stamp(fields, header), SensorTime.BodyId((ulong)(long)id), table.Format, Joints(fields["joints"], table));
        }

        static long Stamp(Dictionary<string, object> fields, Dictionary<string, object> header)
        {
            string[] given = new[] { "time_s", "originating_ns", "frame" }.Where(fields.ContainsKey).ToArray();
            if (given.Length != 1)
                throw new FormatException("give exactly one of time_s, originating_ns and frame");
            double value = Number(fields, given[0]);
            if (given[0] == "time_s") value *= NsPerS;
            if (given[0] == "frame")
            {
                if (header == null || !header.ContainsKey("rate_hz"))
                    throw new FormatException("frame needs \"rate_hz\" in the first line");
                value *= NsPerS / Number(header, "rate_hz");
            }
            if (!(value >= 0) || value > LargestNumber)
                throw new FormatException(given[0] + ": give a time that is not negative, below 2^53 ns");
            return (long)Math.Round(value);
        }

        static IReadOnlyList<JointSample> Joints(object given, JointTable table)
        {
            var joints = new JointSample[table.Names.Count];
            var list = given as List<object>;
            var named = given as Dictionary<string, object>;
            if (list == null && named == null)
                throw new FormatException("joints: give a list of all joints, or named ones");
            if (list != null && list.Count != joints.Length)
                throw new FormatException(
                    "joints: " + table.Format + " has " + joints.Length + " joints, got " + list.Count);
            for (int i = 0; list != null && i < list.Count; i++)
                joints[i] = Joint(list[i], table.Names[i]);
            foreach (KeyValuePair<string, object> one in named ?? new Dictionary<string, object>())
            {
                int index = table.IndexOf(one.Key);
                if (index < 0) throw new FormatException("joints." + one.Key + ": " + table.Format + " has no such joint");
                joints[index] = Joint(one.Value, one.Key);
            }
            return joints;
        }

        static JointSample Joint(object given, string name)
        {
            var numbers = given as List<object>;
            if (numbers == null || numbers.Count < 3 || numbers.Count > 4 || !numbers.All(IsNumber))
                throw new FormatException("joints." + name + ": give [x, y, z] or [x, y, z, confidence]");
            double confidence = numbers.Count == 4 ? Value(numbers[3]) : 1;
            if (confidence < 0 || confidence > 1)
                throw new FormatException("joints." + name + ": the confidence lies between 0 and 1");
            return new JointSample(Value(numbers[0]), Value(numbers[1]), Value(numbers[2]), confidence);
        }

        static double Number(Dictionary<string, object> fields, string name)
        {
            object value = fields[name];
            if (IsNumber(value)) return Value(value);
            throw new FormatException(name + ": give a number");
        }

        static bool IsNumber(object value) => value is double || value is long;

        static double Value(object number) => Convert.ToDouble(number);

        static List<SkeletonSample> FromZero(List<SkeletonSample> samples)
        {
            long start = samples.Min(one => one.OriginatingNs);
            // OrderBy keeps the order of what is at one time.
            return samples
                .Select(one => new SkeletonSample(one.OriginatingNs - start, one.BodyId, one.Format, one.Joints))
                .OrderBy(one => one.OriginatingNs)
                .ToList();
        }
    }
}
