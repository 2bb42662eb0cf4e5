using System;
using System.Collections.Generic;
using System.Text;
using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class CodecTests
    {
        readonly Codec _json = Codec.Of(Coding.Json);
        readonly Codec _msgpack = Codec.Of(Coding.MessagePack);

        static byte[] Bytes(string hexadecimal)
        {
            string digits = hexadecimal.Replace(" ", "");
            var bytes = new byte[digits.Length / 2];
            for (int index = 0; index < bytes.Length; index++)
                bytes[index] = Convert.ToByte(digits.Substring(2 * index, 2), 16);
            return bytes;
        }

        static string Hexadecimal(string text)
        {
            return BitConverter.ToString(Encoding.UTF8.GetBytes(text)).Replace("-", "");
        }

        void AssertRefused(string field, string json)
        {
            var wrong = Assert.Throws<ProtocolException>(() => _json.DecodeServer(new Frame(json)));
            Assert.AreEqual(field, wrong.Field, json);
        }

        void AssertRefusedBytes(string field, string hexadecimal)
        {
            var frame = new Frame(Bytes(hexadecimal));
            var wrong = Assert.Throws<ProtocolException>(() => _msgpack.DecodeServer(frame));
            Assert.AreEqual(field, wrong.Field, hexadecimal);
        }

        [Test]
        public void AMessageHasItsTypeFirstAndLeavesDefaultsOut()
        {
            Assert.AreEqual(
                "{\"type\":\"ack\",\"command_id\":\"a\",\"status\":\"done\"}",
                _json.Encode(new AckMessage("a", AckStatus.Done)).Text);
            Assert.AreEqual(
                Bytes("83" + "a4" + Hexadecimal("type") + "a3" + Hexadecimal("ack")
                    + "aa" + Hexadecimal("command_id") + "a161"
                    + "a6" + Hexadecimal("status") + "a4" + Hexadecimal("done")),
                _msgpack.Encode(new AckMessage("a", AckStatus.Done)).Data);
        }

        [Test]
        public void NumbersComeBackAsTheyWere()
        {
            long[] integers = { 0, 127, 128, 255, 256, 65535, 65536, 4294967295, 4294967296, 9007199254740991 };
            foreach (long number in integers)
            {
                Assert.AreEqual(number, ((Ping)_json.DecodeServer(_json.Encode(new Ping(number)))).SentNs);
                Assert.AreEqual(number, ((Ping)_msgpack.DecodeServer(_msgpack.Encode(new Ping(number)))).SentNs);
            }
            double[] numbers = { 0.1, -0.0, 1e-300, 5e-324, 1.0 / 3, 9.999999999999998, 1e-5, 7.0, -2.5 };
            foreach (double number in numbers)
            {
                var affect = new Affect(0, number, 0);
                Assert.AreEqual(number, ((Affect)_json.DecodeClient(_json.Encode(affect))).Valence);
                Assert.AreEqual(number, ((Affect)_msgpack.DecodeClient(_msgpack.Encode(affect))).Valence);
            }
        }

        [Test]
        public void NumbersAreReadToTheNearestDouble()
        {
            var cases = new Dictionary<string, long>
            {
                { "5.242827690134348e-114", 0x2869d27e653cde06 },
                { "1.267551779018793E-142", 0x2278bb2a28d8a1a1 },
                { "2.2250738585072011e-308", 0x000fffffffffffff },
                { "2.2250738585072014e-308", 0x0010000000000000 },
                { "2.4703282292062327e-324", 0 },
                { "2.4703282292062328e-324", 1 },
                { "1e-999999999999", 0 },
                { "0e999999999999", 0 },
                { "1.7976931348623157e308", 0x7fefffffffffffff },
                { "1.7976931348623158e+308", 0x7fefffffffffffff },
                { "9007199254740993", 0x4340000000000000 },
                { "9007199254740993." + new string('0', 2000) + "1", 0x4340000000000001 },
                { "0." + new string('0', 2000) + "1e2001", 0x3ff0000000000000 },
                { "0.1", 0x3fb999999999999a },
                { "1e23", 0x44b52d02c7e14af6 },
            };
            foreach (KeyValuePair<string, long> one in cases)
            {
                var gaze = (Gaze)_json.DecodeClient(new Frame(
                    "{\"type\":\"gaze\",\"originating_ns\":0,\"origin\":[" + one.Key + ",0,0],\"direction\":[0,0,-" + one.Key + "]}"));
                Assert.AreEqual(one.Value, BitConverter.DoubleToInt64Bits(gaze.Origin.X), one.Key);
                Assert.AreEqual(-gaze.Origin.X, gaze.Direction.Z);
            }
            AssertRefused("valence", Affect("1.7976931348623159e308"));
        }

        [Test]
        public void NumbersInJsonAreShort()
        {
            string text = _json.Encode(new Affect(0, 0.1, 3)).Text;
            Assert.IsTrue(text.EndsWith("\"valence\":0.1,\"arousal\":3.0}"), text);
        }

        [Test]
        public void TextsComeBackAsTheyWere()
        {
            foreach (string text in new[] { "\"\\/\b\f\n\r\t\u0001\u001f", "é\u2028\u0000", "\ud83d\ude00", "", "a/b" })
            {
                var message = new ErrorMessage("x", text);
                Assert.AreEqual(text, ((ErrorMessage)_json.DecodeServer(_json.Encode(message))).Message);
                Assert.AreEqual(text, ((ErrorMessage)_msgpack.DecodeServer(_msgpack.Encode(message))).Message);
            }
        }

        [Test]
        public void EscapesOfJsonAreRead()
        {
            var message = (ErrorMessage)_json.DecodeServer(new Frame(
                " { \"type\" :\n\"error\",\t\"code\":\"\\u0078\" , \"message\":\"\\ud83d\\ude00\\/\\u00E9\\n\"}\r\n"));
            Assert.AreEqual("x", message.Code);
            Assert.AreEqual("\ud83d\ude00/é\n", message.Message);
        }

        [Test]
        public void AnIntegerWillDoForAFloat()
        {
            var affect = (Affect)_json.DecodeClient(new Frame(
                "{\"type\":\"affect\",\"originating_ns\":1,\"valence\":-3,\"arousal\":1e0}"));
            Assert.AreEqual(-3, affect.Valence);
            string head = "84 a4" + Hexadecimal("type") + "a6" + Hexadecimal("affect")
                + "ae" + Hexadecimal("originating_ns") + "01 a7" + Hexadecimal("valence");
            string tail = "a7" + Hexadecimal("arousal");
            // float32, and integers of every size and sign.
            foreach (string minusThree in new[] { "ca c0400000", "fd", "d0fd", "d1fffd", "d2fffffffd", "d3fffffffffffffffd" })
            {
                affect = (Affect)_msgpack.DecodeClient(new Frame(Bytes(head + minusThree + tail + "d3 0000000000000002")));
                Assert.AreEqual(-3, affect.Valence);
                Assert.AreEqual(2, affect.Arousal);
            }
        }

        [Test]
        public void AFloatWillNotDoForAnInteger()
        {
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":1.0}");
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":1e3}");
            AssertRefusedBytes("sent_ns", Ping("cb 3ff0000000000000"));
        }

        [Test]
        public void UnknownFieldsArePassedOverAtAnyDepth()
        {
            var scene = (SceneState)_json.DecodeServer(new Frame(
                "{\"new\":[{\"a\":[1,-2.5e3,\"}]\\\"\",null,true,false]},{}],\"type\":\"scene\",\"objects\":{},"
                + "\"mode\":\"working\",\"more\":{\"b\":{}}}"));
            Assert.AreEqual("working", scene.Mode);
            // nil, booleans, every integer and float, texts, bytes, extensions, arrays and maps.
            string unknown = "dc001a c0c2c3 7f e0 ccff cdffff ce00000001 cf0000000000000001 d080 d18000 d280000000"
                + " d38000000000000000 ca00000000 cb0000000000000000 d90161 da000161 db0000000161 c40100 c5000100"
                + " c60000000100 d40100 d8 01 00000000000000000000000000000000 c7020101 02 91 93c0c0c0 81a161c0";
            var ping = (Ping)_msgpack.DecodeServer(new Frame(Bytes(
                "83 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping") + "a3" + Hexadecimal("new") + unknown
                + "a7" + Hexadecimal("sent_ns") + "05")));
            Assert.AreEqual(5, ping.SentNs);
        }

        [Test]
        public void ATypeThatIsNotKnownIsNamed()
        {
            Message message = _json.DecodeServer(new Frame("{\"a\":[[1]],\"type\":\"dance\"}"));
            Assert.IsTrue(message is UnknownMessage);
            Assert.AreEqual("dance", message.Type);
            // A client's message is unknown among the server's.
            Assert.IsTrue(_json.DecodeServer(_json.Encode(new SceneEvent("a", "b"))) is UnknownMessage);
            Assert.Throws<ProtocolException>(() => _json.Encode(message));
        }

        [Test]
        public void TheFieldThatIsWrongIsNamed()
        {
            string step = "{\"action\":\"a\",\"duration_s\":1}";
            string head = "{\"type\":\"command\",\"id\":\"a\",\"sequence\":1,\"epoch\":\"e\",\"reaction\":\"r\",\"cause\":\"c\",";
            string tail = ",\"priority\":1,\"originating_ns\":0,\"issued_ns\":0,\"ttl_ms\":0}";
            _json.DecodeServer(new Frame(head + "\"steps\":[" + step + "]" + tail));
            AssertRefused("steps[1].action", head + "\"steps\":[" + step + ",{\"action\":\"\",\"duration_s\":1}]" + tail);
            AssertRefused("steps[1].duration_s", head + "\"steps\":[" + step + ",{\"action\":\"a\"}]" + tail);
            AssertRefused("steps[0]", head + "\"steps\":[7]" + tail);
            AssertRefused("steps", head + "\"steps\":{}" + tail);
            AssertRefused("steps", head + "\"steps\":null" + tail);
            AssertRefused("steps", head + "\"reaction\":\"r\"" + tail);
            AssertRefused("joints[1]",
                "{\"type\":\"pose\",\"originating_ns\":1,\"body_id\":1,\"joints\":[[0,0,0,1],[0,0,1]]}");
            AssertRefused("joints[0]",
                "{\"type\":\"pose\",\"originating_ns\":1,\"body_id\":1,\"joints\":[[0,0,0,1,2]]}");
            AssertRefused("joints[0][3]",
                "{\"type\":\"pose\",\"originating_ns\":1,\"body_id\":1,\"joints\":[[0,0,0,1.5]]}");
            AssertRefused("objects.window", "{\"type\":\"scene\",\"mode\":\"a\",\"objects\":{\"window\":1}}");
        }

        [Test]
        public void ValuesThatDoNotFitAreRefused()
        {
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":-1}");
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":9007199254740992}");
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":99999999999999999999}");
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":\"1\"}");
            AssertRefused("sent_ns", "{\"type\":\"ping\",\"sent_ns\":true}");
            AssertRefused("code", "{\"type\":\"error\",\"code\":\"" + new string('x', 65) + "\",\"message\":\"\"}");
            AssertRefused("code", "{\"type\":\"error\",\"code\":\"\",\"message\":\"\"}");
            AssertRefused("fatal", "{\"type\":\"error\",\"code\":\"a\",\"message\":\"\",\"fatal\":null}");
            AssertRefused("valence", Affect("11"));
            AssertRefused("valence", Affect("1e999"));
            AssertRefused("type", "{\"sent_ns\":1}");
            AssertRefused("type", "{\"type\":1}");
            AssertRefusedBytes("sent_ns", Ping("cf ffffffffffffffff"));
            AssertRefusedBytes("sent_ns", Ping("ff"));
            AssertRefusedBytes("sent_ns", Ping("c0"));
            AssertRefusedBytes("sent_ns", Ping("c1"));
        }

        [Test]
        public void ALengthIsInCodePoints()
        {
            string wide = new StringBuilder().Insert(0, "\ud83d\ude00", 64).ToString();
            string json = "{\"type\":\"error\",\"code\":\"" + wide + "\",\"message\":\"\"}";
            Assert.AreEqual(wide, ((ErrorMessage)_json.DecodeServer(new Frame(json))).Code);
        }

        [Test]
        public void RangesThatAreOpenLeaveTheirEndOut()
        {
            Assert.Throws<ProtocolException>(() => _json.DecodeClient(
                new Frame("{\"type\":\"calibrate\",\"originating_ns\":0,\"seconds\":0}")));
            var calibrate = (Calibrate)_json.DecodeClient(
                new Frame("{\"type\":\"calibrate\",\"originating_ns\":0,\"seconds\":null,\"valence\":1}"));
            Assert.IsTrue(calibrate.Seconds == null);
            Assert.AreEqual(1, calibrate.Valence);
        }

        [Test]
        public void WhatIsNoJsonIsRefused()
        {
            string[] texts =
            {
                "", " ", "null", "7", "[]", "\"type\"", "{", "{\"type\"", "{\"type\":", "{\"type\":\"ping\"",
                "{\"type\":\"ping\",}", "{\"type\":\"ping\",\"sent_ns\":1,}", "{\"type\":\"ping\",\"sent_ns\":01}",
                "{\"type\":\"ping\",\"sent_ns\":+1}", "{\"type\":\"ping\",\"sent_ns\":1}x", "{\"type\":\"ping\" \"sent_ns\":1}",
                "{\"type\":\"ping\",\"sent_ns\":1}{}", "{'type':'ping'}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":.5}",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":1.}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":1e}",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":tru}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":nul",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\t\"}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\\x\"}",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\\u12\"}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\\ud800\"}",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\\udc00\"}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":\"\ud800\"}",
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":[1 2]}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":[1,]}",
                "{\"type\":\"ping\",\"sent_ns\":1,2:3}", "{\"type\":\"ping\",\"sent_ns\":1}\0", "\0", "{\0}",
                "{\"type\":\"ping\",\"sent_ns\":NaN}", "{\"type\":\"ping\",\"sent_ns\":1,\"a\":-}",
            };
            foreach (string text in texts)
                Assert.Throws<ProtocolException>(() => _json.DecodeServer(new Frame(text)), text);
        }

        [Test]
        public void WhatIsNoMessagePackIsRefused()
        {
            string ping = Ping("05");
            Assert.AreEqual(5, ((Ping)_msgpack.DecodeServer(new Frame(Bytes(ping)))).SentNs);
            for (int length = 0; length < ping.Replace(" ", "").Length / 2; length++)
            {
                var cut = new Frame(Bytes(ping.Replace(" ", "").Substring(0, 2 * length)));
                Assert.Throws<ProtocolException>(() => _msgpack.DecodeServer(cut));
            }
            AssertRefusedBytes("", ping + "00");
            AssertRefusedBytes("", "c0");
            AssertRefusedBytes("", "81 01 01");
            string text = "83 a4" + Hexadecimal("type") + "a5" + Hexadecimal("error") + "a4" + Hexadecimal("code");
            AssertRefusedBytes("code", text + "a2 c328");
            AssertRefusedBytes("code", text + "c4 01 61");
        }

        [Test]
        public void ALengthThatLiesMakesNothing()
        {
            string head = "82 a4" + Hexadecimal("type") + "a4" + Hexadecimal("pose") + "a6" + Hexadecimal("joints");
            AssertRefusedBytes("joints", head + "ddffffffff");
            AssertRefusedBytes("joints", head + "dd00000010 00");
            AssertRefusedBytes("joints", head + "dfffffffff");
            AssertRefusedBytes("a", "82 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping") + "a161 dbffffffff");
            AssertRefusedBytes("a", "82 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping") + "a161 c6ffffffff");
            AssertRefusedBytes("a", "82 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping") + "a161 c9ffffffff");
            AssertRefusedBytes("", "dfffffffff");
        }

        [Test]
        public void NestingHasALimit()
        {
            AssertNesting(63, isRefused: false);
            AssertNesting(64, isRefused: true);
            AssertNesting(200000, isRefused: true);
        }

        void AssertNesting(int depth, bool isRefused)
        {
            var json = new Frame(
                "{\"type\":\"ping\",\"sent_ns\":1,\"a\":" + new string('[', depth) + new string(']', depth) + "}");
            var arrays = new byte[depth];
            for (int index = 0; index < depth; index++) arrays[index] = (byte)(index == depth - 1 ? 0x90 : 0x91);
            var data = new List<byte>(Bytes("83 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping")));
            data.AddRange(Bytes("a7" + Hexadecimal("sent_ns") + "01 a161"));
            data.AddRange(arrays);
            var msgpack = new Frame(data.ToArray());
            if (isRefused)
            {
                Assert.Throws<ProtocolException>(() => _json.DecodeServer(json));
                Assert.Throws<ProtocolException>(() => _msgpack.DecodeServer(msgpack));
                return;
            }
            Assert.AreEqual(1, ((Ping)_json.DecodeServer(json)).SentNs);
            Assert.AreEqual(1, ((Ping)_msgpack.DecodeServer(msgpack)).SentNs);
        }

        [Test]
        public void TheWrongKindOfFrameIsRefused()
        {
            Assert.Throws<ProtocolException>(() => _json.DecodeServer(new Frame(new byte[] { 0x80 })));
            Assert.Throws<ProtocolException>(() => _msgpack.DecodeServer(new Frame("{}")));
            Assert.Throws<ProtocolException>(() => _msgpack.DecodeClient(new Frame("{}")));
        }

        [Test]
        public void AnImageIsBinaryInJson()
        {
            var image = new Image(0x0102030405, new byte[] { 9, 8, 7 });
            byte[] data = _json.Encode(image).Data;
            Assert.AreEqual(Bytes("41464a31 00000000 0504030201000000 090807"), data);
            var read = (Image)_json.DecodeClient(new Frame(data));
            Assert.AreEqual(image.OriginatingNs, read.OriginatingNs);
            Assert.AreEqual(image.Jpeg, read.Jpeg);
            foreach (string wrong in new[] { "", "41464a", "41464a32 00000000 0000000000000000 01",
                "41464a31 00000000 0000000000000000", "41464a31 01000000 0000000000000000 01",
                "41464a31 00000000 0000000000002000 01", "41464a31 00000000 00000000000000ff 01" })
                Assert.Throws<ProtocolException>(() => _json.DecodeClient(new Frame(Bytes(wrong))), wrong);
        }

        [Test]
        public void WhatCannotBeSentIsRefusedByName()
        {
            foreach (Codec codec in new[] { _json, _msgpack })
            {
                Assert.AreEqual("valence", Refusal(codec, new Affect(0, double.NaN, 0)));
                Assert.AreEqual("arousal", Refusal(codec, new Affect(0, 0, double.PositiveInfinity)));
                Assert.AreEqual("reason", Refusal(codec, new AckMessage("a", AckStatus.Failed, reason: "\ud800")));
                Assert.AreEqual("capabilities", Refusal(codec, new Hello("1.0", "c", capabilities: new string[1])));
            }
            Assert.AreEqual("joints", Refusal(_json, new PackedSkeleton(0, 0, "core9", new byte[0])));
            Assert.Throws<ArgumentNullException>(() => new SceneEvent(null, "open"));
        }

        static string Refusal(Codec codec, Message message)
        {
            return Assert.Throws<ProtocolException>(() => codec.Encode(message)).Field;
        }

        [Test]
        public void FormsThatDifferArePacked()
        {
            var skeleton = new Skeleton(1, 2, "core9", new[] { new JointSample(1, 2, 3, 0.5) });
            var packed = (PackedSkeleton)_msgpack.DecodeClient(_msgpack.Encode(skeleton));
            Assert.AreEqual(Bytes("0000803f 00000040 00004040 0000003f"), packed.Joints);
            var face = new FacePoints(1, FaceFormat.Dlib68, 64, 64, new[] { new double[] { 1, 2 } });
            Assert.AreEqual(Bytes("0000803f 00000040"), ((PackedFacePoints)Packed.Of(face)).Points);
            var stream = new PoseStreamMessage(
                "a", 0, 25, new[] { "head" }, new[] { new[] { new Point3(1, 2, 3) } }, isLast: true);
            var packedStream = (PackedPoseStreamMessage)_msgpack.DecodeServer(_msgpack.Encode(stream));
            Assert.AreEqual(Bytes("0000803f 00000040 00004040"), packedStream.Positions);
            Assert.IsTrue(packedStream.IsLast);
            PoseStreamMessage again = Packed.Unpack(packedStream);
            Assert.AreEqual(new Point3(1, 2, 3), again.Positions[0][0]);
            Assert.AreEqual("head", again.Joints[0]);
        }

        [Test]
        public void CodesSayWhenToComeBack()
        {
            Assert.AreEqual(Retry.Never, CloseCodes.RetryAfter(1000));
            Assert.AreEqual(Retry.Soon, CloseCodes.RetryAfter(1001));
            Assert.AreEqual(Retry.Later, CloseCodes.RetryAfter(4429));
            Assert.AreEqual(Retry.Soon, CloseCodes.RetryAfter(4999));
            Assert.AreEqual("silent", CloseCodes.Find(4410).Name);
            Assert.IsTrue(ErrorCodes.Find(ErrorCodes.NotFinite).Advice.Length != 0);
            Assert.IsTrue(ErrorCodes.Find("new") == null);
        }

        static string Affect(string valence)
        {
            return "{\"type\":\"affect_state\",\"originating_ns\":1,\"valence\":" + valence + ",\"arousal\":0}";
        }

        static string Ping(string sent)
        {
            return "82 a4" + Hexadecimal("type") + "a4" + Hexadecimal("ping") + "a7" + Hexadecimal("sent_ns") + sent;
        }
    }
}
