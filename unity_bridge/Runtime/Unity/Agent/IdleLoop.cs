using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>
    /// What the agent does unasked: it picks a step of the table, plays it, and picks the next. An agent
    /// that is to work and stands, because a command was cut short, first goes back to its seat.
    /// </summary>
    public sealed class IdleLoop
    {
        readonly IStepBody _body;
        readonly IRandom _random;
        readonly Queue<StepMessage> _ahead = new Queue<StepMessage>();
        bool _isPlaying;

        /// <param name="body">Plays the steps.</param>
        /// <param name="random">Picks them.</param>
        public IdleLoop(IStepBody body, IRandom random)
        {
            _body = body;
            _random = random;
        }

        /// <summary>Cuts what is being played; a command or another mode begins.</summary>
        public void Cut()
        {
            if (_isPlaying) _body.Cut();
            _isPlaying = false;
            _ahead.Clear();
        }

        /// <summary>Plays on for so many seconds.</summary>
        /// <param name="seconds">Time since the last call.</param>
        /// <param name="table">What is done in the present mode.</param>
        /// <param name="seat">Object on which the agent works; null where it may stand.</param>
        public void Update(float seconds, IReadOnlyList<IdleStep> table, string seat)
        {
            if (_isPlaying)
            {
                if (!_body.Play(seconds)) return;
                _isPlaying = false;
            }
            if (_ahead.Count == 0) LookAhead(table, seat);
            if (_ahead.Count == 0) return;
            _isPlaying = _body.Begin(_ahead.Dequeue()) == null;
            // Who cannot get to the seat does not sit down beside it.
            if (!_isPlaying) _ahead.Clear();
        }

        void LookAhead(IReadOnlyList<IdleStep> table, string seat)
        {
            if (seat != null && _body.IsStanding)
            {
                _ahead.Enqueue(new StepMessage("walk_to", 2, seat));
                _ahead.Enqueue(new StepMessage("sit_down", 1.3));
                return;
            }
            StepMessage step = IdleChooser.Choose(table, _random.NextUnit());
            if (step != null) _ahead.Enqueue(step);
        }
    }
}
