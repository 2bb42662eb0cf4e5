using System.Globalization;
using System.IO;
using System.Text;

namespace AgentServer.ConsoleClient
{
    /// <summary>When a command came; all in nanoseconds.</summary>
    readonly struct Arrival
    {
        public Arrival(CommandMessage command, Connection connection)
        {
            ReceivedNs = connection.ReceivedNs;
            LatencyNs = ReceivedNs + connection.ClockOffsetNs - command.ServerNs;
            DirectNs = ReceivedNs - command.ServerNs;
            RoundTripNs = (long?)(connection.RoundTripMs * 1e6);
        }

        /// <summary>The machine's clock.</summary>
        public long ReceivedNs { get; }

        /// <summary>Since it was decided, by the estimate of the server's clock; null before there is one.</summary>
        public long? LatencyNs { get; }

        /// <summary>Since it was decided, where the server runs on the same machine.</summary>
        public long DirectNs { get; }

        /// <summary>Round trip of a ping; null before the first.</summary>
        public long? RoundTripNs { get; }
    }

    /// <summary>Says what happens.</summary>
    interface IOutput
    {
        void Phase(Phase phase, string fault);

        void Welcome(Welcome welcome);

        void Command(CommandMessage command, Arrival arrival);

        void Step(CommandMessage command, StepMessage step);

        /// <summary>A command is carried out: what must happen once has happened.</summary>
        void Effect(string id);

        void Cancel(CommandMessage command, string reason);

        void Scene(SceneState scene);

        /// <summary>A monitor got a message.</summary>
        void Message(Message message);

        void End();
    }

    /// <summary>Lines for people.</summary>
    sealed class PlainOutput : IOutput
    {
        readonly TextWriter _to;

        public PlainOutput(TextWriter to)
        {
            _to = to;
        }

        public void Phase(Phase phase, string fault)
        {
            _to.WriteLine(phase.ToString().ToLowerInvariant() + (fault == null ? "" : ": " + fault));
        }

        public void Welcome(Welcome welcome)
        {
            _to.WriteLine("session " + welcome.Session + " of " + welcome.Server + " " + welcome.ServerVersion);
        }

        public void Command(CommandMessage command, Arrival arrival)
        {
            double? lateMs = arrival.LatencyNs / 1e6;
            string late = lateMs == null ? "" : string.Format(CultureInfo.InvariantCulture, ", {0:0.0} ms", lateMs);
            _to.WriteLine("command " + command.Id + ": " + command.Reaction + " because of " + command.Cause + late);
        }

        public void Step(CommandMessage command, StepMessage step)
        {
            _to.WriteLine("    " + step.Action + (step.Target == null ? "" : " " + step.Target));
        }

        public void Effect(string id)
        {
            _to.WriteLine("done " + id);
        }

        public void Cancel(CommandMessage command, string reason)
        {
            _to.WriteLine("cancelled " + command.Id + ": " + reason);
        }

        public void Scene(SceneState scene)
        {
            var line = new StringBuilder("room: " + scene.Mode);
            foreach (var one in scene.Objects) line.Append(", ").Append(one.Key).Append(' ').Append(one.Value);
            _to.WriteLine(line);
        }

        public void Message(Message message)
        {
            _to.WriteLine(message.Type);
        }

        public void End()
        {
            _to.WriteLine("goodbye");
        }
    }

    /// <summary>A line of JSON for each event, for programs.</summary>
    sealed class JsonOutput : IOutput
    {
        readonly TextWriter _to;

        public JsonOutput(TextWriter to)
        {
            _to = to;
        }

        public void Phase(Phase phase, string fault)
        {
            Write("phase", "phase", Text(phase.ToString().ToLowerInvariant()), "fault", Text(fault));
        }

        public void Welcome(Welcome welcome)
        {
            Write(
                "welcome", "epoch", Text(welcome.Epoch), "ledger", Text(welcome.Ledger),
                "resumed", welcome.Resumed ? "true" : "false");
        }

        public void Command(CommandMessage command, Arrival arrival)
        {
            Write(
                "command", "id", Text(command.Id), "received_ns", Number(arrival.ReceivedNs),
                "latency_ns", Number(arrival.LatencyNs), "direct_ns", Number(arrival.DirectNs),
                "round_trip_ns", Number(arrival.RoundTripNs));
        }

        public void Step(CommandMessage command, StepMessage step)
        {
            Write("step", "id", Text(command.Id), "action", Text(step.Action));
        }

        public void Effect(string id)
        {
            Write("effect", "id", Text(id));
        }

        public void Cancel(CommandMessage command, string reason)
        {
            Write("cancel", "id", Text(command.Id), "reason", Text(reason));
        }

        public void Scene(SceneState scene)
        {
            Write("scene", "mode", Text(scene.Mode));
        }

        public void Message(Message message)
        {
            Write("message", "type", Text(message.Type));
        }

        public void End()
        {
            Write("end");
        }

        /// <param name="name">Name of the event.</param>
        /// <param name="fields">Names and values, in turn; values are JSON already.</param>
        void Write(string name, params string[] fields)
        {
            var line = new StringBuilder("{\"event\":" + Text(name));
            for (int at = 0; at < fields.Length; at += 2)
                line.Append(",\"").Append(fields[at]).Append("\":").Append(fields[at + 1]);
            _to.WriteLine(line.Append('}'));
            _to.Flush();
        }

        static string Number(long? number) => number == null ? "null" : number.Value.ToString(CultureInfo.InvariantCulture);

        static string Text(string text)
        {
            if (text == null) return "null";
            var escaped = new StringBuilder("\"");
            foreach (char unit in text)
            {
                bool isPlain = unit >= ' ' && unit <= '~' && unit != '"' && unit != '\\';
                if (isPlain) escaped.Append(unit);
                else escaped.Append("\\u").Append(((int)unit).ToString("x4"));
            }
            return escaped.Append('"').ToString();
        }
    }
}
