using NUnit.Framework;

namespace AgentServer.Tests
{
    /// <summary>Row by row what docs/clients.md says of the ledger.</summary>
    [TestFixture]
    public class CommandLedgerTests
    {
        const long Ms = 1000000;

        CommandLedger _ledger;
        AckMessage _word;

        [SetUp]
        public void SetUp()
        {
            _ledger = new CommandLedger();
            _ledger.Enter("l1");
            _word = null;
        }

        static void AssertWord(AckMessage word, string id, AckStatus status, string reason = null, int? step = null)
        {
            Assert.AreEqual(id, word.CommandId);
            Assert.AreEqual(status, word.Status);
            Assert.AreEqual(reason, word.Reason);
            Assert.AreEqual(step, word.Step);
        }

        LedgerAnswer Receive(string id, long sequence, long ttlMs = 5000, long ageMs = 0, long nowNs = 0)
        {
            return _ledger.Receive(Make.Command(id, sequence, ttlMs, ageMs), nowNs);
        }

        [Test]
        public void AnotherLedgerForgetsEverythingWithoutAWord()
        {
            Receive("a", 7);
            CommandMessage cancelled = _ledger.Enter("l2");
            Assert.AreEqual("a", cancelled.Id);
            Assert.IsTrue(_ledger.LastWord("a") == null);
            Assert.AreEqual(0, _ledger.LastSequence);
            Assert.IsTrue(_ledger.Running == null);
            Assert.IsTrue(_ledger.Regain() == null);
            Assert.AreEqual("a", Receive("a", 1).Command.Id);
        }

        [Test]
        public void AnotherLedgerCancelsNothingWhenNothingRuns()
        {
            Receive("a", 1);
            _ledger.Start("a", 0, out _word);
            _ledger.Done("a", out _word);
            Assert.IsTrue(_ledger.Enter("l2") == null);
        }

        [Test]
        public void TheSameLedgerKeepsEverything()
        {
            Receive("a", 7);
            Assert.IsTrue(_ledger.Enter("l1") == null);
            Assert.AreEqual("a", _ledger.Running.Id);
            Assert.AreEqual(7, _ledger.LastSequence);
        }

        [Test]
        public void AKnownCommandIsAnsweredWithItsLastWord()
        {
            Receive("a", 1);
            _ledger.Start("a", 0, out _word);
            _ledger.Progress("a", 3, out _word);
            LedgerAnswer again = Receive("a", 1, ageMs: 9000);
            Assert.AreEqual(1, again.Words.Count);
            AssertWord(again.Words[0], "a", AckStatus.Progress, step: 3);
            Assert.IsTrue(again.Command == null && again.Cancelled == null);
            _ledger.Fail("a", "the door is locked", out _word);
            AssertWord(Receive("a", 1).Words[0], "a", AckStatus.Failed, "the door is locked");
        }

        [Test]
        public void ANewCommandThatIsTooOldHasExpired()
        {
            LedgerAnswer answer = Receive("a", 1, ttlMs: 5000, ageMs: 5000);
            Assert.AreEqual(1, answer.Words.Count);
            AssertWord(answer.Words[0], "a", AckStatus.Failed, "expired");
            Assert.IsTrue(answer.Command == null);
            AssertWord(Receive("a", 1).Words[0], "a", AckStatus.Failed, "expired");
        }

        [Test]
        public void AnExpiredCommandDoesNotDisturbTheRunningOne()
        {
            Receive("a", 1);
            Assert.IsTrue(Receive("b", 2, ttlMs: 10, ageMs: 10).Cancelled == null);
            Assert.AreEqual("a", _ledger.Running.Id);
        }

        [Test]
        public void ACommandBelowAKnownSequenceIsPreempted()
        {
            Receive("b", 2);
            LedgerAnswer answer = Receive("a", 1);
            Assert.AreEqual(1, answer.Words.Count);
            AssertWord(answer.Words[0], "a", AckStatus.Failed, "preempted");
            Assert.IsTrue(answer.Command == null && answer.Cancelled == null);
            Assert.AreEqual("b", _ledger.Running.Id);
            Assert.AreEqual(2, _ledger.LastSequence);
        }

        [Test]
        public void ANewCommandCutsTheRunningOneShort()
        {
            Receive("a", 1);
            LedgerAnswer answer = Receive("b", 2);
            Assert.AreEqual(2, answer.Words.Count);
            AssertWord(answer.Words[0], "a", AckStatus.Failed, "preempted");
            AssertWord(answer.Words[1], "b", AckStatus.Accepted);
            Assert.AreEqual("a", answer.Cancelled.Id);
            Assert.AreEqual("b", answer.Command.Id);
        }

        [Test]
        public void ANewCommandIsAccepted()
        {
            LedgerAnswer answer = Receive("a", 1);
            Assert.AreEqual(1, answer.Words.Count);
            AssertWord(answer.Words[0], "a", AckStatus.Accepted);
            Assert.AreEqual("a", answer.Command.Id);
            Assert.IsTrue(answer.Cancelled == null);
        }

        [Test]
        public void ACommandMayBeStartedUpToItsTime()
        {
            Receive("a", 1, ttlMs: 5000, ageMs: 1000, nowNs: 100 * Ms);
            Assert.IsTrue(_ledger.Start("a", 4100 * Ms, out _word));
            AssertWord(_word, "a", AckStatus.Started);
            Assert.IsTrue(!_ledger.Start("a", 9999 * Ms, out _word) && _word == null);
        }

        [Test]
        public void ACommandMayNotBeStartedLater()
        {
            Receive("a", 1, ttlMs: 5000, ageMs: 1000, nowNs: 100 * Ms);
            Assert.IsTrue(!_ledger.Start("a", 4100 * Ms + 1, out _word));
            AssertWord(_word, "a", AckStatus.Failed, "expired");
            Assert.IsTrue(!_ledger.Start("a", 0, out _word));
            Assert.IsTrue(_word == null);
        }

        [Test]
        public void StepsAndTheEndAreSaid()
        {
            Receive("a", 1);
            _ledger.Start("a", 0, out _word);
            Assert.IsTrue(_ledger.Progress("a", 0, out _word));
            AssertWord(_word, "a", AckStatus.Progress, step: 0);
            Assert.IsTrue(_ledger.Done("a", out _word));
            AssertWord(_word, "a", AckStatus.Done);
            Assert.IsTrue(_ledger.Running == null);
        }

        [Test]
        public void AFailureIsSaidWithItsReasonCutToLength()
        {
            Receive("a", 1);
            Assert.IsTrue(_ledger.Fail("a", new string('x', 499) + "\ud83d\ude00", out _word));
            AssertWord(_word, "a", AckStatus.Failed, new string('x', 499));
        }

        [Test]
        public void NothingIsSaidOfStepsAndTheEndOfACommandThatWasNotStarted()
        {
            Receive("a", 1);
            Assert.IsTrue(!_ledger.Progress("a", 0, out _word) && _word == null);
            Assert.IsTrue(!_ledger.Done("a", out _word) && _word == null);
            Assert.IsTrue(_ledger.Fail("a", "cannot", out _word));
        }

        [Test]
        public void NothingIsSaidOfACommandThatIsOver()
        {
            Receive("a", 1);
            _ledger.Start("a", 0, out _word);
            _ledger.Done("a", out _word);
            Assert.IsTrue(!_ledger.Start("a", 0, out _word) && _word == null);
            Assert.IsTrue(!_ledger.Progress("a", 1, out _word) && _word == null);
            Assert.IsTrue(!_ledger.Done("a", out _word) && _word == null);
            Assert.IsTrue(!_ledger.Fail("a", "late", out _word) && _word == null);
            Assert.IsTrue(!_ledger.Done("unknown", out _word) && _word == null);
        }

        [Test]
        public void WhatWasNotOverIsSaidOnceWhenTheConnectionIsBack()
        {
            Receive("a", 1);
            _ledger.Lose();
            _ledger.Start("a", 0, out _word);
            AssertWord(_ledger.Regain(), "a", AckStatus.Started);
            Assert.IsTrue(_ledger.Regain() == null);
        }

        [Test]
        public void WhatEndedMeanwhileIsSaidAfterSeveralAttemptsToo()
        {
            Receive("a", 1);
            _ledger.Lose();
            _ledger.Start("a", 0, out _word);
            _ledger.Progress("a", 0, out _word);
            _ledger.Done("a", out _word);
            _ledger.Lose();
            AssertWord(_ledger.Regain(), "a", AckStatus.Done);
        }

        [Test]
        public void WhatWasOverBeforeIsNotSaid()
        {
            Receive("a", 1);
            _ledger.Start("a", 0, out _word);
            _ledger.Done("a", out _word);
            _ledger.Lose();
            Assert.IsTrue(_ledger.Regain() == null);
        }

        [Test]
        public void TheLast256CommandsThatAreOverAreRemembered()
        {
            for (int index = 0; index < 257; index++)
            {
                Receive("c" + index, index + 1);
                _ledger.Start("c" + index, 0, out _word);
                _ledger.Done("c" + index, out _word);
            }
            Assert.IsTrue(_ledger.LastWord("c0") == null);
            AssertWord(_ledger.LastWord("c1"), "c1", AckStatus.Done);
            // One that was forgotten is older than what is known, and is not carried out again.
            AssertWord(Receive("c0", 1).Words[0], "c0", AckStatus.Failed, "preempted");
        }
    }
}
