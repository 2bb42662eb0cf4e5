namespace AgentServer
{
    /// <summary>
    /// One websocket, for one connection. Messages go out in the order in which they are given.
    /// Nothing here throws for what the network does: a failure is an <see cref="ITransportListener.OnClose"/>.
    /// </summary>
    public interface ITransport
    {
        /// <summary>How many messages wait to be sent.</summary>
        int Waiting { get; }

        /// <summary>Opens it, once. Returns at once; the listener hears what comes of it.</summary>
        /// <param name="url">Where to, for example `ws://127.0.0.1:8765/v1/sessions/lab/renderer`.</param>
        /// <param name="subprotocol">Websocket subprotocol to ask for.</param>
        /// <param name="listener">Hears what happens, on any thread.</param>
        void Open(string url, string subprotocol, ITransportListener listener);

        /// <summary>Sends a text message.</summary>
        void SendText(string text);

        /// <summary>Sends a binary message; the bytes are the transport's from then on.</summary>
        void SendBinary(byte[] data);

        /// <summary>Closes it after what waits was sent; returns at once. More than once does no harm.</summary>
        void Close(int code, string reason);

        /// <summary>
        /// Waits until a close has been said and, where that can be known, answered, for so long at most;
        /// true if it has.
        /// </summary>
        bool WaitClosed(int milliseconds);
    }

    /// <summary>Hears what a transport does, on any thread, one call at a time.</summary>
    public interface ITransportListener
    {
        /// <summary>The socket is open.</summary>
        void OnOpen();

        /// <summary>A text message came.</summary>
        void OnText(string text);

        /// <summary>A binary message came; the bytes are the listener's.</summary>
        void OnBinary(byte[] data);

        /// <summary>The socket ended, or could not be opened; the last call.</summary>
        /// <param name="code">Close code; 1006 where there was none.</param>
        /// <param name="reason">For people; may be empty.</param>
        void OnClose(int code, string reason);
    }

    /// <summary>Makes a transport for each attempt to connect.</summary>
    public interface ITransportFactory
    {
        /// <summary>A new transport.</summary>
        ITransport Create();
    }
}
