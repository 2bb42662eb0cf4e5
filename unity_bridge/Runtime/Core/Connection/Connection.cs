using System;

namespace AgentServer
{
    /// <summary>
    /// A connection that comes back by itself. It has no thread of its own: <see cref="Poll"/>, called
    /// regularly on the application's thread, handles what has come, runs the timers and raises all
    /// events. Everything but <see cref="Arrived"/> belongs to that thread.
    /// </summary>
    public sealed class Connection
    {
        /// <summary>How long a socket may take to open, and a server to say welcome.</summary>
        public const long AnswerTimeoutNs = 10000000000;

        const double SilentHeartbeats = 2.5;
        const int ProtocolError = 1002;

        readonly ConnectionSettings _settings;
        readonly string _url;
        readonly ITransportFactory _transports;
        readonly IClock _clock;
        readonly Backoff _backoff;
        readonly Codec _codec;
        readonly HelloSource _hello;
        readonly Inbox _inbox = new Inbox();
        readonly ClockEstimate _estimate = new ClockEstimate();

        ITransport _transport;
        volatile Listener _listener;
        string _refusal;
        long _phaseSinceNs;
        long _nextAttemptNs;
        long _nextPingNs;
        long _lastHeardNs;
        long _heartbeatNs;

        /// <summary>Makes a connection; it does nothing before <see cref="Start"/>.</summary>
        /// <param name="settings">Where to connect, and as what; later changes have no effect.</param>
        /// <param name="transports">Makes the sockets; null for `System.Net.WebSockets`.</param>
        /// <param name="clock">Monotonic clock; null for the machine's.</param>
        /// <param name="random">Chance of the waiting times; null for the machine's.</param>
        /// <exception cref="ArgumentException">If a setting is wrong.</exception>
        public Connection(
            ConnectionSettings settings,
            ITransportFactory transports = null,
            IClock clock = null,
            IRandom random = null)
        {
            settings.Validate();
            _settings = settings.Copy();
            _url = _settings.Url;
            _transports = transports ?? new ClientWebSocketTransportFactory();
            _clock = clock ?? new SystemClock();
            _backoff = new Backoff(random ?? new SystemRandom());
            _codec = Codec.Of(_settings.Coding);
            _hello = new HelloSource(_settings);
        }

        /// <summary>The phase is another one; also raised when the connection has given up.</summary>
        public event Action<Phase> PhaseChanged;

        /// <summary>The server has said welcome; the connection is live.</summary>
        public event Action<Welcome> Welcomed;

        /// <summary>A message came; pings, pongs, welcomes and unknown ones aside.</summary>
        public event Action<Message> Received;

        /// <summary>The server's clock, or the own one, has jumped.</summary>
        public event Action ClockJumped;

        /// <summary>A message of the server cannot be read, for this reason; it is passed over.</summary>
        public event Action<string> Unreadable;

        /// <summary>Something waits for <see cref="Poll"/>; raised on any thread.</summary>
        public event Action Arrived;

        /// <summary>Where the connection stands.</summary>
        public Phase Phase { get; private set; }

        /// <summary>Why there is no connection, in words for people; null while all is well.</summary>
        public string Fault { get; private set; }

        /// <summary>The last welcome; null before the first.</summary>
        public Welcome Welcome { get; private set; }

        /// <summary>Round trip of a ping in milliseconds; null before the first pong.</summary>
        public double? RoundTripMs => _estimate.RoundTripNs / 1e6;

        /// <summary>The server's clock less the own one, in nanoseconds; null before the first pong.</summary>
        public long? ClockOffsetNs => _estimate.OffsetNs;

        /// <summary>Time until the next attempt in milliseconds; null when none is waited for.</summary>
        public double? NextAttemptInMs =>
            Phase == Phase.Waiting ? Math.Max(0, _nextAttemptNs - _clock.NowNs) / 1e6 : (double?)null;

        /// <summary>Own clock when the message came that is being handled, in nanoseconds.</summary>
        public long ReceivedNs { get; private set; }

        /// <summary>Telemetry that was dropped because <see cref="Poll"/> was called too rarely.</summary>
        public long DroppedTelemetry => _inbox.Dropped;

        /// <summary>Messages of the server that could not be read and were passed over.</summary>
        public long UnreadableMessages { get; private set; }

        /// <summary>How many messages wait to be sent.</summary>
        public int Waiting => _transport == null ? 0 : _transport.Waiting;

        /// <summary>What a renderer adds to each hello; null for other roles.</summary>
        public Func<ResumeState> Resume { get; set; }

        /// <summary>The clock that it goes by.</summary>
        public IClock Clock => _clock;

        /// <summary>Connects, and stays connected; nothing if it does so already.</summary>
        public void Start()
        {
            if (Phase != Phase.Stopped) return;
            long now = _clock.NowNs;
            Fault = null;
            _backoff.Begin(now);
            Open(now);
        }

        /// <summary>Says goodbye and stays away.</summary>
        /// <param name="waitMs">
        /// How long to wait, at most, until the goodbye is said and answered: for a process that ends now.
        /// </param>
        public void Stop(int waitMs = 0)
        {
            ITransport transport = _transport;
            Drop(CloseCodes.Normal, "goodbye");
            if (waitMs > 0 && transport != null) transport.WaitClosed(waitMs);
            Fault = null;
            Enter(Phase.Stopped, _clock.NowNs);
        }

        /// <summary>Tries at once instead of waiting on; nothing in other phases.</summary>
        public void RetryNow()
        {
            if (Phase == Phase.Waiting) Open(_clock.NowNs);
        }

        /// <summary>Sends a message; false, and it is not sent, when the connection is not live.</summary>
        /// <exception cref="ProtocolException">If it has no form on the wire.</exception>
        public bool Send(Message message)
        {
            if (Phase != Phase.Live) return false;
            Write(message);
            return true;
        }

        /// <summary>
        /// Handles what has come since the last call and runs the timers. What an event's handler throws
        /// comes out here; the next call goes on behind it.
        /// </summary>
        public void Poll()
        {
            Heard heard;
            long end = _inbox.NextOrder;
            while (_inbox.Take(end, out heard))
                if (heard.From == _listener) Handle(heard);
            if (_inbox.HasOverflowed) Lose("the application let too much of what came wait", CloseCodes.TooSlow);
            RunTimers(_clock.NowNs);
        }

        void Handle(Heard heard)
        {
            ReceivedNs = heard.AtNs;
            _lastHeardNs = heard.AtNs;
            switch (heard.Kind)
            {
                case HeardKind.Opened:
                    Write(_hello.Make(Welcome, Resume));
                    Enter(Phase.Greeting, heard.AtNs);
                    break;
                case HeardKind.Message:
                    Handle(heard.Message, heard.AtNs);
                    break;
                case HeardKind.Unreadable:
                    UnreadableMessages++;
                    Unreadable?.Invoke(heard.Words);
                    if (Phase == Phase.Greeting) Lose("the server's answer cannot be read: " + heard.Words, ProtocolError);
                    break;
                case HeardKind.Closed:
                    Ended(heard.Code, heard.Words);
                    break;
            }
        }

        void Handle(Message message, long atNs)
        {
            if (message is Ping ping)
            {
                Write(new Pong(ping.SentNs, _clock.NowNs));
                return;
            }
            if (message is Pong pong)
            {
                if (_estimate.Add(pong.SentNs, pong.TimeNs, atNs)) ClockJumped?.Invoke();
                return;
            }
            if (message is UnknownMessage) return;
            if (message is ErrorMessage error && error.Fatal) _refusal = error.Message;
            if (message is Welcome welcome)
            {
                if (Phase == Phase.Greeting) Greeted(welcome, atNs);
                return;
            }
            if (Phase == Phase.Live || message is ErrorMessage) Received?.Invoke(message);
        }

        void Greeted(Welcome welcome, long atNs)
        {
            if (welcome.Protocol.Split('.')[0] != ProtocolVersion.Protocol.Split('.')[0])
            {
                Drop(CloseCodes.WrongVersion, "");
                End(
                    CloseCodes.RetryAfter(CloseCodes.WrongVersion),
                    "the server speaks protocol " + welcome.Protocol + ", this client " + ProtocolVersion.Protocol);
                return;
            }
            Welcome = welcome;
            Fault = null;
            // A heartbeat below or above would be a mistake of the server's.
            _heartbeatNs = (long)(Math.Min(3600, Math.Max(0.1, welcome.HeartbeatS)) * 1e9);
            _nextPingNs = atNs;
            _estimate.Reset();
            Enter(Phase.Live, atNs);
            if (Phase == Phase.Live) Welcomed?.Invoke(welcome);
        }

        void RunTimers(long now)
        {
            switch (Phase)
            {
                case Phase.Opening:
                case Phase.Greeting:
                    if (now - _phaseSinceNs >= AnswerTimeoutNs)
                        Lose("no answer from " + _url + " within 10 seconds", CloseCodes.HelloTimeout);
                    break;
                case Phase.Live:
                    RunHeartbeat(now);
                    break;
                case Phase.Waiting:
                    if (now >= _nextAttemptNs) Open(now);
                    break;
            }
        }

        void RunHeartbeat(long now)
        {
            if (now - _lastHeardNs >= SilentHeartbeats * _heartbeatNs)
            {
                Lose("the server is silent", CloseCodes.Silent);
                return;
            }
            if (now < _nextPingNs) return;
            _nextPingNs = now + _heartbeatNs;
            Write(new Ping(now));
        }

        void Open(long now)
        {
            var listener = new Listener(_settings.Coding, _clock, Hear);
            ITransport transport = _transports.Create();
            _refusal = null;
            _listener = listener;
            _transport = transport;
            Enter(Phase.Opening, now);
            // Whoever heard of the phase may have stopped the connection.
            if (_transport == transport) transport.Open(_url, _codec.Subprotocol, listener);
        }

        /// <summary>The socket has ended by itself.</summary>
        void Ended(int code, string reason)
        {
            CloseCode known = CloseCodes.Find(code);
            string why = known != null ? known.Meaning + " (" + code + ")" : reason.Length != 0 ? reason : "close code " + code;
            string fault = Phase == Phase.Opening ? "cannot connect to " + _url + ": " + why : "the connection ended: " + why;
            Drop(CloseCodes.Normal, "");
            End(CloseCodes.RetryAfter(code), _refusal ?? fault);
        }

        /// <summary>The socket is given up; no goodbye, so that the server keeps this client's place.</summary>
        void Lose(string fault, int code)
        {
            Drop(code, fault);
            End(Retry.Soon, fault);
        }

        void End(Retry retry, string fault)
        {
            long now = _clock.NowNs;
            Fault = fault;
            if (Phase == Phase.Live) _backoff.Begin(now);
            if (retry == Retry.Never)
            {
                Enter(Phase.Stopped, now);
                return;
            }
            _nextAttemptNs = now + (retry == Retry.Later ? Backoff.LongestNs : _backoff.NextNs(now));
            Enter(Phase.Waiting, now);
        }

        void Drop(int code, string reason)
        {
            _listener = null;
            if (_transport != null) _transport.Close(code, reason);
            _transport = null;
            _inbox.Clear();
        }

        void Enter(Phase phase, long now)
        {
            if (phase == Phase) return;
            Phase = phase;
            _phaseSinceNs = now;
            PhaseChanged?.Invoke(phase);
        }

        void Write(Message message)
        {
            Frame frame = _codec.Encode(message);
            if (frame.Text != null) _transport.SendText(frame.Text);
            else _transport.SendBinary(frame.Data);
        }

        /// <summary>Takes what a socket says; the one that was dropped is not even listened to.</summary>
        void Hear(Heard heard)
        {
            if (heard.From != _listener) return;
            _inbox.Add(heard);
            Arrived?.Invoke();
        }
    }
}
