using System.Collections.Generic;
using System.Text;

namespace AgentServer.Unity
{
    /// <summary>
    /// Makes transports over the browser's websockets, where a build has no sockets of its own.
    /// </summary>
    public sealed class WebGLTransportFactory : ITransportFactory
    {
        readonly IBrowserSockets _sockets;
        readonly List<WebGLTransport> _open = new List<WebGLTransport>();

        /// <param name="sockets">The browser's.</param>
        public WebGLTransportFactory(IBrowserSockets sockets)
        {
            _sockets = sockets;
        }

        /// <inheritdoc/>
        public ITransport Create()
        {
            var made = new WebGLTransport(_sockets);
            _open.Add(made);
            return made;
        }

        /// <summary>Tells the listeners what has happened since the last call; once a frame.</summary>
        public void Pump()
        {
            // A listener may make another transport; it is heard in the next frame.
            for (int i = _open.Count - 1; i >= 0; i--)
            {
                if (_open[i].Pump()) _open.RemoveAt(i);
            }
        }
    }

    /// <summary>One websocket of the browser.</summary>
    public sealed class WebGLTransport : ITransport
    {
        readonly IBrowserSockets _sockets;
        readonly Queue<long> _ends = new Queue<long>();
        ITransportListener _listener;
        long _sentBytes;
        int _id;
        bool _isClosing;
        bool _isOver;

        internal WebGLTransport(IBrowserSockets sockets)
        {
            _sockets = sockets;
        }

        /// <inheritdoc/>
        public int Waiting
        {
            get
            {
                if (_id == 0 || _isOver) return 0;
                ForgetSent();
                return _ends.Count;
            }
        }

        /// <inheritdoc/>
        public void Open(string url, string subprotocol, ITransportListener listener)
        {
            _listener = listener;
            _id = _sockets.Open(url, subprotocol);
        }

        /// <inheritdoc/>
        public void SendText(string text) => Send(Encoding.UTF8.GetBytes(text), true);

        /// <inheritdoc/>
        public void SendBinary(byte[] data) => Send(data, false);

        /// <inheritdoc/>
        public void Close(int code, string reason)
        {
            if (_isClosing || _isOver || _id == 0) return;
            _isClosing = true;
            _sockets.Close(_id, code, reason);
        }

        /// <summary>A page cannot wait. The browser says the close by itself once it was asked to.</summary>
        public bool WaitClosed(int milliseconds) => _isClosing || _isOver;

        /// <summary>Tells what has happened; true after the end.</summary>
        internal bool Pump()
        {
            while (_id != 0 && !_isOver)
            {
                BrowserEvent what = _sockets.Next(_id);
                if (what == BrowserEvent.None) return false;
                var bytes = new byte[_sockets.Size(_id)];
                int code = _sockets.Code(_id);
                _sockets.Take(_id, bytes);
                Tell(what, bytes, code);
            }
            return _isOver;
        }

        void Tell(BrowserEvent what, byte[] bytes, int code)
        {
            switch (what)
            {
                case BrowserEvent.Open:
                    _listener.OnOpen();
                    break;
                case BrowserEvent.Text:
                    _listener.OnText(Encoding.UTF8.GetString(bytes));
                    break;
                case BrowserEvent.Binary:
                    _listener.OnBinary(bytes);
                    break;
                case BrowserEvent.Close:
                    _isOver = true;
                    _sockets.Free(_id);
                    _listener.OnClose(code, Encoding.UTF8.GetString(bytes));
                    break;
            }
        }

        void Send(byte[] data, bool isText)
        {
            if (_isOver || _isClosing || _id == 0) return;
            ForgetSent();
            _sentBytes += data.Length;
            _ends.Enqueue(_sentBytes);
            _sockets.Send(_id, data, data.Length, isText);
        }

        void ForgetSent()
        {
            long left = _sentBytes - _sockets.Waiting(_id);
            while (_ends.Count > 0 && _ends.Peek() <= left) _ends.Dequeue();
        }
    }
}
