namespace AgentServer
{
    /// <summary>When a client whose connection was closed connects again by itself.</summary>
    public enum Retry
    {
        /// <summary>After a random time below a bound that doubles.</summary>
        Soon,

        /// <summary>After 15 seconds: the same would happen again at once.</summary>
        Later,

        /// <summary>Not by itself; somebody has to decide.</summary>
        Never,
    }

    /// <summary>Why a server closes a connection.</summary>
    public sealed class CloseCode
    {
        internal CloseCode(int code, string name, string meaning, string advice, Retry retry)
        {
            Code = code;
            Name = name;
            Meaning = meaning;
            Advice = advice;
            Retry = retry;
        }

        /// <summary>The websocket's close code.</summary>
        public int Code { get; }

        /// <summary>For programs.</summary>
        public string Name { get; }

        /// <summary>For people.</summary>
        public string Meaning { get; }

        /// <summary>What to do.</summary>
        public string Advice { get; }

        /// <summary>When a client connects again by itself.</summary>
        public Retry Retry { get; }
    }

    /// <summary>A mistake that an error message names.</summary>
    public sealed class ErrorCode
    {
        internal ErrorCode(string code, string meaning, string advice)
        {
            Code = code;
            Meaning = meaning;
            Advice = advice;
        }

        /// <summary>Its name.</summary>
        public string Code { get; }

        /// <summary>For people.</summary>
        public string Meaning { get; }

        /// <summary>What to do.</summary>
        public string Advice { get; }
    }
}
