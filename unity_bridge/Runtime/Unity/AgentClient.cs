using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Events;

namespace AgentServer.Unity
{
    /// <summary>
    /// The connection of a scene: it gets the server's commands as a renderer and, if telemetry is switched
    /// on, watches the session as a monitor. All events are raised on the main thread.
    /// </summary>
    /// <remarks>
    /// It connects when it is enabled, says goodbye when it is disabled, paused or quit, and comes back with
    /// the same memory of commands, so that each is carried out once.
    /// </remarks>
    [AddComponentMenu("Agent Server/Agent Client")]
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(-100)]
    public sealed class AgentClient : MonoBehaviour
    {
        /// <summary>How long a process that ends waits until the goodbye is said, in milliseconds.</summary>
        const int GoodbyeMs = 300;

        [Header("Server")]
        [SerializeField, Tooltip("A shared asset; it replaces the fields below.")]
        AgentSettings _settings;

        [SerializeField]
        ServerAddress _server = new ServerAddress();

        [SerializeField, Tooltip("Replace a renderer that is there already.")]
        bool _takeOver;

        [SerializeField, Tooltip("Get commands without carrying them out: another renderer acts.")]
        bool _mirror;

        [SerializeField, Tooltip("Get motions that are made while they play, for a Generated Motion.")]
        bool _playsMotion;

        [Header("Telemetry")]
        [SerializeField, Tooltip("Watch poses, forecasts and decisions over a second connection.")]
        bool _telemetry;

        [SerializeField, Tooltip("Kinds of telemetry that are wanted.")]
        Topic[] _topics = { Topic.Pose, Topic.Forecast, Topic.Decision };

        [Header("Events")]
        [SerializeField]
        UnityEvent<CommandMessage> _onCommand = new UnityEvent<CommandMessage>();

        [SerializeField]
        UnityEvent<CommandMessage> _onCancelled = new UnityEvent<CommandMessage>();

        [SerializeField]
        UnityEvent<DecisionMessage> _onDecision = new UnityEvent<DecisionMessage>();

        [SerializeField]
        UnityEvent<SceneState> _onScene = new UnityEvent<SceneState>();

        [SerializeField]
        UnityEvent<Phase> _onPhase = new UnityEvent<Phase>();

        readonly PlatformTransports _platform = new PlatformTransports();
        ITransportFactory _transports;
        IClock _clock;
        bool _isPaused;

        /// <summary>A command is to be carried out: call <see cref="RendererClient.Start"/> first.</summary>
        public event Action<CommandMessage> CommandReceived;

        /// <summary>A command is cut short, for a reason: stop at once, and say nothing.</summary>
        public event Action<CommandMessage, string> CommandCancelled;

        /// <summary>More of the motion of the command that is under way.</summary>
        public event Action<PoseStreamMessage> MotionReceived;

        /// <summary>The room, after each welcome and whenever it changes.</summary>
        public event Action<SceneState> SceneChanged;

        /// <summary>On what scene and server did not agree.</summary>
        public event Action<IReadOnlyList<Difference>> Reconciled;

        /// <summary>Where the renderer's connection stands.</summary>
        public event Action<Phase> PhaseChanged;

        /// <summary>Telemetry: the nine core joints.</summary>
        public event Action<PoseMessage> PoseReceived;

        /// <summary>Telemetry: the motion that is expected.</summary>
        public event Action<ForecastMessage> ForecastReceived;

        /// <summary>Telemetry: a decision, with what led to it.</summary>
        public event Action<DecisionMessage> DecisionReceived;

        /// <summary>The renderer; null before the first enabling, or if a setting is wrong.</summary>
        public RendererClient Renderer { get; private set; }

        /// <summary>The monitor; null unless telemetry is switched on.</summary>
        public MonitorClient Monitor { get; private set; }

        /// <summary>Gives the state of each object for the hello; set by a <see cref="Room"/>.</summary>
        public Func<IDictionary<string, string>> Objects { get; set; }

        /// <summary>Where the server is; change it, then call <see cref="Connect"/>.</summary>
        public ServerAddress Server => _settings == null ? _server : _settings.Server;

        /// <summary>Whether poses, forecasts and decisions are wanted; it holds from the next Connect.</summary>
        public bool Telemetry
        {
            get => _telemetry;
            set => _telemetry = value;
        }

        /// <summary>Whether to replace a renderer that is there already; it holds from the next Connect.</summary>
        public bool TakeOver
        {
            get => _takeOver;
            set => _takeOver = value;
        }

        /// <summary>Whether motions that are made while they play are wanted; from the next Connect on.</summary>
        public bool PlaysMotion
        {
            get => _playsMotion;
            set => _playsMotion = value;
        }

        /// <summary>Where the renderer's connection stands.</summary>
        public Phase Phase => Renderer == null ? Phase.Stopped : Renderer.Connection.Phase;

        /// <summary>For a command.</summary>
        public UnityEvent<CommandMessage> OnCommand => _onCommand;

        /// <summary>For a command that is cut short.</summary>
        public UnityEvent<CommandMessage> OnCancelled => _onCancelled;

        /// <summary>For a decision; needs telemetry.</summary>
        public UnityEvent<DecisionMessage> OnDecision => _onDecision;

        /// <summary>For the room.</summary>
        public UnityEvent<SceneState> OnScene => _onScene;

        /// <summary>For the phase of the connection.</summary>
        public UnityEvent<Phase> OnPhase => _onPhase;

        /// <summary>Other sockets and another clock than the platform's; for tests, before it is enabled.</summary>
        public void Use(ITransportFactory transports, IClock clock)
        {
            _transports = transports;
            _clock = clock;
        }

        /// <summary>Connects anew with the present settings. What is remembered of commands is forgotten.</summary>
        public void Connect()
        {
            Disconnect(0);
            Renderer = null;
            Monitor = null;
            if (isActiveAndEnabled) Begin();
        }

        /// <summary>Tells the server that somebody changed an object by hand.</summary>
        /// <returns>Whether it is sent now; if not, the next hello tells of it.</returns>
        public bool ReportObject(string objectName, string state) =>
            Renderer != null && Renderer.ReportObject(objectName, state);

        void OnEnable()
        {
            if (!_isPaused) Begin();
        }

        void OnDisable() => Disconnect(0);

        void Update()
        {
            _platform.Pump();
            if (Renderer != null) Renderer.Poll();
            if (Monitor != null) Monitor.Poll();
        }

        // A paused program answers no pings. The server had better know.
        void OnApplicationPause(bool isPaused)
        {
            // Unity also says at the start that nothing is paused.
            if (isPaused == _isPaused) return;
            _isPaused = isPaused;
            if (isPaused) Disconnect(GoodbyeMs);
            else if (isActiveAndEnabled) Begin();
        }

        void OnApplicationQuit() => Disconnect(GoodbyeMs);

        void Begin()
        {
            try
            {
                if (Renderer == null) Renderer = MakeRenderer();
                if (Monitor == null && _telemetry) Monitor = MakeMonitor();
            }
            catch (ArgumentException wrong)
            {
                Debug.LogError("The client '" + name + "' does not connect. " + wrong.Message + ".", this);
                return;
            }
            Renderer.Connection.Start();
            if (Monitor != null) Monitor.Connection.Start();
        }

        void Disconnect(int waitMs)
        {
            if (Renderer != null) Renderer.Connection.Stop(waitMs);
            if (Monitor != null) Monitor.Connection.Stop(waitMs);
        }

        RendererClient MakeRenderer()
        {
            ConnectionSettings settings = Server.For(Role.Renderer);
            settings.TakeOver = _takeOver;
            settings.Mirror = _mirror;
            settings.PlaysMotion = _playsMotion;
            var made = new RendererClient(settings, _transports ?? _platform.Factory, _clock)
            {
                Objects = () => Objects == null ? null : Objects(),
            };
            made.CommandReceived += command =>
            {
                CommandReceived?.Invoke(command);
                _onCommand.Invoke(command);
            };
            made.CommandCancelled += (command, reason) =>
            {
                CommandCancelled?.Invoke(command, reason);
                _onCancelled.Invoke(command);
            };
            made.MotionReceived += stretch => MotionReceived?.Invoke(stretch);
            made.SceneChanged += scene =>
            {
                SceneChanged?.Invoke(scene);
                _onScene.Invoke(scene);
            };
            made.Reconciled += differences => Reconciled?.Invoke(differences);
            made.Connection.PhaseChanged += phase =>
            {
                PhaseChanged?.Invoke(phase);
                _onPhase.Invoke(phase);
            };
            made.Connection.Received += Warn;
            new ConnectionLog(made.Connection, "renderer", this);
            return made;
        }

        MonitorClient MakeMonitor()
        {
            ConnectionSettings settings = Server.For(Role.Monitor);
            settings.Topics = _topics;
            var made = new MonitorClient(settings, _transports ?? _platform.Factory, _clock);
            made.PoseReceived += pose => PoseReceived?.Invoke(pose);
            made.ForecastReceived += forecast => ForecastReceived?.Invoke(forecast);
            made.DecisionReceived += decision =>
            {
                DecisionReceived?.Invoke(decision);
                _onDecision.Invoke(decision);
            };
            new ConnectionLog(made.Connection, "monitor", this);
            return made;
        }

        void Warn(Message message)
        {
            var error = message as ErrorMessage;
            if (error != null && !error.Fatal)
                Debug.LogWarning("The server refused a message (" + error.Code + "): " + error.Message, this);
        }
    }
}
