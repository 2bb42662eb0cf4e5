using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Says on the console what becomes of a connection, once each, and what to do.</summary>
    public sealed class ConnectionLog
    {
        readonly Connection _connection;
        readonly string _what;
        readonly Object _context;
        Phase _last = Phase.Stopped;
        string _said = "";

        /// <param name="connection">What is told of.</param>
        /// <param name="what">What to call it, for example `renderer`.</param>
        /// <param name="context">Object that the console points to.</param>
        public ConnectionLog(Connection connection, string what, Object context)
        {
            _connection = connection;
            _what = what;
            _context = context;
            connection.PhaseChanged += Hear;
            connection.ClockJumped += () => Debug.LogWarning(
                Name + " A clock has jumped; the time offset is measured anew.", _context);
        }

        string Name => "Agent server, " + _what + ":";

        void Hear(Phase phase)
        {
            Phase from = _last;
            _last = phase;
            if (phase == Phase.Live)
            {
                _said = "";
                Debug.Log(Name + " connected, session '" + _connection.Welcome.Session + "'.", _context);
            }
            else if (_connection.Fault != null && (phase == Phase.Waiting || phase == Phase.Stopped)) Fault(from, phase);
        }

        void Fault(Phase from, Phase phase)
        {
            // An attempt that fails as the one before is no news.
            if (phase == Phase.Waiting && _connection.Fault == _said) return;
            _said = _connection.Fault;
            string words = Name + " " + _connection.Fault.TrimEnd('.') + ". " + Advice(from, phase);
            if (phase == Phase.Stopped) Debug.LogError(words, _context);
            else Debug.LogWarning(words, _context);
        }

        static string Advice(Phase from, Phase phase)
        {
            if (phase == Phase.Stopped)
                return "The client does not try again by itself: tick Take Over, choose another session, or call Connect.";
            switch (from)
            {
                case Phase.Opening:
                    return "Start the server with `agent-server serve`, and check address, port and firewall. "
                        + "It is tried again.";
                case Phase.Greeting:
                    return "The server did not take the client: check session, token and versions. It is tried again.";
                default:
                    return "It is tried again, and resumed.";
            }
        }
    }
}
