using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// The rotations of an avatar on their way to the last pose: smoothed, and a lost joint holds.
    /// </summary>
    public sealed class PoseFollower
    {
        readonly Quaternion[] _targets = AvatarBones.Rest();
        readonly Quaternion[] _rotations = AvatarBones.Rest();
        bool _isSet;

        /// <summary>Rotation of each bone relative to its parent, as shown.</summary>
        public Quaternion[] Rotations => _rotations;

        /// <summary>Aims at a pose. The first one, and one after <see cref="Forget"/>, is taken at once.</summary>
        public void Aim(PoseSolver solver, CoreJoints joints, float leastConfidence)
        {
            solver.Solve(joints, leastConfidence, _targets);
            if (_isSet) return;
            _targets.CopyTo(_rotations, 0);
            _isSet = true;
        }

        /// <summary>Back to rest; the next pose is taken at once.</summary>
        public void Forget()
        {
            _isSet = false;
            AvatarBones.Fill(_targets, Quaternion.identity);
            AvatarBones.Fill(_rotations, Quaternion.identity);
        }

        /// <summary>Goes a step of the way: the same in one step or in many.</summary>
        /// <param name="seconds">Time since the last step.</param>
        /// <param name="smoothing">Time constant in seconds; 0 follows at once.</param>
        public void Step(float seconds, float smoothing)
        {
            float share = smoothing > 0 ? 1 - Mathf.Exp(-seconds / smoothing) : 1;
            for (int i = 0; i < _rotations.Length; i++)
                _rotations[i] = Quaternion.Slerp(_rotations[i], _targets[i], share);
        }
    }
}
