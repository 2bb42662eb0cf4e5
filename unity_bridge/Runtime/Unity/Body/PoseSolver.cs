using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// From nine joints to the rotations of a humanoid avatar's bones, relative to its T-pose.
    /// </summary>
    /// <remarks>
    /// <para>At rest the avatar faces +z, its right hand at +x, and every bone has the identity
    /// rotation. A rotation is relative to the parent bone.</para>
    /// <para>What nine joints leave open is settled thus. The hips turn about the vertical alone, so
    /// that legs that nobody sees stay upright; spine and chest share the rest of the trunk's lean and
    /// twist evenly. The neck points to the head by the smallest rotation. Shoulders stay at rest. The
    /// elbow is a hinge: an upper arm is twisted about itself so that the forearm bends towards its own
    /// z axis, as in a T-pose with the palms down; the straighter the arm, the less its bend
    /// counts.</para>
    /// <para>The server's VMC output follows the same rules (agent_server/skeleton/humanoid.py).</para>
    /// </remarks>
    public sealed class PoseSolver
    {
        /// <summary>Joints nearer than this, in metres, give no direction.</summary>
        const float Tiny = 1e-3f;

        /// <summary>Sine of the bend at which the hinge and the smallest rotation count the same.</summary>
        const float Straight = 0.2f;

        readonly Vector3 _leftArm, _leftFront, _rightArm, _rightFront;

        /// <summary>For an avatar whose rest is a T-pose.</summary>
        public PoseSolver() : this(Vector3.left, Vector3.right)
        {
        }

        /// <summary>For an avatar whose arms hang otherwise at rest, for example in an A-pose.</summary>
        /// <param name="leftArm">Direction from the left shoulder to the left wrist at rest.</param>
        /// <param name="rightArm">Direction from the right shoulder to the right wrist at rest.</param>
        public PoseSolver(Vector3 leftArm, Vector3 rightArm)
        {
            _leftArm = leftArm.normalized;
            _rightArm = rightArm.normalized;
            _leftFront = Front(_leftArm);
            _rightFront = Front(_rightArm);
        }

        /// <summary>Turns the bones so that the avatar's joints lie as the person's do.</summary>
        /// <param name="joints">The person, in Unity's axes.</param>
        /// <param name="leastConfidence">A joint below this counts as lost.</param>
        /// <param name="rotations">
        /// The rotation of each bone, in and out. A bone whose joints are lost, coincide or are not
        /// finite keeps the one that it has.
        /// </param>
        public void Solve(CoreJoints joints, float leastConfidence, Quaternion[] rotations)
        {
            TurnTrunk(joints, leastConfidence, rotations);
            Quaternion toChest = Quaternion.Inverse(
                rotations[(int)AvatarBone.Hips]
                * rotations[(int)AvatarBone.Spine]
                * rotations[(int)AvatarBone.Chest]);
            Vector3 head, arm, forearm;
            if (Way(joints, leastConfidence, CoreJoint.Neck, CoreJoint.Head, out head))
                rotations[(int)AvatarBone.Neck] = Swing(Vector3.up, toChest * head, Vector3.right);
            for (int side = 0; side < 2; side++)
            {
                Vector3 rest = side == 0 ? _leftArm : _rightArm;
                Vector3 front = side == 0 ? _leftFront : _rightFront;
                CoreJoint shoulder = side == 0 ? CoreJoint.LeftShoulder : CoreJoint.RightShoulder;
                int upper = (int)(side == 0 ? AvatarBone.LeftUpperArm : AvatarBone.RightUpperArm);
                bool hasArm = Way(joints, leastConfidence, shoulder, shoulder + 1, out arm);
                bool hasForearm = Way(joints, leastConfidence, shoulder + 1, shoulder + 2, out forearm);
                arm = toChest * arm;
                forearm = toChest * forearm;
                if (hasArm) rotations[upper] = TurnUpperArm(rest, front, arm, hasForearm, forearm);
                if (hasForearm)
                {
                    Vector3 inArm = Quaternion.Inverse(rotations[upper]) * forearm;
                    rotations[upper + 1] = Swing(rest, inArm, Vector3.up);
                }
            }
        }

        static void TurnTrunk(CoreJoints joints, float least, Quaternion[] rotations)
        {
            Vector3 up, across, right;
            if (!Way(joints, least, CoreJoint.Navel, CoreJoint.Neck, out up)) return;
            if (!Way(joints, least, CoreJoint.LeftShoulder, CoreJoint.RightShoulder, out across)) return;
            if (!Unit(across - Vector3.Dot(across, up) * up, out right)) return;
            Quaternion raised = Swing(Vector3.up, up, Vector3.right);
            Quaternion trunk = Swing(raised * Vector3.right, right, up) * raised;
            // The part of a rotation that turns about y; upside down there is none.
            float size = Mathf.Sqrt(trunk.y * trunk.y + trunk.w * trunk.w);
            if (size > Tiny)
                rotations[(int)AvatarBone.Hips] = new Quaternion(0, trunk.y / size, 0, trunk.w / size);
            Quaternion bend = Quaternion.Inverse(rotations[(int)AvatarBone.Hips]) * trunk;
            float sign = bend.w >= 0 ? 1 : -1;
            Quaternion half = new Quaternion(
                sign * bend.x, sign * bend.y, sign * bend.z, sign * bend.w + 1).normalized;
            rotations[(int)AvatarBone.Spine] = half;
            rotations[(int)AvatarBone.Chest] = half;
        }

        static Quaternion TurnUpperArm(
            Vector3 rest, Vector3 front, Vector3 arm, bool hasForearm, Vector3 forearm)
        {
            Quaternion turn = Swing(rest, arm, Vector3.up);
            if (!hasForearm) return turn;
            front = turn * front;
            Vector3 hinge;
            Vector3 bend = forearm - Vector3.Dot(forearm, arm) * arm;
            return Unit(bend + Straight * front, out hinge) ? Swing(front, hinge, arm) * turn : turn;
        }

        /// <summary>Where a forearm bends to at rest: forwards, at a right angle to the arm.</summary>
        static Vector3 Front(Vector3 arm) =>
            (Vector3.forward - Vector3.Dot(Vector3.forward, arm) * arm).normalized;

        /// <summary>The direction from one joint to another, if both are seen and apart.</summary>
        static bool Way(
            CoreJoints joints, float least, CoreJoint from, CoreJoint to, out Vector3 direction)
        {
            direction = Vector3.zero;
            return joints.Confidence[(int)from] >= least
                && joints.Confidence[(int)to] >= least
                && Unit(joints.Positions[(int)to] - joints.Positions[(int)from], out direction);
        }

        static bool Unit(Vector3 vector, out Vector3 direction)
        {
            float length = vector.magnitude;
            bool isOne = length > Tiny && length < float.PositiveInfinity;
            direction = isOne ? vector / length : Vector3.zero;
            return isOne;
        }

        /// <summary>The smallest rotation between unit directions; about spare if opposite.</summary>
        static Quaternion Swing(Vector3 start, Vector3 end, Vector3 spare)
        {
            Vector3 axis = Vector3.Cross(start, end);
            float w = 1 + Vector3.Dot(start, end);
            float size = Mathf.Sqrt(axis.sqrMagnitude + w * w);
            return size > 1e-6f
                ? new Quaternion(axis.x / size, axis.y / size, axis.z / size, w / size)
                : new Quaternion(spare.x, spare.y, spare.z, 0);
        }
    }
}
