using System;
using System.Collections.Generic;
using NUnit.Framework;

namespace AgentServer.Tests
{
    /// <summary>Whatever comes, it is a message or a <see cref="ProtocolException"/>.</summary>
    [TestFixture]
    public class FuzzTests
    {
        const int Mutations = 20000;

        static readonly Message[] Messages =
        {
            Make.Welcome(differences: new[] { new Difference("window", "closed", "open", Authority.Server) }),
            Make.Command("lab/c1", 1),
            Make.Scene(),
            new Pong(123456789, 9007199254740991),
            new PoseMessage(40000000, 3, new[] { new JointSample(0.25, -1.5, 2, 1), new JointSample(0, 0, 0, 0) }),
            new ForecastMessage(1, 40000000, "ma_wgan", new[] { new[] { new Point3(1, 2, 3), new Point3(4, 5, 6) } }),
            new ErrorMessage("not_finite", "joints[3][1] ist \u00fc\ud83d\ude00", "joints[3][1]", true),
            new StatsMessage(1, 2, 3, 4, 5, 6, 7, 8, new Dictionary<string, long> { { "faces", 300 } },
                new[] { new ClientStats(Role.Sensor, "kinect", 1.5, null, 0) }),
        };

        [Test]
        public void MutatedTextIsAMessageOrRefused()
        {
            var random = new Random(1);
            Codec codec = Codec.Of(Coding.Json);
            const string Likely = "{}[]\",:\\u0123456789.eE+-tfn \0\ud800\udc00\u00fc";
            int readable = 0;
            for (int round = 0; round < Mutations; round++)
            {
                var text = new List<char>(codec.Encode(Messages[random.Next(Messages.Length)]).Text);
                for (int change = random.Next(4); change >= 0; change--)
                    Mutate(text, random, () => Likely[random.Next(Likely.Length)]);
                if (IsRead(codec, new Frame(new string(text.ToArray())))) readable++;
            }
            AssertPlausible(readable);
        }

        [Test]
        public void MutatedBytesAreAMessageOrRefused()
        {
            var random = new Random(2);
            Codec codec = Codec.Of(Coding.MessagePack);
            int readable = 0;
            for (int round = 0; round < Mutations; round++)
            {
                var data = new List<byte>(codec.Encode(Messages[random.Next(Messages.Length)]).Data);
                for (int change = random.Next(4); change >= 0; change--)
                    Mutate(data, random, () => (byte)random.Next(256));
                if (IsRead(codec, new Frame(data.ToArray()))) readable++;
            }
            AssertPlausible(readable);
        }

        /// <summary>Some mutations do no harm and most do; else nothing was tested.</summary>
        static void AssertPlausible(int readable)
        {
            Assert.IsTrue(readable > Mutations / 100, readable + " were read");
            Assert.IsTrue(readable < Mutations * 9 / 10, readable + " were read");
        }

        static bool IsRead(Codec codec, Frame frame)
        {
            try
            {
                return codec.DecodeServer(frame) != null;
            }
            catch (ProtocolException)
            {
                return false;
            }
        }

        static void Mutate<T>(List<T> units, Random random, Func<T> next)
        {
            int at = random.Next(units.Count);
            switch (random.Next(5))
            {
                case 0:
                    units.Insert(at, next());
                    break;
                case 1:
                    units.RemoveRange(at, Math.Min(units.Count - at, 1 + random.Next(8)));
                    break;
                case 2:
                    units.InsertRange(at, units.GetRange(0, Math.Min(at, 40)));
                    break;
                case 3:
                    units.RemoveRange(at, units.Count - at);
                    units.Add(next());
                    break;
                default:
                    units[at] = next();
                    break;
            }
            if (units.Count == 0) units.Add(next());
        }
    }
}
