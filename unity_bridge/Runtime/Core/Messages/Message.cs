namespace AgentServer
{
    /// <summary>Base of all messages. They do not change once made.</summary>
    public abstract class Message
    {
        /// <summary>Value of `type` on the wire.</summary>
        public abstract string Type { get; }

        internal abstract void Write(WireWriter writer);
    }

    /// <summary>A message of a type that this version does not know; a client passes it over.</summary>
    public sealed class UnknownMessage : Message
    {
        internal UnknownMessage(string type)
        {
            Type = type;
        }

        /// <inheritdoc/>
        public override string Type { get; }

        internal override void Write(WireWriter writer)
        {
            throw new ProtocolException("type", "a message of unknown type cannot be sent");
        }
    }
}
