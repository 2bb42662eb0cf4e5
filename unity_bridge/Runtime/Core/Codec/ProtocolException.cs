using System;

namespace AgentServer
{
    /// <summary>Something that is not a message of the protocol; the text says where and why.</summary>
    public sealed class ProtocolException : Exception
    {
        /// <summary>Makes one.</summary>
        /// <param name="field">Path of the field, for example `joints[3][1]`; empty for the whole.</param>
        /// <param name="sentence">What was expected and what was got.</param>
        public ProtocolException(string field, string sentence)
            : base(field.Length == 0 ? sentence : field + ": " + sentence)
        {
            Field = field;
        }

        /// <summary>Path of the field; empty for the message as a whole.</summary>
        public string Field { get; }
    }
}
