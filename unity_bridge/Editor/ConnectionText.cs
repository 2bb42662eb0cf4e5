using System.Globalization;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>How the state of a connection reads.</summary>
    public static class ConnectionText
    {
        /// <summary>The phase, and when it is tried again.</summary>
        public static string Phase(Connection connection)
        {
            double? next = connection.NextAttemptInMs;
            string words = connection.Phase.ToString().ToLowerInvariant();
            return next == null ? words : words + ", next attempt in " + Number(next.Value / 1000, "0.0") + " s";
        }

        /// <summary>Round trip of a ping.</summary>
        public static string RoundTrip(Connection connection) =>
            connection.RoundTripMs == null ? "not measured" : Number(connection.RoundTripMs.Value, "0.00") + " ms";

        /// <summary>The server's clock less the own one.</summary>
        public static string Offset(Connection connection) =>
            connection.ClockOffsetNs == null
                ? "not measured"
                : Number(connection.ClockOffsetNs.Value / 1e6, "0.00") + " ms";

        static string Number(double value, string format) => value.ToString(format, CultureInfo.InvariantCulture);
    }
}
