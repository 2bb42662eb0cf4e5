using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using AgentServer.Unity.EditorTools;
using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class SkeletonRecordingTests
    {
        const string Header = "{\"format\": \"kinect_v2\", \"rate_hz\": 25, \"subject\": \"ann\"}\n";

        [Test]
        public void NamedJointsAreFoundHoweverTheyAreSpelled()
        {
            SkeletonSample sample = Parse(Header
                + "{\"time_s\": 12.4, \"body_id\": 1, \"joints\": {\"Head\": [0.02, 0.71, 2.1, 0.5], \"wrist_left\": [1, 2, 3]}}")
                .Samples[0];
            Assert.AreEqual(25, sample.Joints.Count);
            Assert.AreEqual(new JointSample(0.02, 0.71, 2.1, 0.5), sample.Joints[3]);
            Assert.AreEqual(new JointSample(1, 2, 3, 1), sample.Joints[6]);
            Assert.AreEqual(0.0, sample.Joints[0].Confidence);
        }

        [Test]
        public void TimeStartsAtTheEarliestLine()
        {
            SkeletonRecording recording = Parse(Header
                + "{\"time_s\": 12.5, \"joints\": {\"Head\": [0, 0, 2]}}\n\n"
                + "{\"time_s\": 12.4, \"joints\": {\"Head\": [0, 0, 3]}}\n");
            Assert.AreEqual(0L, recording.Samples[0].OriginatingNs);
            Assert.AreEqual(3.0, recording.Samples[0].Joints[3].Z);
            Assert.AreEqual(100000000L, recording.DurationNs);
        }

        [Test]
        public void FramesHaveARate()
        {
            SkeletonRecording recording = Parse(Header
                + "{\"frame\": 0, \"joints\": {\"Head\": [0, 0, 2]}}\n{\"frame\": 5, \"joints\": {\"Head\": [0, 0, 2]}}");
            Assert.AreEqual(200000000L, recording.DurationNs);
        }

        [Test]
        public void LinesOfMessagesNeedNoHeader()
        {
            var message = new Skeleton(1033000000, 3, "core9", Make.Person().Positions
                .Select(one => new JointSample(one.x, one.y, one.z, 1)).ToArray());
            SkeletonSample sample = Parse(Codec.Of(Coding.Json).Encode(message).Text).Samples[0];
            Assert.AreEqual("core9", sample.Format);
            Assert.AreEqual(3L, sample.BodyId);
            Assert.AreEqual(message.Joints.ToArray(), sample.Joints.ToArray());
        }

        [Test]
        public void AKinectsIdsStayDifferent()
        {
            const string Line = "{\"time_s\": 0, \"body_id\": 7205759403792793X, \"joints\": {\"Head\": [0, 0, 2]}}\n";
            // 2^56 and two more.
            SkeletonRecording recording = Parse(Header + Line.Replace('X', '6') + Line.Replace('X', '8'));
            Assert.AreEqual(0L, recording.Samples[0].BodyId);
            Assert.AreEqual(2L, recording.Samples[1].BodyId);
        }

        [Test]
        public void MistakesNameTheLineAndTheFix()
        {
            Refused("{\"time_s\": 0, \"joints\": {\"Hed\": [0, 0, 2]}}", "run, line 2: joints.Hed: kinect_v2 has no such joint");
            Refused("{\"time_s\": 0, \"joints\": [[0, 0, 2]]}", "run, line 2: joints: kinect_v2 has 25 joints, got 1");
            Refused("{\"joints\": {}}", "run, line 2: give exactly one of time_s, originating_ns and frame");
            Refused("{\"time_s\": 0, \"frame\": 1, \"joints\": {}}", "run, line 2: give exactly one of time_s, originating_ns and frame");
            Refused("{\"time_s\": -1, \"joints\": {}}", "run, line 2: time_s: give a time that is not negative, below 2^53 ns");
            Refused("{\"time_s\": 0, \"joints\": {\"Head\": [0, 2]}}", "run, line 2: joints.Head: give [x, y, z] or [x, y, z, confidence]");
            Refused("{\"time_s\": 0, \"joints\": {\"Head\": [0, 0, 2, 7]}}", "run, line 2: joints.Head: the confidence lies between 0 and 1");
            Refused("{\"time_s\": 0", "run, line 2: expected ',' at character 13");
            Refused("hello", "run, line 2: expected a value at character 1");
            Refused("{\"time_s\": 0, \"body_id\": 1.5, \"joints\": {}}", "run, line 2: body_id: give a whole number that is not negative");
            Refused("{\"time_s\": 0}", "run, line 2: there are no joints in it");
            Refused("{\"time_s\": 0, \"joints\": {\"Head\": [0, 0, 2, 0]}}", "run: there is no body in it");
            Refused("", "run: there is no body in it");
        }

        [Test]
        public void AnUnknownFormatIsRefused()
        {
            string said = Assert.Throws<FormatException>(
                () => SkeletonRecording.Parse("{\"format\": \"vicon\"}\n{\"time_s\": 0, \"joints\": []}", "run")).Message;
            Assert.AreEqual("run, line 2: the joint table 'vicon' is not known", said);
        }

        [Test]
        public void APlayerGivesWhatFallsDue()
        {
            var player = new SkeletonPlayer(ThreeFrames(), false);
            Assert.AreEqual(new[] { 0L }, Played(player, 0.01));
            Assert.AreEqual(new[] { 40000000L }, Played(player, 0.04));
            Assert.AreEqual(new[] { 80000000L }, Played(player, 1));
            Assert.IsTrue(player.IsOver);
            Assert.AreEqual(0, Played(player, 1).Length);
        }

        [Test]
        public void ALoopGoesOnInTime()
        {
            var player = new SkeletonPlayer(ThreeFrames(), true);
            long[] stamps = Played(player, 0.2);
            Assert.AreEqual(new[] { 0L, 40000000L, 80000000L, 120000000L, 160000000L, 200000000L }, stamps);
            Assert.IsTrue(!player.IsOver);
        }

        [Test]
        public void WhatTheRecorderWritesIsPlayed()
        {
            var telemetry = new StringWriter();
            var skeletons = new StringWriter();
            var joints = Enumerable.Range(0, 9).Select(i => new JointSample(i, 0.5, 2, 1)).ToArray();
            using (var recorder = new SessionRecorder(telemetry, skeletons))
            {
                recorder.Take(new PoseMessage(5000000000, 7, joints));
                recorder.Take(new PoseMessage(5040000000, 7, joints));
                recorder.Take(new SceneState("working", new Dictionary<string, string> { { "window", "open" } }));
                // The session was opened anew: its time starts again.
                recorder.Take(new PoseMessage(0, 8, joints));
                Assert.AreEqual(4, recorder.Messages);
                Assert.AreEqual(3, recorder.Frames);
            }
            SkeletonRecording recording = SkeletonRecording.Parse(skeletons.ToString(), "run");
            Assert.AreEqual(
                new[] { 0L, 40000000L, 80000000L }, recording.Samples.Select(one => one.OriginatingNs).ToArray());
            Assert.AreEqual(joints, recording.Samples[0].Joints.ToArray());
            Assert.AreEqual(8L, recording.Samples[2].BodyId);
            Assert.AreEqual(4, telemetry.ToString().Trim().Split('\n').Length);
        }

        static SkeletonRecording ThreeFrames() => Parse(Header + string.Join("\n", Enumerable.Range(0, 3)
            .Select(frame => "{\"frame\": " + frame + ", \"joints\": {\"Head\": [0, 0, 2]}}").ToArray()));

        static long[] Played(SkeletonPlayer player, double seconds)
        {
            var samples = new List<SkeletonSample>();
            player.Advance(seconds, samples);
            return samples.Select(one => one.OriginatingNs).ToArray();
        }

        static SkeletonRecording Parse(string text) => SkeletonRecording.Parse(text, "run");

        static void Refused(string line, string wanted)
        {
            Assert.AreEqual(wanted, Assert.Throws<FormatException>(() => Parse(Header + line)).Message);
        }
    }
}
