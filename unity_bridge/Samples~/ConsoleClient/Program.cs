using System;
using System.Threading;

namespace AgentServer.ConsoleClient
{
    /// <summary>
    /// A renderer, or a monitor, on a terminal: prints each command and carries it out by its nominal
    /// times. Ends with a goodbye when its input ends, or on Ctrl+C.
    /// </summary>
    static class Program
    {
        const int GoodbyeMs = 1000;
        const int LongestSleepMs = 50;

        static readonly AutoResetEvent Wake = new AutoResetEvent(false);
        static volatile bool _isOver;

        static int Main(string[] arguments)
        {
            Options options;
            try
            {
                options = Options.Parse(arguments);
                options.Settings.Validate();
            }
            catch (ArgumentException wrong)
            {
                Console.Error.WriteLine(wrong.Message);
                Console.Error.WriteLine(Options.Usage);
                return 2;
            }
            WatchForTheEnd();
            IOutput output = options.IsJson ? (IOutput)new JsonOutput(Console.Out) : new PlainOutput(Console.Out);
            Connection connection = options.Settings.Role == Role.Renderer
                ? RunRenderer(options, output)
                : RunMonitor(options, output);
            bool hasGivenUp = connection.Phase == Phase.Stopped;
            connection.Stop(GoodbyeMs);
            output.End();
            return hasGivenUp ? 1 : 0;
        }

        static Connection RunRenderer(Options options, IOutput output)
        {
            var renderer = new RendererClient(options.Settings, clock: new MachineClock());
            var agent = new Agent(renderer, options.StepScale, output);
            Watch(renderer.Connection, output);
            Run(renderer.Connection, agent.Advance);
            return renderer.Connection;
        }

        static Connection RunMonitor(Options options, IOutput output)
        {
            var connection = new Connection(options.Settings);
            connection.Received += output.Message;
            Watch(connection, output);
            Run(connection, () => LongestSleepMs);
            return connection;
        }

        static void Watch(Connection connection, IOutput output)
        {
            connection.PhaseChanged += phase => output.Phase(phase, connection.Fault);
            connection.Welcomed += output.Welcome;
            connection.Arrived += () => Wake.Set();
        }

        /// <summary>Polls whenever something has come, and when the next thing falls due.</summary>
        static void Run(Connection connection, Func<double> advance)
        {
            connection.Start();
            while (!_isOver && connection.Phase != Phase.Stopped)
            {
                connection.Poll();
                double sleepMs = Math.Min(LongestSleepMs, advance());
                if (sleepMs > 0) Wake.WaitOne((int)Math.Ceiling(sleepMs));
            }
        }

        static void WatchForTheEnd()
        {
            Console.CancelKeyPress += (sender, pressed) =>
            {
                pressed.Cancel = true;
                Finish();
            };
            var input = new Thread(ReadToTheEnd) { IsBackground = true };
            input.Start();
        }

        static void ReadToTheEnd()
        {
            while (Console.In.ReadLine() != null)
            {
            }
            Finish();
        }

        static void Finish()
        {
            _isOver = true;
            Wake.Set();
        }
    }
}
