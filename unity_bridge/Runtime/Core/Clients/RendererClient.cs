using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>
    /// Carries out what the server commands, once each, whatever happens to the connection. All events
    /// are raised by <see cref="Poll"/>, in order.
    /// </summary>
    public sealed class RendererClient
    {
        readonly bool _isMirror;

        /// <summary>Makes a renderer; it does nothing before `Connection.Start()`.</summary>
        /// <param name="settings">Where to connect; the role must be renderer.</param>
        /// <param name="transports">Makes the sockets; null for `System.Net.WebSockets`.</param>
        /// <param name="clock">Monotonic clock; null for the machine's.</param>
        /// <param name="random">Chance of the waiting times; null for the machine's.</param>
        /// <exception cref="ArgumentException">If a setting is wrong.</exception>
        public RendererClient(
            ConnectionSettings settings,
            ITransportFactory transports = null,
            IClock clock = null,
            IRandom random = null)
        {
            Roles.Require(settings, Role.Renderer);
            _isMirror = settings.Mirror;
            Connection = new Connection(settings, transports, clock, random) { Resume = Resume };
            Connection.PhaseChanged += OnPhase;
            Connection.Welcomed += OnWelcome;
            Connection.Received += OnMessage;
        }

        /// <summary>A command is to be carried out: call <see cref="Start"/> first.</summary>
        public event Action<CommandMessage> CommandReceived;

        /// <summary>
        /// A command is cut short: stop at once, and say nothing. The reason is
        /// <see cref="CommandLedger.Preempted"/> or <see cref="CommandLedger.Forgotten"/>.
        /// </summary>
        public event Action<CommandMessage, string> CommandCancelled;

        /// <summary>
        /// More of the motion of the command that is under way; it needs
        /// <see cref="ConnectionSettings.PlaysMotion"/>.
        /// </summary>
        public event Action<PoseStreamMessage> MotionReceived;

        /// <summary>The room, after each welcome and whenever it changes.</summary>
        public event Action<SceneState> SceneChanged;

        /// <summary>
        /// On what the objects shown and the room did not agree, and whose state holds; the room as it is
        /// now comes next.
        /// </summary>
        public event Action<IReadOnlyList<Difference>> Reconciled;

        /// <summary>The connection.</summary>
        public Connection Connection { get; }

        /// <summary>What became of each command.</summary>
        public CommandLedger Ledger { get; } = new CommandLedger();

        /// <summary>Gives the state of each object as it is shown; null if nothing is told.</summary>
        public Func<IDictionary<string, string>> Objects { get; set; }

        /// <summary>Handles what has come and raises the events; call it regularly.</summary>
        public void Poll()
        {
            Connection.Poll();
        }

        /// <summary>The application begins with a command.</summary>
        /// <returns>Whether it may; if not, it is too late or over: do nothing.</returns>
        public bool Start(string id)
        {
            AckMessage word;
            bool isTaken = Ledger.Start(id, Connection.Clock.NowNs, out word);
            Say(word);
            return isTaken;
        }

        /// <summary>A step of a command has ended.</summary>
        /// <returns>Whether the command goes on; if not, stop.</returns>
        public bool Progress(string id, int step)
        {
            AckMessage word;
            bool isTaken = Ledger.Progress(id, step, out word);
            Say(word);
            return isTaken;
        }

        /// <summary>A command is carried out.</summary>
        /// <returns>Whether it was still open.</returns>
        public bool Done(string id)
        {
            AckMessage word;
            bool isTaken = Ledger.Done(id, out word);
            Say(word);
            return isTaken;
        }

        /// <summary>A command cannot be carried out.</summary>
        /// <returns>Whether it was still open.</returns>
        public bool Fail(string id, string reason)
        {
            AckMessage word;
            bool isTaken = Ledger.Fail(id, reason, out word);
            Say(word);
            return isTaken;
        }

        /// <summary>Somebody changed an object by hand.</summary>
        /// <returns>Whether it is sent now; if not, the next hello tells of it.</returns>
        public bool ReportObject(string name, string state)
        {
            return !_isMirror && Connection.Send(new SceneEvent(name, state));
        }

        void OnPhase(Phase phase)
        {
            if (phase == Phase.Waiting || phase == Phase.Stopped) Ledger.Lose();
        }

        void OnWelcome(Welcome welcome)
        {
            CommandMessage cancelled = Ledger.Enter(welcome.Ledger);
            Say(Ledger.Regain());
            if (cancelled != null) CommandCancelled?.Invoke(cancelled, CommandLedger.Forgotten);
            if (welcome.Differences.Count != 0) Reconciled?.Invoke(welcome.Differences);
            SceneChanged?.Invoke(welcome.Scene);
        }

        void OnMessage(Message message)
        {
            if (message is CommandMessage command) OnCommand(command);
            else if (message is SceneState scene) SceneChanged?.Invoke(scene);
            else if (message is PoseStreamMessage stretch) OnMotion(stretch);
            else if (message is PackedPoseStreamMessage packed) OnMotion(Packed.Unpack(packed));
        }

        void OnMotion(PoseStreamMessage stretch)
        {
            if (Ledger.Running?.Id == stretch.CommandId) MotionReceived?.Invoke(stretch);
        }

        void OnCommand(CommandMessage command)
        {
            LedgerAnswer answer = Ledger.Receive(command, Connection.ReceivedNs);
            foreach (AckMessage word in answer.Words) Say(word);
            if (answer.Cancelled != null) CommandCancelled?.Invoke(answer.Cancelled, CommandLedger.Preempted);
            if (answer.Command != null) CommandReceived?.Invoke(answer.Command);
        }

        ResumeState Resume()
        {
            IDictionary<string, string> shown = Objects == null ? null : Objects();
            return new ResumeState(
                Ledger.Ledger,
                Ledger.Ledger == null ? (long?)null : Ledger.LastSequence,
                shown == null ? null : new Dictionary<string, string>(shown));
        }

        void Say(AckMessage word)
        {
            if (word != null && !_isMirror) Connection.Send(word);
        }
    }
}
