using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>
    /// A socket without a network: the other end is played by whoever holds it. For tests, and for an
    /// application that runs without a server.
    /// </summary>
    public sealed class MockTransport : ITransport
    {
        readonly List<Message> _heard = new List<Message>();
        ITransportListener _listener;
        Codec _codec;

        /// <inheritdoc/>
        public int Waiting { get; set; }

        /// <summary>Address that was asked for; null before it is opened.</summary>
        public string Url { get; private set; }

        /// <summary>Messages that the client has sent, in order.</summary>
        public IReadOnlyList<Message> Heard => _heard;

        /// <summary>Code with which the client closed it; null while it has not.</summary>
        public int? ClosedWith { get; private set; }

        /// <inheritdoc/>
        public void Open(string url, string subprotocol, ITransportListener listener)
        {
            Url = url;
            _listener = listener;
            _codec = Codec.Of(subprotocol == ProtocolVersion.JsonSubprotocol ? Coding.Json : Coding.MessagePack);
        }

        /// <inheritdoc/>
        public void SendText(string text)
        {
            _heard.Add(_codec.DecodeClient(new Frame(text)));
        }

        /// <inheritdoc/>
        public void SendBinary(byte[] data)
        {
            _heard.Add(_codec.DecodeClient(new Frame(data)));
        }

        /// <inheritdoc/>
        public void Close(int code, string reason)
        {
            if (ClosedWith == null) ClosedWith = code;
        }

        /// <inheritdoc/>
        public bool WaitClosed(int milliseconds) => ClosedWith != null;

        /// <summary>The socket is open.</summary>
        public void Accept()
        {
            _listener.OnOpen();
        }

        /// <summary>The server says something.</summary>
        public void Say(Message message)
        {
            Say(_codec.Encode(message));
        }

        /// <summary>The server says something that need not be a message.</summary>
        public void Say(Frame frame)
        {
            if (frame.Text != null) _listener.OnText(frame.Text);
            else _listener.OnBinary(frame.Data);
        }

        /// <summary>The socket ends.</summary>
        public void End(int code, string reason = "")
        {
            _listener.OnClose(code, reason);
        }
    }

    /// <summary>Makes <see cref="MockTransport"/>s and keeps them.</summary>
    public sealed class MockTransportFactory : ITransportFactory
    {
        readonly List<MockTransport> _made = new List<MockTransport>();

        /// <summary>All that were made, in order.</summary>
        public IReadOnlyList<MockTransport> Made => _made;

        /// <summary>The last one; null before the first.</summary>
        public MockTransport Last => _made.Count == 0 ? null : _made[_made.Count - 1];

        /// <inheritdoc/>
        public ITransport Create()
        {
            _made.Add(new MockTransport());
            return Last;
        }
    }
}
