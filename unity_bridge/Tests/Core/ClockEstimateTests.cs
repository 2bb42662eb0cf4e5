using NUnit.Framework;

namespace AgentServer.Tests
{
    [TestFixture]
    public class ClockEstimateTests
    {
        const long Ms = 1000000;

        long _now;
        ClockEstimate _estimate;

        [SetUp]
        public void SetUp()
        {
            _now = 1000 * Ms;
            _estimate = new ClockEstimate();
        }

        /// <summary>A pong after a round trip, whose way there took its share of it.</summary>
        bool Pong(long offset, long roundTrip, double share = 0.5)
        {
            long sent = _now;
            _now += roundTrip;
            long time = sent + (long)(roundTrip * share) + offset;
            bool hasJumped = _estimate.Add(sent, time, _now);
            _now += 1000 * Ms;
            return hasJumped;
        }

        [Test]
        public void TheFirstSampleIsTakenAsItIs()
        {
            Assert.IsTrue(_estimate.OffsetNs == null);
            Pong(70 * Ms, 10 * Ms);
            Assert.AreEqual(70 * Ms, _estimate.OffsetNs);
            Assert.AreEqual(10 * Ms, _estimate.RoundTripNs);
        }

        [Test]
        public void TheSmallestRoundTripCounts()
        {
            Pong(0, 2 * Ms);
            Pong(0, 40 * Ms, share: 0.9);
            Assert.AreEqual(0, _estimate.OffsetNs);
            Assert.AreEqual(2 * Ms, _estimate.RoundTripNs);
        }

        [Test]
        public void TheEstimateFollowsByAQuarter()
        {
            Pong(0, 10 * Ms);
            Pong(4 * Ms, 8 * Ms);
            Assert.AreEqual(1 * Ms, _estimate.OffsetNs);
            Pong(4 * Ms, 9 * Ms);
            Assert.AreEqual(1750000, _estimate.OffsetNs);
        }

        [Test]
        public void TheEstimateDoesNotStayWhereTheBestSampleRulesItOut()
        {
            Pong(0, 10 * Ms);
            Pong(8 * Ms, 4 * Ms);
            Assert.AreEqual(6 * Ms, _estimate.OffsetNs);
        }

        [Test]
        public void AFirstPongThatWasSlowOnOneWayIsNoJump()
        {
            Assert.IsTrue(!Pong(0, 600 * Ms, share: 1));
            for (int sample = 0; sample < 10; sample++)
            {
                Assert.IsTrue(!Pong(0, 2 * Ms));
                Assert.IsTrue(System.Math.Abs(_estimate.OffsetNs.Value) <= Ms);
            }
        }

        [Test]
        public void SamplesOlderThanTheLastEightAreForgotten()
        {
            Pong(0, 1 * Ms);
            for (int sample = 0; sample < 7; sample++) Pong(0, 10 * Ms);
            Assert.AreEqual(1 * Ms, _estimate.RoundTripNs);
            Pong(0, 10 * Ms);
            Assert.AreEqual(10 * Ms, _estimate.RoundTripNs);
        }

        [Test]
        public void ThreeSamplesFarToOneSideAreAJump()
        {
            Pong(0, 2 * Ms);
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.AreEqual(0, _estimate.OffsetNs);
            Assert.IsTrue(Pong(901 * Ms, 4 * Ms));
            Assert.AreEqual(901 * Ms, _estimate.OffsetNs);
            Assert.AreEqual(4 * Ms, _estimate.RoundTripNs);
        }

        [Test]
        public void SamplesToBothSidesOrInBetweenAreNone()
        {
            Pong(0, 2 * Ms);
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(-900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.IsTrue(!Pong(0, 2 * Ms));
            Assert.IsTrue(!Pong(900 * Ms, 2 * Ms));
            Assert.AreEqual(0, _estimate.OffsetNs);
        }

        [Test]
        public void AToleranceOfFiftyMillisecondsAndHalfOfBothRoundTripsHolds()
        {
            Pong(0, 2 * Ms);
            for (int sample = 0; sample < 5; sample++) Assert.IsTrue(!Pong(52 * Ms, 2 * Ms));
            _estimate.Reset();
            Pong(0, 2 * Ms);
            Pong(52 * Ms + 1, 2 * Ms);
            Pong(52 * Ms + 1, 2 * Ms);
            Assert.IsTrue(Pong(52 * Ms + 1, 2 * Ms));
        }

        [Test]
        public void APongFromBeforeItsPingIsPassedOver()
        {
            Assert.IsTrue(!_estimate.Add(10, 5, 9));
            Assert.IsTrue(_estimate.OffsetNs == null);
        }
    }
}
