using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// A way on the floor: turn to where it goes, go straight there, turn to where one looks then.
    /// </summary>
    public sealed class Walk
    {
        const float Near = 0.01f;

        readonly Vector3 _to;
        readonly Quaternion _facing;
        readonly float _metresPerSecond, _degreesPerSecond;

        /// <param name="from">Where the walker stands.</param>
        /// <param name="to">Where the walker goes; its height is kept out.</param>
        /// <param name="facing">Where the walker looks in the end.</param>
        /// <param name="metresPerSecond">Speed; more if the time is too short for it.</param>
        /// <param name="degreesPerSecond">Speed of turns.</param>
        /// <param name="seconds">Time in which the straight part is to be gone, at most.</param>
        public Walk(
            Vector3 from, Vector3 to, Quaternion facing, float metresPerSecond, float degreesPerSecond, float seconds)
        {
            Position = from;
            _to = new Vector3(to.x, from.y, to.z);
            _facing = facing;
            _degreesPerSecond = degreesPerSecond;
            float distance = (_to - from).magnitude;
            _metresPerSecond = seconds > 0 ? Mathf.Max(metresPerSecond, distance / seconds) : metresPerSecond;
        }

        /// <summary>Where the walker is.</summary>
        public Vector3 Position { get; private set; }

        /// <summary>Whether the walker takes steps now, and does not only turn.</summary>
        public bool IsStepping { get; private set; }

        /// <summary>Goes on for so many seconds.</summary>
        /// <param name="seconds">Time since the last call.</param>
        /// <param name="rotation">Of the walker, in and out.</param>
        /// <returns>Whether the walker has arrived and looks where it is to look.</returns>
        public bool Go(float seconds, ref Quaternion rotation)
        {
            Vector3 way = _to - Position;
            IsStepping = way.magnitude > Near;
            Quaternion aim = IsStepping ? Quaternion.LookRotation(way) : _facing;
            rotation = Quaternion.RotateTowards(rotation, aim, _degreesPerSecond * seconds);
            bool isAligned = Quaternion.Angle(rotation, aim) < 1;
            if (!IsStepping) return isAligned;
            if (isAligned) Position = Vector3.MoveTowards(Position, _to, _metresPerSecond * seconds);
            IsStepping = isAligned;
            return false;
        }
    }
}
