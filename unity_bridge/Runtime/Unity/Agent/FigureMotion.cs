using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// Moves a figure of a few jointed parts without any animation: enough to see what a command does.
    /// </summary>
    [AddComponentMenu("Agent Server/Figure Motion")]
    public sealed class FigureMotion : MonoBehaviour, IAgentMotion
    {
        const float SitDegrees = 90, ReachDegrees = 80, TypeDegrees = 50, SwingDegrees = 30;
        const float StepsPerSecond = 1.8f, HeadLimit = 70, HeadSeconds = 0.2f, LimbSeconds = 0.15f;

        [SerializeField, Tooltip("Carries everything else; its height changes when the figure sits down.")]
        Transform _hips;

        [SerializeField]
        Transform _head;

        [SerializeField, Tooltip("Hangs down at rest and turns about its upper end.")]
        Transform _leftArm;

        [SerializeField, Tooltip("Hangs down at rest and turns about its upper end.")]
        Transform _rightArm;

        [SerializeField, Tooltip("Hangs down at rest, turns about its upper end, and has the shin as a child.")]
        Transform _leftThigh;

        [SerializeField, Tooltip("Hangs down at rest, turns about its upper end, and has the shin as a child.")]
        Transform _rightThigh;

        [SerializeField]
        Transform _leftShin;

        [SerializeField]
        Transform _rightShin;

        [SerializeField, Min(0), Tooltip("Height of the hips above the figure's root when it stands, in metres.")]
        float _standHeight = 0.9f;

        [SerializeField, Min(0), Tooltip("Height of the hips above the figure's root when it sits, in metres.")]
        float _sitHeight = 0.5f;

        string _action = "";
        float _seconds, _elapsed, _sit, _sitFrom, _sitTo;
        float _leftReach, _rightReach, _stride;
        Vector3? _gaze;

        /// <summary>Names the parts, for figures that are built by a program.</summary>
        public void Assemble(
            Transform hips, Transform head, Transform leftArm, Transform rightArm,
            Transform leftThigh, Transform rightThigh, Transform leftShin, Transform rightShin)
        {
            _hips = hips;
            _head = head;
            _leftArm = leftArm;
            _rightArm = rightArm;
            _leftThigh = leftThigh;
            _rightThigh = rightThigh;
            _leftShin = leftShin;
            _rightShin = rightShin;
        }

        /// <summary>How far it sits: 0 stands, 1 sits.</summary>
        public float Sitting => _sit;

        /// <inheritdoc/>
        public void Play(StepMessage step, StepMapping mapping)
        {
            _action = step.Action;
            _seconds = Mathf.Max((float)step.DurationS, 0.01f);
            _elapsed = 0;
            if (_action == "stand_up") Aim(0);
            if (_action == "sit_down") Aim(1);
        }

        /// <inheritdoc/>
        public void Rest(bool isStanding)
        {
            _action = "";
            _seconds = 0.3f;
            _elapsed = 0;
            Aim(isStanding ? 0 : 1);
        }

        /// <inheritdoc/>
        public void LookAt(Vector3? point) => _gaze = point;

        void Update()
        {
            _elapsed += Time.deltaTime;
            _sit = _sitFrom + (_sitTo - _sitFrom) * Mathf.Clamp01(_elapsed / _seconds);
            _stride = Follow(_stride, _action == "walk_to" ? SwingDegrees : 0);
            float swing = _stride * Mathf.Sin(_elapsed * StepsPerSecond * Mathf.PI);
            MoveArms(swing);
            MoveLegs(swing);
            TurnHead();
        }

        void Aim(float sit)
        {
            _sitFrom = _sit;
            _sitTo = sit;
        }

        void MoveArms(float swing)
        {
            float left = 0, right = 0;
            if (_action == "type_on") left = right = TypeDegrees + 4 * Mathf.Sin(_elapsed * 20);
            else if (IsReaching()) right = ReachDegrees * Mathf.Sin(Mathf.PI * Mathf.Clamp01(_elapsed / _seconds));
            _leftReach = Follow(_leftReach, left);
            _rightReach = Follow(_rightReach, right);
            // A limb that hangs along -y comes forwards by turning about -x.
            Turn(_leftArm, _leftReach - swing);
            Turn(_rightArm, _rightReach + swing);
        }

        void MoveLegs(float swing)
        {
            float fold = SitDegrees * _sit;
            Turn(_leftThigh, fold + swing);
            Turn(_rightThigh, fold - swing);
            Turn(_leftShin, -fold);
            Turn(_rightShin, -fold);
            Vector3 place = _hips.localPosition;
            place.y = _standHeight + (_sitHeight - _standHeight) * _sit;
            _hips.localPosition = place;
        }

        void TurnHead()
        {
            Quaternion aim = Quaternion.identity;
            if (_gaze != null)
            {
                Vector3 way = Quaternion.Inverse(transform.rotation) * (_gaze.Value - _head.position);
                aim = Quaternion.RotateTowards(
                    Quaternion.identity, Quaternion.FromToRotation(Vector3.forward, way), HeadLimit);
            }
            float share = 1 - Mathf.Exp(-Time.deltaTime / HeadSeconds);
            _head.localRotation = Quaternion.Slerp(_head.localRotation, aim, share);
        }

        bool IsReaching() =>
            _action == "open" || _action == "close" || _action == "turn_down" || _action == "put_out";

        static float Follow(float value, float aim) =>
            value + (aim - value) * (1 - Mathf.Exp(-Time.deltaTime / LimbSeconds));

        static void Turn(Transform limb, float degrees) =>
            limb.localRotation = Quaternion.AngleAxis(-degrees, Vector3.right);
    }
}
