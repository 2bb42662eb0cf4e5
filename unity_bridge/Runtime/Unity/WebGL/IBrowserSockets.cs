namespace AgentServer.Unity
{
    /// <summary>What happened to a socket of the browser.</summary>
    public enum BrowserEvent
    {
        /// <summary>Nothing that was not read.</summary>
        None,

        /// <summary>It is open.</summary>
        Open,

        /// <summary>A text came; its bytes are UTF-8.</summary>
        Text,

        /// <summary>A binary message came.</summary>
        Binary,

        /// <summary>It has ended; its bytes are the reason in UTF-8.</summary>
        Close,
    }

    /// <summary>The browser's websockets, by number; asked, never calling back.</summary>
    public interface IBrowserSockets
    {
        /// <summary>Opens a socket and gives it a number.</summary>
        int Open(string url, string subprotocol);

        /// <summary>What happened first of what was not taken yet.</summary>
        BrowserEvent Next(int id);

        /// <summary>Bytes of that event.</summary>
        int Size(int id);

        /// <summary>Close code of that event.</summary>
        int Code(int id);

        /// <summary>Copies that event's bytes and forgets the event.</summary>
        /// <param name="id">Number of the socket.</param>
        /// <param name="buffer">Of the event's size.</param>
        void Take(int id, byte[] buffer);

        /// <summary>Sends a message.</summary>
        void Send(int id, byte[] data, int length, bool isText);

        /// <summary>Bytes that were sent and have not left.</summary>
        int Waiting(int id);

        /// <summary>Closes a socket; the close comes as an event.</summary>
        void Close(int id, int code, string reason);

        /// <summary>Forgets a socket.</summary>
        void Free(int id);
    }
}
