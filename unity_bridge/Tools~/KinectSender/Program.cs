using System;
using System.Threading;

namespace AgentServer.KinectSender
{
    /// <summary>Sends the bodies that a Kinect sees to the server, until its input ends or Ctrl+C.</summary>
    static class Program
    {
        const int GoodbyeMs = 1000;
        const string Usage =
            "usage: KinectSender [--url ws://127.0.0.1:8765] [--session demo] [--source SOURCE]\n"
            + "    [--coding json|msgpack] [--token SECRET] [--take-over] [--face expected|none]\n"
            + "SOURCE is one of: " + Sources.Names;

        static volatile bool _isOver;

        static int Main(string[] arguments)
        {
            var settings = new ConnectionSettings
            {
                Role = Role.Sensor, ClientName = "kinect-sender", Coding = Coding.MessagePack, Face = FaceKind.None,
            };
            try
            {
                string name = Parse(arguments, settings);
                settings.Validate();
                using (IBodySource source = Sources.Open(name)) return Run(settings, source);
            }
            catch (ArgumentException wrong)
            {
                Console.Error.WriteLine(wrong.Message);
                Console.Error.WriteLine(Usage);
                return 2;
            }
        }

        static int Run(ConnectionSettings settings, IBodySource source)
        {
            WatchForTheEnd();
            var sensor = new SensorClient(settings);
            var sender = new Sender(sensor, source);
            Connection connection = sensor.Connection;
            connection.PhaseChanged += phase => Console.WriteLine(phase + (connection.Fault == null ? "" : ": " + connection.Fault));
            sensor.Refused += error => Console.WriteLine("refused: " + error.Message);
            connection.Start();
            while (!_isOver && connection.Phase != Phase.Stopped)
            {
                sensor.Poll();
                sender.Step();
            }
            bool hasGivenUp = connection.Phase == Phase.Stopped;
            connection.Stop(GoodbyeMs);
            Console.WriteLine("sent " + sensor.Sent + ", dropped " + sensor.Dropped);
            return hasGivenUp ? 1 : 0;
        }

        /// <returns>Name of the source.</returns>
        static string Parse(string[] arguments, ConnectionSettings settings)
        {
            string source = Sources.Default;
            for (int at = 0; at < arguments.Length; at++)
            {
                string name = arguments[at];
                if (name == "--take-over")
                {
                    settings.TakeOver = true;
                    continue;
                }
                if (++at == arguments.Length) throw new ArgumentException(name + " is not known, or has no value");
                if (name == "--source") source = arguments[at];
                else Take(name, arguments[at], settings);
            }
            return source;
        }

        static void Take(string name, string value, ConnectionSettings settings)
        {
            switch (name)
            {
                case "--url": settings.Address = value; break;
                case "--session": settings.Session = value; break;
                case "--token": settings.Token = value; break;
                case "--coding": settings.Coding = value == "json" ? Coding.Json : Coding.MessagePack; break;
                case "--face": settings.Face = value == "expected" ? FaceKind.Expected : FaceKind.None; break;
                default: throw new ArgumentException(name + " is not known");
            }
        }

        static void WatchForTheEnd()
        {
            Console.CancelKeyPress += (sender, pressed) =>
            {
                pressed.Cancel = true;
                _isOver = true;
            };
            var input = new Thread(ReadToTheEnd) { IsBackground = true };
            input.Start();
        }

        static void ReadToTheEnd()
        {
            while (Console.In.ReadLine() != null)
            {
            }
            _isOver = true;
        }
    }
}
