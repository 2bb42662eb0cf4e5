using AgentServer.Unity;
using UnityEngine;

namespace AgentServer.Samples
{
    /// <summary>
    /// The least that a renderer does: it starts a command, waits for the time of its steps, and says that
    /// it is done. Put it on the object of an <see cref="AgentClient"/>.
    /// </summary>
    [RequireComponent(typeof(AgentClient))]
    public sealed class MinimalRenderer : MonoBehaviour
    {
        AgentClient _client;
        CommandMessage _command;
        int _step;
        float _left;

        void OnEnable()
        {
            _client = GetComponent<AgentClient>();
            _client.CommandReceived += Begin;
            _client.CommandCancelled += Cancel;
        }

        void OnDisable()
        {
            _client.CommandReceived -= Begin;
            _client.CommandCancelled -= Cancel;
        }

        void Update()
        {
            if (_command == null) return;
            _left -= Time.deltaTime;
            if (_left > 0) return;
            _client.Renderer.Progress(_command.Id, _step);
            _step++;
            if (_step < _command.Steps.Count)
            {
                BeginStep();
                return;
            }
            _client.Renderer.Done(_command.Id);
            Debug.Log("Done: " + _command.Reaction);
            _command = null;
        }

        void Begin(CommandMessage command)
        {
            // False if it came too late: then it is not to be carried out.
            if (!_client.Renderer.Start(command.Id)) return;
            Debug.Log("Command: " + command.Reaction + ", because of " + command.Cause);
            _command = command;
            _step = 0;
            BeginStep();
        }

        // Stop at once, and say nothing: the server knows.
        void Cancel(CommandMessage command, string reason)
        {
            Debug.Log("Cut short (" + reason + "): " + command.Reaction);
            _command = null;
        }

        void BeginStep()
        {
            StepMessage step = _command.Steps[_step];
            _left = (float)step.DurationS;
            Debug.Log("  " + step.Action + " " + step.Target);
        }
    }
}
