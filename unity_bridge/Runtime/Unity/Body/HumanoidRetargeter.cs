using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// Shows the person's pose, or a moment of the forecast, on a humanoid avatar.
    /// </summary>
    /// <remarks>
    /// The bones come from an <see cref="Animator"/> with a humanoid avatar, or from
    /// <see cref="SetBones"/> for a figure without one. It writes in LateUpdate, after the animator.
    /// </remarks>
    [AddComponentMenu("Agent Server/Humanoid Retargeter")]
    [DisallowMultipleComponent]
    public sealed class HumanoidRetargeter : MonoBehaviour
    {
        /// <summary>What is shown.</summary>
        public enum Show
        {
            /// <summary>The pose as it was last observed.</summary>
            Observed,

            /// <summary>One frame of the latest forecast.</summary>
            Forecast,
        }

        [SerializeField, Tooltip("Where poses come from; its telemetry must be switched on.")]
        AgentClient _client;

        [SerializeField, Tooltip("An animator with a humanoid avatar. Left empty, SetBones names the bones.")]
        Animator _animator;

        [SerializeField, Tooltip("The observed pose, or a frame of the forecast.")]
        Show _show = Show.Observed;

        [SerializeField, Range(0, 49), Tooltip("Frame of the forecast; each is 40 ms further ahead.")]
        int _forecastFrame = 12;

        [SerializeField, Tooltip("Show it as a mirror in front of the person does.")]
        bool _mirror;

        [SerializeField, Range(0, 1), Tooltip("Time constant of the smoothing in seconds; 0 is none.")]
        float _smoothing = 0.08f;

        [SerializeField, Range(0, 1), Tooltip("A joint below this confidence is lost: its bones hold.")]
        float _leastConfidence = 0.3f;

        [SerializeField, Tooltip("Root of a figure without a humanoid avatar, facing +z at rest.")]
        Transform _figure;

        [SerializeField, Tooltip("Its bones in the order of AvatarBone, as they stand at rest; none where it has none.")]
        Transform[] _figureBones = new Transform[0];

        readonly CoreJoints _joints = new CoreJoints();
        readonly PoseFollower _follower = new PoseFollower();
        readonly Quaternion[] _turns = AvatarBones.Rest();
        Transform _root;
        Transform[] _bones;
        BindPose _bind;

        /// <summary>Where poses come from; set it before the component is enabled.</summary>
        public AgentClient Client
        {
            get => _client;
            set => _client = value;
        }

        /// <summary>Whether a pose has come.</summary>
        public bool IsShowing { get; private set; }

        /// <summary>Names the bones of a figure that has no humanoid avatar, as they stand at rest.</summary>
        /// <param name="figure">The figure's root, which faces +z at rest.</param>
        /// <param name="bones">One a bone of <see cref="AvatarBone"/>; null where there is none.</param>
        public void SetBones(Transform figure, Transform[] bones)
        {
            _figure = figure;
            _figureBones = bones;
            TakeFigure();
        }

        /// <summary>Aims at an observed pose; the client calls it by itself.</summary>
        public void Take(PoseMessage pose)
        {
            if (_show == Show.Observed && _joints.Take(pose)) Aim();
        }

        /// <summary>Aims at a frame of a forecast; the client calls it by itself.</summary>
        public void Take(ForecastMessage forecast)
        {
            if (_show == Show.Forecast && _joints.Take(forecast, _forecastFrame)) Aim();
        }

        void Awake()
        {
            if (_figure != null && _figureBones.Length == AvatarBones.Count)
            {
                TakeFigure();
                return;
            }
            if (_animator == null) _animator = GetComponent<Animator>();
            if (_animator != null) TakeBonesOf(_animator);
        }

        void OnEnable()
        {
            if (_client == null) return;
            _client.PoseReceived += Take;
            _client.ForecastReceived += Take;
        }

        void OnDisable()
        {
            _follower.Forget();
            IsShowing = false;
            if (_client == null) return;
            _client.PoseReceived -= Take;
            _client.ForecastReceived -= Take;
        }

        // After the animator, whose pose is replaced.
        void LateUpdate()
        {
            if (!IsShowing) return;
            _follower.Step(Time.deltaTime, _smoothing);
            for (int i = 0; i < AvatarBones.Count; i++)
            {
                int parent = AvatarBones.ParentOf(i);
                Quaternion before = parent < 0 ? Quaternion.identity : _turns[parent];
                _turns[i] = before * _follower.Rotations[i];
                if (_bones[i] != null) _bones[i].rotation = _bind.World(i, _root.rotation, _turns[i]);
            }
        }

        void Aim()
        {
            if (_bind == null) return;
            if (_mirror) _joints.Mirror();
            _follower.Aim(_bind.Solver, _joints, _leastConfidence);
            IsShowing = true;
        }

        void TakeFigure()
        {
            _root = _figure;
            _bones = _figureBones;
            _bind = BindPose.Of(_root, _bones, null);
        }

        void TakeBonesOf(Animator animator)
        {
            if (animator.avatar == null || !animator.avatar.isValid || !animator.avatar.isHuman)
            {
                Debug.LogError(
                    "The animator of '" + name + "' has no humanoid avatar: set Rig > Animation Type of its model "
                    + "to Humanoid, or call SetBones.", this);
                return;
            }
            _root = animator.transform;
            _bones = new Transform[AvatarBones.Count];
            for (int i = 0; i < _bones.Length; i++)
                _bones[i] = animator.GetBoneTransform(AvatarBones.Human(i));
            _bind = BindPose.Of(_root, _bones, animator.avatar.humanDescription.skeleton);
        }
    }
}
