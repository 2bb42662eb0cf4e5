using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>What a listener heard, and when.</summary>
    readonly struct Heard
    {
        public Heard(object from, HeardKind kind, long atNs, Message message = null, int code = 0, string words = "")
        {
            From = from;
            Kind = kind;
            AtNs = atNs;
            Message = message;
            Code = code;
            Words = words;
        }

        /// <summary>The listener.</summary>
        public object From { get; }

        public HeardKind Kind { get; }

        /// <summary>Own clock when it came.</summary>
        public long AtNs { get; }

        public Message Message { get; }

        /// <summary>Close code.</summary>
        public int Code { get; }

        /// <summary>Reason of a close, or why a message cannot be read.</summary>
        public string Words { get; }
    }

    enum HeardKind
    {
        Opened,
        Message,
        Unreadable,
        Closed,
    }

    /// <summary>
    /// What came and was not handled yet, in order; filled on any thread. Of telemetry the oldest is
    /// dropped when too much waits. Of the rest nothing is dropped: when too much waits, the inbox
    /// overflows and takes no more, and the connection cannot go on.
    /// </summary>
    sealed class Inbox
    {
        /// <summary>So much telemetry may wait.</summary>
        public const int TelemetryLimit = 256;

        /// <summary>So much else may wait.</summary>
        public const int Limit = 4096;

        readonly object _lock = new object();
        readonly Queue<Entry> _kept = new Queue<Entry>();
        readonly Queue<Entry> _telemetry = new Queue<Entry>();
        long _nextOrder;
        long _dropped;
        bool _hasOverflowed;

        /// <summary>Telemetry that was dropped since the start.</summary>
        public long Dropped
        {
            get
            {
                lock (_lock) return _dropped;
            }
        }

        /// <summary>Order of the next entry; entries below it have come already.</summary>
        public long NextOrder
        {
            get
            {
                lock (_lock) return _nextOrder;
            }
        }

        /// <summary>Whether something was not taken since it was cleared.</summary>
        public bool HasOverflowed
        {
            get
            {
                lock (_lock) return _hasOverflowed;
            }
        }

        /// <summary>Forgets what waits.</summary>
        public void Clear()
        {
            lock (_lock)
            {
                _kept.Clear();
                _telemetry.Clear();
                _hasOverflowed = false;
            }
        }

        public void Add(Heard heard)
        {
            lock (_lock)
            {
                var entry = new Entry(_nextOrder++, heard);
                if (!IsTelemetry(heard.Message))
                {
                    if (_kept.Count == Limit) _hasOverflowed = true;
                    if (!_hasOverflowed) _kept.Enqueue(entry);
                    return;
                }
                if (_telemetry.Count == TelemetryLimit)
                {
                    _telemetry.Dequeue();
                    _dropped++;
                }
                _telemetry.Enqueue(entry);
            }
        }

        /// <summary>Takes the oldest entry of those below an order; false if there is none.</summary>
        public bool Take(long belowOrder, out Heard heard)
        {
            lock (_lock)
            {
                Queue<Entry> queue = Older();
                if (queue.Count == 0 || queue.Peek().Order >= belowOrder)
                {
                    heard = default(Heard);
                    return false;
                }
                heard = queue.Dequeue().Heard;
                return true;
            }
        }

        Queue<Entry> Older()
        {
            if (_telemetry.Count == 0) return _kept;
            if (_kept.Count == 0) return _telemetry;
            return _kept.Peek().Order < _telemetry.Peek().Order ? _kept : _telemetry;
        }

        static bool IsTelemetry(Message message)
        {
            return message is PoseMessage || message is ForecastMessage || message is AffectTelemetry
                || message is AckTelemetry || message is DecisionMessage || message is StatsMessage
                || message is Missed;
        }

        readonly struct Entry
        {
            public Entry(long order, Heard heard)
            {
                Order = order;
                Heard = heard;
            }

            public long Order { get; }

            public Heard Heard { get; }
        }
    }
}
