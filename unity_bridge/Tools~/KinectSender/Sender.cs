using System.Collections.Generic;

namespace AgentServer.KinectSender
{
    /// <summary>Sends what a source sees, with stamps on the sensor's own time line.</summary>
    sealed class Sender
    {
        const long NsPerTick = 100;

        readonly SensorClient _sensor;
        readonly IBodySource _source;
        readonly List<BodySample> _bodies = new List<BodySample>();
        readonly Dictionary<ulong, long> _numbers = new Dictionary<ulong, long>();
        long? _deviceLeadNs;

        public Sender(SensorClient sensor, IBodySource source)
        {
            _sensor = sensor;
            _source = source;
        }

        /// <summary>Sends the bodies of the next frame, if there is one.</summary>
        public void Step()
        {
            _bodies.Clear();
            _source.Read(_bodies);
            foreach (BodySample body in _bodies)
                _sensor.SendSkeleton(Number(body.TrackingId), _source.Format, body.Joints, StampNs(body));
        }

        /// <summary>The device's clock, moved so that its first frame was captured when it came.</summary>
        long StampNs(BodySample body)
        {
            long deviceNs = body.CapturedAt.Ticks * NsPerTick;
            if (_deviceLeadNs == null) _deviceLeadNs = deviceNs - _sensor.StampNs;
            return deviceNs - _deviceLeadNs.Value;
        }

        /// <summary>A small number for each identity: a Kinect's have 64 bits, and the protocol has 53.</summary>
        long Number(ulong trackingId)
        {
            long number;
            if (!_numbers.TryGetValue(trackingId, out number))
            {
                number = _numbers.Count;
                _numbers.Add(trackingId, number);
            }
            return number;
        }
    }
}
