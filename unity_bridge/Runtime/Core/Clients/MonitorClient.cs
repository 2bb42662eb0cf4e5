using System;

namespace AgentServer
{
    /// <summary>
    /// Watches a session. Telemetry may be lost; all events are raised by <see cref="Poll"/>, in order.
    /// </summary>
    public sealed class MonitorClient
    {
        /// <summary>Makes a monitor; it does nothing before `Connection.Start()`.</summary>
        /// <param name="settings">Where to connect; the role must be monitor.</param>
        /// <param name="transports">Makes the sockets; null for `System.Net.WebSockets`.</param>
        /// <param name="clock">Monotonic clock; null for the machine's.</param>
        /// <param name="random">Chance of the waiting times; null for the machine's.</param>
        /// <exception cref="ArgumentException">If a setting is wrong.</exception>
        public MonitorClient(
            ConnectionSettings settings,
            ITransportFactory transports = null,
            IClock clock = null,
            IRandom random = null)
        {
            Roles.Require(settings, Role.Monitor);
            Connection = new Connection(settings, transports, clock, random);
            Connection.Welcomed += welcome => SceneChanged?.Invoke(welcome.Scene);
            Connection.Received += OnMessage;
        }

        /// <summary>The nine core joints, at 25 Hz.</summary>
        public event Action<PoseMessage> PoseReceived;

        /// <summary>The motion that is expected after a window.</summary>
        public event Action<ForecastMessage> ForecastReceived;

        /// <summary>The affect that the gate goes by.</summary>
        public event Action<AffectTelemetry> AffectReceived;

        /// <summary>What the neutral face is held to be.</summary>
        public event Action<CalibrationState> CalibrationReceived;

        /// <summary>A decision, with what led to it.</summary>
        public event Action<DecisionMessage> DecisionReceived;

        /// <summary>A command to the renderer.</summary>
        public event Action<CommandMessage> CommandReceived;

        /// <summary>What became of a command.</summary>
        public event Action<AckTelemetry> AckReceived;

        /// <summary>The room, after each welcome and whenever it changes.</summary>
        public event Action<SceneState> SceneChanged;

        /// <summary>Counters of the session.</summary>
        public event Action<StatsMessage> StatsReceived;

        /// <summary>Telemetry for which this client was too slow.</summary>
        public event Action<Missed> TelemetryMissed;

        /// <summary>Something went wrong in the session.</summary>
        public event Action<ErrorMessage> ErrorReceived;

        /// <summary>The connection.</summary>
        public Connection Connection { get; }

        /// <summary>Handles what has come and raises the events; call it regularly.</summary>
        public void Poll()
        {
            Connection.Poll();
        }

        void OnMessage(Message message)
        {
            if (message is PoseMessage pose) PoseReceived?.Invoke(pose);
            else if (message is ForecastMessage forecast) ForecastReceived?.Invoke(forecast);
            else if (message is AffectTelemetry affect) AffectReceived?.Invoke(affect);
            else if (message is CalibrationState calibration) CalibrationReceived?.Invoke(calibration);
            else if (message is DecisionMessage decision) DecisionReceived?.Invoke(decision);
            else if (message is CommandMessage command) CommandReceived?.Invoke(command);
            else if (message is AckTelemetry ack) AckReceived?.Invoke(ack);
            else if (message is SceneState scene) SceneChanged?.Invoke(scene);
            else if (message is StatsMessage stats) StatsReceived?.Invoke(stats);
            else if (message is Missed missed) TelemetryMissed?.Invoke(missed);
            else if (message is ErrorMessage error) ErrorReceived?.Invoke(error);
        }
    }
}
