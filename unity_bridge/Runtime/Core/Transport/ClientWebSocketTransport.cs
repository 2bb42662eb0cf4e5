using System;
using System.Collections.Generic;
using System.IO;
using System.Net.WebSockets;
using System.Text;
using System.Threading;
using System.Threading.Tasks;

namespace AgentServer
{
    /// <summary>A websocket of `System.Net.WebSockets`, read and written on the thread pool.</summary>
    public sealed class ClientWebSocketTransport : ITransport
    {
        /// <summary>A longer message ends the connection, in bytes.</summary>
        public const int MessageLimit = 16 * 1024 * 1024;

        const int NoCode = 1006;
        const int TooLarge = 1009;
        const int BadText = 1007;
        const int GoodbyeMs = 1000;

        static readonly UTF8Encoding Utf8 = new UTF8Encoding(false, true);

        readonly ClientWebSocket _socket = new ClientWebSocket();
        readonly CancellationTokenSource _cancel = new CancellationTokenSource();
        readonly ManualResetEventSlim _ended = new ManualResetEventSlim();
        readonly object _lock = new object();
        readonly Queue<Frame> _queue = new Queue<Frame>();
        ITransportListener _listener;
        Task _sending = Task.CompletedTask;
        bool _isSending;
        int _closeCode;
        string _closeReason;

        /// <inheritdoc/>
        public int Waiting
        {
            get
            {
                lock (_lock) return _queue.Count;
            }
        }

        /// <inheritdoc/>
        public void Open(string url, string subprotocol, ITransportListener listener)
        {
            _listener = listener;
            _socket.Options.AddSubProtocol(subprotocol);
            // The protocol has a heartbeat of its own.
            _socket.Options.KeepAliveInterval = TimeSpan.Zero;
            Task.Run(() => Run(url));
        }

        /// <inheritdoc/>
        public void SendText(string text)
        {
            Enqueue(new Frame(text));
        }

        /// <inheritdoc/>
        public void SendBinary(byte[] data)
        {
            Enqueue(new Frame(data));
        }

        /// <inheritdoc/>
        public void Close(int code, string reason)
        {
            lock (_lock)
            {
                if (_closeCode != 0) return;
                _closeCode = code;
                _closeReason = reason;
                if (!_isSending) BeginSending();
            }
            new Thread(EndInTime) { IsBackground = true }.Start();
        }

        /// <inheritdoc/>
        public bool WaitClosed(int milliseconds) => _ended.Wait(milliseconds);

        /// <summary>
        /// Gives up waiting for an answer to the goodbye. A thread, not a timer: a process that ends
        /// while the runtime puts a timer in its place is aborted on Mono.
        /// </summary>
        void EndInTime()
        {
            if (!_ended.Wait(GoodbyeMs)) _cancel.Cancel();
        }

        async Task Run(string url)
        {
            int code = NoCode;
            string reason = "";
            try
            {
                await _socket.ConnectAsync(new Uri(url), _cancel.Token).ConfigureAwait(false);
                _listener.OnOpen();
                await Read().ConfigureAwait(false);
                if (_socket.CloseStatus != null) code = (int)_socket.CloseStatus.Value;
                reason = _socket.CloseStatusDescription ?? "";
            }
            catch (Exception failure)
            {
                // Sockets fail in many types; all of them mean that this connection is over.
                reason = Innermost(failure).Message;
            }
            _listener.OnClose(code, reason);
            await Finish().ConfigureAwait(false);
        }

        /// <summary>Lets an answer to the server's close go out, and frees the socket.</summary>
        async Task Finish()
        {
            Task sending;
            if (_socket.State != WebSocketState.CloseReceived) _cancel.Cancel();
            lock (_lock) sending = _sending;
            await sending.ConfigureAwait(false);
            _socket.Dispose();
            _ended.Set();
        }

        async Task Read()
        {
            var buffer = new ArraySegment<byte>(new byte[16 * 1024]);
            var message = new MemoryStream();
            while (true)
            {
                WebSocketReceiveResult part = await _socket.ReceiveAsync(buffer, _cancel.Token).ConfigureAwait(false);
                if (part.MessageType == WebSocketMessageType.Close)
                {
                    Close(CloseCodes.Normal, "");
                    return;
                }
                if (message.Length + part.Count > MessageLimit)
                {
                    Close(TooLarge, "a message is too long");
                    throw new InvalidDataException("a message of the server is longer than " + MessageLimit + " bytes");
                }
                message.Write(buffer.Array, 0, part.Count);
                if (!part.EndOfMessage) continue;
                Deliver(part.MessageType, message);
                message.SetLength(0);
            }
        }

        void Deliver(WebSocketMessageType type, MemoryStream message)
        {
            if (type == WebSocketMessageType.Binary)
            {
                _listener.OnBinary(message.ToArray());
                return;
            }
            string text;
            try
            {
                text = Utf8.GetString(message.GetBuffer(), 0, (int)message.Length);
            }
            catch (DecoderFallbackException)
            {
                Close(BadText, "a text is not UTF-8");
                throw;
            }
            _listener.OnText(text);
        }

        void Enqueue(Frame frame)
        {
            lock (_lock)
            {
                if (_closeCode != 0) return;
                _queue.Enqueue(frame);
                if (!_isSending) BeginSending();
            }
        }

        void BeginSending()
        {
            _isSending = true;
            _sending = Task.Run(SendAll);
        }

        /// <summary>Sends what waits, one after the other, and then the goodbye if there is one.</summary>
        async Task SendAll()
        {
            Frame frame;
            bool isGoodbye;
            try
            {
                while (Next(out frame, out isGoodbye)) await Send(frame).ConfigureAwait(false);
                if (!isGoodbye) return;
                var status = (WebSocketCloseStatus)_closeCode;
                await _socket.CloseOutputAsync(status, _closeReason, _cancel.Token).ConfigureAwait(false);
            }
            catch (Exception)
            {
                // The reading side ends by this, and says so.
                _cancel.Cancel();
            }
        }

        bool Next(out Frame frame, out bool isGoodbye)
        {
            lock (_lock)
            {
                bool isAny = _queue.Count != 0;
                frame = isAny ? _queue.Dequeue() : default(Frame);
                isGoodbye = !isAny && _closeCode != 0;
                _isSending = isAny || isGoodbye;
                return isAny;
            }
        }

        Task Send(Frame frame)
        {
            bool isText = frame.Text != null;
            var data = new ArraySegment<byte>(isText ? Utf8.GetBytes(frame.Text) : frame.Data);
            var type = isText ? WebSocketMessageType.Text : WebSocketMessageType.Binary;
            return _socket.SendAsync(data, type, true, _cancel.Token);
        }

        static Exception Innermost(Exception failure)
        {
            while (failure.InnerException != null) failure = failure.InnerException;
            return failure;
        }
    }

    /// <summary>Makes <see cref="ClientWebSocketTransport"/>s.</summary>
    public sealed class ClientWebSocketTransportFactory : ITransportFactory
    {
        /// <inheritdoc/>
        public ITransport Create() => new ClientWebSocketTransport();
    }
}
