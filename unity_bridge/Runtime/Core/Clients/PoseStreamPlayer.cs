using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>
    /// Plays a motion while it comes: where its joints are now, and how much of it is to be seen. Beside
    /// it, and where it ends, the authored motion shows.
    /// </summary>
    public sealed class PoseStreamPlayer
    {
        /// <summary>Nothing came for so many seconds: it is taken to be over.</summary>
        public const double Patience = 0.5;

        readonly double _blend;
        readonly List<IReadOnlyList<Point3>> _frames = new List<IReadOnlyList<Point3>>();
        readonly Dictionary<string, int> _joints = new Dictionary<string, int>();
        string _command;
        double _rate, _time, _starved;
        bool _isWhole, _isEnding;

        /// <summary>Makes a player that plays nothing.</summary>
        /// <param name="blend">Seconds in which a motion fades in, and out.</param>
        public PoseStreamPlayer(double blend = 0.3)
        {
            if (!(blend > 0)) throw new ArgumentException("blend is " + blend + ": give seconds over 0");
            _blend = blend;
        }

        /// <summary>How much of it is to be seen, from 0 to 1.</summary>
        public double Weight { get; private set; }

        /// <summary>Takes a stretch. One of another command begins anew; after a gap nothing is played.</summary>
        public void Push(PoseStreamMessage stretch)
        {
            if (stretch.CommandId != _command) Begin(stretch);
            if (_isWhole) return;
            bool isNext = stretch.FirstFrame == _frames.Count;
            if (isNext)
            {
                foreach (IReadOnlyList<Point3> frame in stretch.Positions)
                    if (frame.Count == _joints.Count) _frames.Add(frame);
            }
            _isWhole = stretch.IsLast || !isNext;
        }

        /// <summary>Fades out: its command is over or cut short.</summary>
        public void Cut()
        {
            _isEnding = true;
            _isWhole = true;
        }

        /// <summary>Lets time pass.</summary>
        /// <param name="seconds">Since the last step.</param>
        public void Step(double seconds)
        {
            if (_frames.Count == 0) return;
            double end = (_frames.Count - 1) / _rate;
            _time += seconds;
            _starved = _time > end ? _starved + seconds : 0;
            if (_starved > (_isWhole ? 0 : Patience)) Cut();
            _time = Math.Min(_time, end);
            double change = seconds / _blend;
            Weight = _isEnding ? Math.Max(0, Weight - change) : Math.Min(1, Weight + change);
            if (_isEnding && Weight == 0) _frames.Clear();
        }

        /// <summary>Where a joint is now: y up, z forward out of the agent, x to its left, in metres.</summary>
        /// <returns>False if nothing plays, or the motion has no such joint.</returns>
        public bool Joint(string name, out Point3 place)
        {
            place = default(Point3);
            int joint;
            if (_frames.Count == 0 || !_joints.TryGetValue(name, out joint)) return false;
            double at = _time * _rate;
            int before = Math.Min((int)at, _frames.Count - 1);
            Point3 a = _frames[before][joint];
            Point3 b = _frames[Math.Min(before + 1, _frames.Count - 1)][joint];
            double share = at - before;
            place = new Point3(
                a.X + share * (b.X - a.X), a.Y + share * (b.Y - a.Y), a.Z + share * (b.Z - a.Z));
            return true;
        }

        void Begin(PoseStreamMessage stretch)
        {
            _command = stretch.CommandId;
            _rate = stretch.RateHz;
            _frames.Clear();
            _joints.Clear();
            for (int i = 0; i < stretch.Joints.Count; i++) _joints[stretch.Joints[i]] = i;
            _time = _starved = 0;
            _isWhole = _isEnding = false;
        }
    }
}
