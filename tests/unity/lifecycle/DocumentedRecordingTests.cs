using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class DocumentedRecordingTests
    {
        [Test]
        public void TheExampleOfTheServersDocsIsRead()
        {
            string page = File.ReadAllText(Docs());
            string example = page.Split(new[] { "```json lines\n" }, 2, System.StringSplitOptions.None)[1];
            example = example.Substring(0, example.IndexOf("```", System.StringComparison.Ordinal));
            SkeletonRecording recording = SkeletonRecording.Parse(example, "example");
            Assert.AreEqual(
                new[] { 0L, 33000000L, 33000000L, 67000000L },
                recording.Samples.Select(one => one.OriginatingNs).ToArray());
            Assert.AreEqual(new[] { 1L, 1L, 2L, 1L }, recording.Samples.Select(one => one.BodyId).ToArray());
            Assert.AreEqual(new JointSample(0.95, 0.6, 3.4, 1), recording.Samples[2].Joints[3]);
            Assert.AreEqual(new JointSample(0.02, 0.71, 2.1, 1), recording.Samples[3].Joints[3]);
        }

        static string Docs([CallerFilePath] string here = "") =>
            Path.Combine(Path.GetDirectoryName(here), "../../../docs/kinect-json.md");
    }
}
