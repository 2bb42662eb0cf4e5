using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>What a renderer adds to its hello: what it knows from before, and what it shows.</summary>
    public sealed class ResumeState
    {
        /// <summary>Makes one.</summary>
        public ResumeState(string ledger, long? lastSequence, IReadOnlyDictionary<string, string> objects)
        {
            Ledger = ledger;
            LastSequence = lastSequence;
            Objects = objects;
        }

        /// <summary>The present ledger; null before the first welcome.</summary>
        public string Ledger { get; }

        /// <summary>Highest sequence that was received; null before the first welcome.</summary>
        public long? LastSequence { get; }

        /// <summary>State of each object as it is shown; null if nothing is told.</summary>
        public IReadOnlyDictionary<string, string> Objects { get; }
    }
}
