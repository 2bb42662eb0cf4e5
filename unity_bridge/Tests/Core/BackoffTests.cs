using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class BackoffTests
    {
        const long Second = 1000000000;

        FixedRandom _random;
        Backoff _backoff;

        [SetUp]
        public void SetUp()
        {
            _random = new FixedRandom { Unit = 1 };
            _backoff = new Backoff(_random);
            _backoff.Begin(0);
        }

        [Test]
        public void TheBoundDoublesUpToOneAndAHalfSeconds()
        {
            double[] bounds = { 0.25, 0.5, 1, 1.5, 1.5 };
            foreach (double bound in bounds) Assert.AreEqual((long)(bound * Second), _backoff.NextNs(Second));
        }

        [Test]
        public void AfterTwentySecondsItDoublesOnToFifteen()
        {
            for (int attempt = 0; attempt < 6; attempt++) _backoff.NextNs(19 * Second);
            double[] bounds = { 1.5, 3, 6, 12, 15, 15 };
            foreach (double bound in bounds) Assert.AreEqual((long)(bound * Second), _backoff.NextNs(20 * Second));
        }

        [Test]
        public void TheWaitIsAShareOfTheBound()
        {
            _random.Unit = 0;
            Assert.AreEqual(0, _backoff.NextNs(0));
            _random.Unit = 0.5;
            Assert.AreEqual(Second / 4, _backoff.NextNs(0));
        }

        [Test]
        public void ANewOutageBeginsAtTheFirstBound()
        {
            for (int attempt = 0; attempt < 9; attempt++) _backoff.NextNs(30 * Second);
            _backoff.Begin(40 * Second);
            Assert.AreEqual(Second / 4, _backoff.NextNs(40 * Second));
        }
    }
}
