using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// Plays the server's commands on an agent, and what it does unasked in between.
    /// </summary>
    /// <remarks>
    /// A command is started, and every step, the end or a failure is reported. A command that is cut short
    /// stops where it is; the next one starts from there. How the agent moves is the matter of an
    /// <see cref="IAgentMotion"/> on the same object.
    /// </remarks>
    [AddComponentMenu("Agent Server/Agent Animator")]
    [DisallowMultipleComponent]
    public sealed class AgentAnimator : MonoBehaviour, IStepBody, ICommandReport
    {
        const float StandOff = 1;

        [SerializeField, Tooltip("The connection to the server.")]
        AgentClient _client;

        [SerializeField, Tooltip("The objects that steps name.")]
        Room _room;

        [SerializeField, Tooltip("Whom the agent looks at; empty: the main camera.")]
        Transform _person;

        [SerializeField, Tooltip("Whether the agent sits at the start.")]
        bool _startsSitting = true;

        [SerializeField, Tooltip("Object on which the agent works; empty if it may stand.")]
        string _seat = "chair";

        [SerializeField, Min(0.1f), Tooltip("Metres a second; faster where a step's time is too short for the way.")]
        float _walkSpeed = 1.4f;

        [SerializeField, Min(1), Tooltip("Degrees a second.")]
        float _turnSpeed = 240;

        [SerializeField, Tooltip("How each step looks.")]
        StepMapping[] _steps = StepMapping.Default();

        [SerializeField, Tooltip("What the agent does unasked while it works.")]
        IdleStep[] _working =
        {
            new IdleStep("type_on", "keyboard", 4, 6),
            new IdleStep("look_at", "screen", 1.5f, 3),
            new IdleStep("look_at", "notebook", 1.5f, 1),
        };

        [SerializeField, Tooltip("What the agent does unasked while it attends to the person.")]
        IdleStep[] _attention =
        {
            new IdleStep("look_at_person", "", 2, 8),
            new IdleStep("look_at", "notebook", 1.5f, 1),
            new IdleStep("look_at", "cigarette", 1.5f, 1),
        };

        IAgentMotion _motion;
        CommandPlayer _player;
        IdleLoop _idle;
        StepMessage _step;
        Walk _walk;
        float _left;
        string _mode = "";

        /// <inheritdoc/>
        public bool IsStanding { get; private set; }

        /// <summary>The command that is being played; null if none is.</summary>
        public CommandMessage Command => _player?.Command;

        /// <summary>Wires it, for scenes that are built by a program; call it before it is enabled.</summary>
        public void Wire(AgentClient client, Room room, Transform person)
        {
            _client = client;
            _room = room;
            _person = person;
        }

        string IStepBody.Begin(StepMessage step)
        {
            RoomObject target = step.Target == null ? null : _room.Find(step.Target);
            if (step.Target != null && target == null)
                return "there is no object '" + step.Target + "' in the scene";
            _step = step;
            _left = (float)step.DurationS;
            _walk = WalkFor(step, target);
            _motion.LookAt(GazeFor(step, target));
            _motion.Play(step, StepMapping.Find(_steps, step));
            return null;
        }

        bool IStepBody.Play(float seconds)
        {
            _left -= seconds;
            if (!Go(seconds)) return false;
            if (_step.Action == "stand_up") IsStanding = true;
            if (_step.Action == "sit_down") IsStanding = false;
            Preview();
            _step = null;
            _walk = null;
            _motion.Rest(IsStanding);
            return true;
        }

        void IStepBody.Cut()
        {
            // Halfway up or down: the agent finishes what costs it less.
            bool isHalfDone = _step != null && _left < _step.DurationS / 2;
            if (isHalfDone && _step.Action == "stand_up") IsStanding = true;
            if (isHalfDone && _step.Action == "sit_down") IsStanding = false;
            _step = null;
            _walk = null;
            _motion.LookAt(null);
            _motion.Rest(IsStanding);
            _room.EndPreviews();
        }

        bool ICommandReport.Start(string commandId) => _client.Renderer.Start(commandId);

        bool ICommandReport.Progress(string commandId, int step) => _client.Renderer.Progress(commandId, step);

        void ICommandReport.Done(string commandId) => _client.Renderer.Done(commandId);

        void ICommandReport.Fail(string commandId, string reason)
        {
            Debug.LogWarning("The command " + commandId + " cannot be carried out: " + reason + ".", this);
            _client.Renderer.Fail(commandId, reason);
        }

        void Awake() => IsStanding = !_startsSitting;

        void OnEnable()
        {
            _motion = GetComponent<IAgentMotion>();
            if (_client == null || _room == null || _motion == null)
            {
                Debug.LogError("The agent '" + name + "' lacks "
                    + (_client == null ? "a client: set its field Client."
                        : _room == null ? "a room: set its field Room."
                        : "a motion: add an Animator Motion to it."), this);
                enabled = false;
                return;
            }
            _player = new CommandPlayer(this, this);
            _idle = new IdleLoop(this, new SystemRandom());
            _client.CommandReceived += Begin;
            _client.CommandCancelled += Cancel;
            _client.SceneChanged += Hear;
            _motion.Rest(IsStanding);
        }

        void OnDisable()
        {
            if (_player == null) return;
            _client.CommandReceived -= Begin;
            _client.CommandCancelled -= Cancel;
            _client.SceneChanged -= Hear;
            _idle.Cut();
            _player.Abandon("the agent was switched off");
            _player = null;
        }

        void Update()
        {
            if (_player.Command != null) _player.Update(Time.deltaTime);
            else if (_mode == "working") _idle.Update(Time.deltaTime, _working, _seat == "" ? null : _seat);
            else if (_mode == "attention") _idle.Update(Time.deltaTime, _attention, null);
        }

        void Begin(CommandMessage command)
        {
            _idle.Cut();
            _player.Begin(command);
        }

        // Only the command that is being carried out is ever cut short.
        void Cancel(CommandMessage command, string reason) => _player.Cancel();

        void Hear(SceneState scene)
        {
            if (scene.Mode == _mode) return;
            _mode = scene.Mode;
            if (_player.Command == null) _idle.Cut();
        }

        /// <summary>Moves on; whether the step is over.</summary>
        bool Go(float seconds)
        {
            if (_walk == null) return _left <= 0;
            Quaternion rotation = transform.rotation;
            bool hasArrived = _walk.Go(seconds, ref rotation);
            transform.rotation = rotation;
            transform.position = _walk.Position;
            // A way takes as long as it takes; a turn on the spot takes the step's time.
            return hasArrived && (_step.Action == "walk_to" || _left <= 0);
        }

        Walk WalkFor(StepMessage step, RoomObject target)
        {
            Vector3 place = transform.position;
            switch (step.Action)
            {
                case "walk_to":
                    Transform stand = target.StandPoint;
                    if (stand != null) return WalkTo(stand.position, stand.rotation, step);
                    Vector3 way = Flat(place - target.transform.position);
                    if (way.magnitude < 0.01f) way = Vector3.back;
                    return WalkTo(
                        target.transform.position + way.normalized * StandOff, Quaternion.LookRotation(-way), step);
                case "turn_to":
                    return TurnTo(target.transform.position, step);
                case "turn_to_person":
                    return Person() == null ? null : TurnTo(Person().position, step);
                default:
                    return null;
            }
        }

        Walk TurnTo(Vector3 point, StepMessage step)
        {
            Vector3 way = Flat(point - transform.position);
            return way.magnitude < 0.01f ? null : WalkTo(transform.position, Quaternion.LookRotation(way), step);
        }

        Walk WalkTo(Vector3 place, Quaternion facing, StepMessage step) =>
            new Walk(transform.position, place, facing, _walkSpeed, _turnSpeed, (float)step.DurationS);

        Vector3? GazeFor(StepMessage step, RoomObject target)
        {
            if (step.Action == "turn_to_person" || step.Action == "look_at_person")
                return Person() == null ? (Vector3?)null : Person().position;
            if (target == null || step.Action == "walk_to") return null;
            return target.transform.position;
        }

        Transform Person()
        {
            if (_person != null) return _person;
            return Camera.main == null ? null : Camera.main.transform;
        }

        void Preview()
        {
            StepMapping mapping = StepMapping.Find(_steps, _step);
            if (mapping == null || mapping.ObjectState == "" || _step.Target == null) return;
            RoomObject target = _room.Find(_step.Target);
            if (target != null) target.Preview(mapping.ObjectState);
        }

        static Vector3 Flat(Vector3 v) => new Vector3(v.x, 0, v.z);
    }
}
