using System;
using System.Globalization;

namespace AgentServer.ConsoleClient
{
    /// <summary>What the command line says.</summary>
    sealed class Options
    {
        public const string Usage =
            "usage: ConsoleClient [--url ws://127.0.0.1:8765] [--session demo] [--role renderer|monitor]\n"
            + "    [--coding json|msgpack] [--step-scale 1] [--token SECRET] [--take-over] [--mirror] [--json]";

        /// <summary>Where to connect, and as what.</summary>
        public ConnectionSettings Settings { get; } = new ConnectionSettings { ClientName = "console-client" };

        /// <summary>Factor of the nominal times of steps.</summary>
        public double StepScale { get; private set; } = 1;

        /// <summary>Whether to print a line of JSON for each event.</summary>
        public bool IsJson { get; private set; }

        /// <exception cref="ArgumentException">If an argument is wrong; the text says which.</exception>
        public static Options Parse(string[] arguments)
        {
            var options = new Options();
            for (int at = 0; at < arguments.Length; at++)
            {
                string name = arguments[at];
                if (options.TakeFlag(name)) continue;
                if (at + 1 == arguments.Length) throw new ArgumentException(name + " is not known, or has no value");
                options.Take(name, arguments[++at]);
            }
            return options;
        }

        bool TakeFlag(string name)
        {
            switch (name)
            {
                case "--json": IsJson = true; return true;
                case "--take-over": Settings.TakeOver = true; return true;
                case "--mirror": Settings.Mirror = true; return true;
                default: return false;
            }
        }

        void Take(string name, string value)
        {
            switch (name)
            {
                case "--url": Settings.Address = value; break;
                case "--session": Settings.Session = value; break;
                case "--token": Settings.Token = value; break;
                case "--role": Settings.Role = ParseRole(value); break;
                case "--coding": Settings.Coding = ParseCoding(value); break;
                case "--step-scale": StepScale = ParseScale(value); break;
                default: throw new ArgumentException(name + " is not known");
            }
        }

        static Role ParseRole(string value)
        {
            if (value == "renderer") return Role.Renderer;
            if (value == "monitor") return Role.Monitor;
            throw new ArgumentException("--role is '" + value + "': give renderer or monitor");
        }

        static Coding ParseCoding(string value)
        {
            if (value == "json") return Coding.Json;
            if (value == "msgpack") return Coding.MessagePack;
            throw new ArgumentException("--coding is '" + value + "': give json or msgpack");
        }

        static double ParseScale(string value)
        {
            double scale;
            if (double.TryParse(value, NumberStyles.Float, CultureInfo.InvariantCulture, out scale) && scale >= 0)
                return scale;
            throw new ArgumentException("--step-scale is '" + value + "': give a number from 0");
        }
    }
}
