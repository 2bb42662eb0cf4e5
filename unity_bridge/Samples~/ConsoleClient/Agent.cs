using System.Collections.Generic;

namespace AgentServer.ConsoleClient
{
    /// <summary>Carries out commands by letting the nominal time of each step pass.</summary>
    sealed class Agent
    {
        readonly RendererClient _renderer;
        readonly IClock _clock;
        readonly double _scale;
        readonly IOutput _output;

        CommandMessage _command;
        int _step;
        long _stepEndsNs;

        /// <param name="renderer">Whose commands are carried out.</param>
        /// <param name="scale">Factor of the nominal times.</param>
        /// <param name="output">Where to say so.</param>
        public Agent(RendererClient renderer, double scale, IOutput output)
        {
            _renderer = renderer;
            _clock = renderer.Connection.Clock;
            _scale = scale;
            _output = output;
            renderer.SceneChanged += OnScene;
            renderer.CommandReceived += OnCommand;
            renderer.CommandCancelled += OnCancelled;
        }

        /// <summary>Ends the steps whose time is over.</summary>
        /// <returns>Milliseconds until the next one ends; infinity if nothing is carried out.</returns>
        public double Advance()
        {
            while (_command != null)
            {
                long left = _stepEndsNs - _clock.NowNs;
                if (left > 0) return left / 1e6;
                EndStep();
            }
            return double.PositiveInfinity;
        }

        void OnCommand(CommandMessage command)
        {
            _output.Command(command, new Arrival(command, _renderer.Connection));
            if (!_renderer.Start(command.Id)) return;
            _command = command;
            _step = -1;
            _stepEndsNs = _clock.NowNs;
        }

        void OnCancelled(CommandMessage command, string reason)
        {
            _command = null;
            _output.Cancel(command, reason);
        }

        void EndStep()
        {
            if (_step >= 0) _renderer.Progress(_command.Id, _step);
            _step++;
            if (_step < _command.Steps.Count)
            {
                StepMessage step = _command.Steps[_step];
                _stepEndsNs += (long)(step.DurationS * _scale * 1e9);
                _output.Step(_command, step);
                return;
            }
            string id = _command.Id;
            _command = null;
            if (_renderer.Done(id)) _output.Effect(id);
        }

        void OnScene(SceneState scene)
        {
            _output.Scene(scene);
        }
    }
}
