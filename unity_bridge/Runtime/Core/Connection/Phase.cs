namespace AgentServer
{
    /// <summary>Where a connection stands.</summary>
    public enum Phase
    {
        /// <summary>Not wanted, or given up: somebody has to start it.</summary>
        Stopped,

        /// <summary>A socket is being opened.</summary>
        Opening,

        /// <summary>Hello is sent, and not answered yet.</summary>
        Greeting,

        /// <summary>The server has said welcome.</summary>
        Live,

        /// <summary>An attempt or a connection has ended; the next attempt follows.</summary>
        Waiting,
    }
}
