namespace AgentServer.Unity
{
    /// <summary>What plays single steps: an avatar in a scene, or a fake in a test.</summary>
    public interface IStepBody
    {
        /// <summary>Whether the agent stands; it sits otherwise.</summary>
        bool IsStanding { get; }

        /// <summary>Begins a step.</summary>
        /// <returns>Null, or why it cannot be played.</returns>
        string Begin(StepMessage step);

        /// <summary>Plays on for so many seconds; true when the step is over.</summary>
        bool Play(float seconds);

        /// <summary>Cuts the step short; the agent stays where it is.</summary>
        void Cut();
    }

    /// <summary>Hears what becomes of a command.</summary>
    public interface ICommandReport
    {
        /// <summary>It starts. False if it is too late: then it is not to be played.</summary>
        bool Start(string commandId);

        /// <summary>A step has ended. False if the command is over: then no more is to be played.</summary>
        bool Progress(string commandId, int step);

        /// <summary>Every step has ended.</summary>
        void Done(string commandId);

        /// <summary>It cannot be carried out.</summary>
        void Fail(string commandId, string reason);
    }

    /// <summary>Plays the steps of a command one after the other, and reports.</summary>
    public sealed class CommandPlayer
    {
        readonly IStepBody _body;
        readonly ICommandReport _report;
        int _step;
        bool _isPlaying;

        /// <param name="body">Plays the steps.</param>
        /// <param name="report">Hears what becomes of commands.</param>
        public CommandPlayer(IStepBody body, ICommandReport report)
        {
            _body = body;
            _report = report;
        }

        /// <summary>The command that is being played; null if none is.</summary>
        public CommandMessage Command { get; private set; }

        /// <summary>Whether an agent that stands, or sits, has nothing to do for a step.</summary>
        public static bool IsNeedless(StepMessage step, bool isStanding) =>
            step.Action == "stand_up" && isStanding || step.Action == "sit_down" && !isStanding;

        /// <summary>Starts a command, and cuts one that is being played.</summary>
        /// <returns>False if it came too late: then nothing is played.</returns>
        public bool Begin(CommandMessage command)
        {
            Cancel();
            if (!_report.Start(command.Id)) return false;
            Command = command;
            _step = 0;
            BeginNext();
            return true;
        }

        /// <summary>Cuts the command short, without a word: who cancels knows.</summary>
        public void Cancel()
        {
            if (_isPlaying) _body.Cut();
            _isPlaying = false;
            Command = null;
        }

        /// <summary>Gives the command up, and says why.</summary>
        public void Abandon(string reason)
        {
            if (Command == null) return;
            string id = Command.Id;
            Cancel();
            _report.Fail(id, reason);
        }

        /// <summary>Plays on for so many seconds.</summary>
        public void Update(float seconds)
        {
            if (!_isPlaying || !_body.Play(seconds)) return;
            _isPlaying = false;
            if (EndStep()) BeginNext();
        }

        /// <summary>Begins the next step that has something to play, or ends the command.</summary>
        void BeginNext()
        {
            while (_step < Command.Steps.Count)
            {
                StepMessage step = Command.Steps[_step];
                if (!IsNeedless(step, _body.IsStanding))
                {
                    string problem = _body.Begin(step);
                    _isPlaying = problem == null;
                    if (problem != null) Abandon(problem);
                    return;
                }
                if (!EndStep()) return;
            }
            string id = Command.Id;
            Command = null;
            _report.Done(id);
        }

        bool EndStep()
        {
            if (_report.Progress(Command.Id, _step))
            {
                _step++;
                return true;
            }
            Command = null;
            return false;
        }
    }
}
