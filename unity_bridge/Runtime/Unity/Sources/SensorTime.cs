namespace AgentServer.Unity
{
    /// <summary>Makes stamps of a sensor's clock: zero at the first frame, and never back.</summary>
    public sealed class SensorTime
    {
        long? _start;
        long _last = -1;

        /// <summary>The stamp of a frame.</summary>
        /// <param name="sensorNs">The sensor's own time in nanoseconds.</param>
        /// <param name="stampNs">Nanoseconds since the first frame.</param>
        /// <returns>False for a frame that is not later than the one before.</returns>
        public bool TryStamp(long sensorNs, out long stampNs)
        {
            if (_start == null) _start = sensorNs;
            stampNs = sensorNs - _start.Value;
            if (stampNs <= _last) return false;
            _last = stampNs;
            return true;
        }

        /// <summary>The low 53 bits of an id, which JSON holds exactly; a Kinect v2 counts from 2^56.</summary>
        public static long BodyId(ulong id) => (long)(id & ((1UL << 53) - 1));
    }
}
