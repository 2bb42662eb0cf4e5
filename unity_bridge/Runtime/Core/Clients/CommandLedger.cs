using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>What came of a command that the server sent.</summary>
    public sealed class LedgerAnswer
    {
        internal LedgerAnswer(IReadOnlyList<AckMessage> words, CommandMessage cancelled, CommandMessage command)
        {
            Words = words;
            Cancelled = cancelled;
            Command = command;
        }

        /// <summary>What to say to the server, in order.</summary>
        public IReadOnlyList<AckMessage> Words { get; }

        /// <summary>The command that was cut short; null if none was.</summary>
        public CommandMessage Cancelled { get; }

        /// <summary>The command that the application is to carry out; null if there is none.</summary>
        public CommandMessage Command { get; }
    }

    /// <summary>
    /// Remembers what became of each command, so that each takes effect once whatever happens to the
    /// connection. It holds no clock and sends nothing: it says what to say.
    /// </summary>
    public sealed class CommandLedger
    {
        /// <summary>So many commands that are over are remembered.</summary>
        public const int Memory = 256;

        /// <summary>Reason of a command that came, or was started, too late.</summary>
        public const string Expired = "expired";

        /// <summary>Reason of a command whose place a newer one took.</summary>
        public const string Preempted = "preempted";

        /// <summary>Why a command is cancelled whose ledger is no more.</summary>
        public const string Forgotten = "forgotten";

        const int ReasonLimit = 500;
        const long NsPerMs = 1000000;

        readonly Dictionary<string, Entry> _entries = new Dictionary<string, Entry>();
        readonly Queue<string> _over = new Queue<string>();
        Entry _open;
        Entry _owed;

        /// <summary>The present ledger; null before the first welcome.</summary>
        public string Ledger { get; private set; }

        /// <summary>Highest sequence that was received in this ledger; 0 before the first command.</summary>
        public long LastSequence { get; private set; }

        /// <summary>The command that is not over; null if there is none.</summary>
        public CommandMessage Running => _open?.Command;

        /// <summary>The last word on a command; null for one that is not known.</summary>
        public AckMessage LastWord(string id)
        {
            Entry entry;
            return _entries.TryGetValue(id, out entry) ? entry.Word : null;
        }

        /// <summary>Takes the ledger of a welcome; another one than before means to forget everything.</summary>
        /// <returns>The command that is cut short by that, without a word; null if none is.</returns>
        public CommandMessage Enter(string ledger)
        {
            if (ledger == Ledger) return null;
            CommandMessage cancelled = Running;
            Ledger = ledger;
            LastSequence = 0;
            _open = null;
            _owed = null;
            _entries.Clear();
            _over.Clear();
            return cancelled;
        }

        /// <summary>Takes a command that has come.</summary>
        /// <param name="command">The command.</param>
        /// <param name="nowNs">Own clock when it came.</param>
        public LedgerAnswer Receive(CommandMessage command, long nowNs)
        {
            Entry known;
            if (_entries.TryGetValue(command.Id, out known))
                return new LedgerAnswer(new[] { known.Word }, null, null);
            bool isOld = command.Sequence < LastSequence;
            LastSequence = Math.Max(LastSequence, command.Sequence);
            if (command.AgeMs >= command.TtlMs) return Refuse(command, Expired);
            if (isOld) return Refuse(command, Preempted);
            var words = new List<AckMessage>();
            CommandMessage cancelled = Running;
            if (cancelled != null) words.Add(Close(_open, AckStatus.Failed, Preempted));
            _open = new Entry(command, nowNs + (command.TtlMs - command.AgeMs) * NsPerMs);
            _entries.Add(command.Id, _open);
            words.Add(_open.Word);
            return new LedgerAnswer(words, cancelled, command);
        }

        /// <summary>The application wants to start a command.</summary>
        /// <param name="id">The command.</param>
        /// <param name="nowNs">Own clock.</param>
        /// <param name="word">What to say to the server; null for nothing.</param>
        /// <returns>Whether it may; if not, or if it has already, it is to do nothing.</returns>
        public bool Start(string id, long nowNs, out AckMessage word)
        {
            word = null;
            if (!IsOpen(id) || IsStarted()) return false;
            bool isInTime = nowNs <= _open.DeadlineNs;
            word = isInTime ? Say(_open, AckStatus.Started) : Close(_open, AckStatus.Failed, Expired);
            return isInTime;
        }

        /// <summary>The application has ended a step.</summary>
        /// <returns>Whether the command was started and goes on; if not, nothing is said.</returns>
        public bool Progress(string id, int step, out AckMessage word)
        {
            bool isRunning = IsOpen(id) && IsStarted();
            word = isRunning ? Say(_open, AckStatus.Progress, step) : null;
            return isRunning;
        }

        /// <summary>The application has carried a command out.</summary>
        /// <returns>Whether it was started and not over; if not, nothing is said.</returns>
        public bool Done(string id, out AckMessage word)
        {
            bool isRunning = IsOpen(id) && IsStarted();
            word = isRunning ? Close(_open, AckStatus.Done, null) : null;
            return isRunning;
        }

        /// <summary>The application cannot carry a command out.</summary>
        /// <param name="id">The command.</param>
        /// <param name="reason">Why, for people; what is longer than 500 characters is cut.</param>
        /// <param name="word">What to say to the server; null for nothing.</param>
        /// <returns>Whether it was open; if not, nothing is said.</returns>
        public bool Fail(string id, string reason, out AckMessage word)
        {
            bool isOpen = IsOpen(id);
            word = isOpen ? Close(_open, AckStatus.Failed, Cut(reason)) : null;
            return isOpen;
        }

        /// <summary>The connection is lost: the last word on what is not over now is to be said again.</summary>
        public void Lose()
        {
            if (_open != null) _owed = _open;
        }

        /// <summary>The connection is live again.</summary>
        /// <returns>The last word on the command that was not over when it was lost; null for nothing.</returns>
        public AckMessage Regain()
        {
            AckMessage word = _owed?.Word;
            _owed = null;
            return word;
        }

        bool IsStarted() => _open.Word.Status != AckStatus.Accepted;

        bool IsOpen(string id) => _open != null && _open.Command.Id == id;

        LedgerAnswer Refuse(CommandMessage command, string reason)
        {
            var entry = new Entry(command, 0);
            _entries.Add(command.Id, entry);
            return new LedgerAnswer(new[] { Close(entry, AckStatus.Failed, reason) }, null, null);
        }

        static AckMessage Say(Entry entry, AckStatus status, int? step = null, string reason = null)
        {
            entry.Word = new AckMessage(entry.Command.Id, status, step, reason);
            return entry.Word;
        }

        AckMessage Close(Entry entry, AckStatus status, string reason)
        {
            AckMessage word = Say(entry, status, reason: reason);
            if (entry == _open) _open = null;
            entry.Command = null;
            _over.Enqueue(word.CommandId);
            if (_over.Count > Memory) _entries.Remove(_over.Dequeue());
            return word;
        }

        static string Cut(string reason)
        {
            if (reason == null || reason.Length <= ReasonLimit) return reason;
            int length = char.IsHighSurrogate(reason[ReasonLimit - 1]) ? ReasonLimit - 1 : ReasonLimit;
            return reason.Substring(0, length);
        }

        sealed class Entry
        {
            public Entry(CommandMessage command, long deadlineNs)
            {
                Command = command;
                DeadlineNs = deadlineNs;
                Word = new AckMessage(command.Id, AckStatus.Accepted);
            }

            /// <summary>What was asked; null once it is over.</summary>
            public CommandMessage Command { get; set; }

            /// <summary>Own clock up to which it may be started.</summary>
            public long DeadlineNs { get; }

            /// <summary>The last word on it.</summary>
            public AckMessage Word { get; set; }
        }
    }
}
