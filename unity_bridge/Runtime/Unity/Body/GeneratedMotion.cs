using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// Plays motions that the server makes while they play, on the upper body of the agent.
    /// </summary>
    /// <remarks>
    /// The client's `Plays Motion` must be on. Spine, neck and arms are turned in LateUpdate, after the
    /// animator, whose pose shows below the hips, before and after the motion, and where none comes.
    /// </remarks>
    [AddComponentMenu("Agent Server/Generated Motion")]
    [DisallowMultipleComponent]
    public sealed class GeneratedMotion : MonoBehaviour
    {
        [SerializeField, Tooltip("Where motions come from; its Plays Motion must be on.")]
        AgentClient _client;

        [SerializeField, Tooltip("The agent, with a humanoid avatar.")]
        Animator _animator;

        readonly PoseStreamPlayer _player = new PoseStreamPlayer();
        readonly CoreJoints _joints = new CoreJoints();
        readonly Quaternion[] _rotations = AvatarBones.Rest();
        readonly Quaternion[] _turns = AvatarBones.Rest();
        Transform _root;
        Transform[] _bones;
        BindPose _bind;

        /// <summary>Where motions come from; set it before the component is enabled.</summary>
        public AgentClient Client
        {
            get => _client;
            set => _client = value;
        }

        /// <summary>How much of a motion is to be seen, from 0 to 1.</summary>
        public float Weight => (float)_player.Weight;

        /// <summary>Names the bones of a figure that has no humanoid avatar, as they stand at rest.</summary>
        /// <param name="figure">The figure's root, which faces +z at rest.</param>
        /// <param name="bones">One a bone of <see cref="AvatarBone"/>; null where there is none.</param>
        public void SetBones(Transform figure, Transform[] bones)
        {
            _root = figure;
            _bones = bones;
            _bind = BindPose.Of(_root, _bones, null);
        }

        /// <summary>Takes a stretch; the client calls it by itself.</summary>
        public void Take(PoseStreamMessage stretch) => _player.Push(stretch);

        void Awake()
        {
            if (_bind != null || _animator == null) return;
            _root = _animator.transform;
            _bones = new Transform[AvatarBones.Count];
            for (int i = 0; i < _bones.Length; i++)
                _bones[i] = _animator.GetBoneTransform(AvatarBones.Human(i));
            _bind = BindPose.Of(_root, _bones, _animator.avatar.humanDescription.skeleton);
        }

        void OnEnable()
        {
            if (_client == null) return;
            _client.MotionReceived += Take;
            _client.CommandCancelled += Cut;
        }

        void OnDisable()
        {
            _player.Cut();
            if (_client == null) return;
            _client.MotionReceived -= Take;
            _client.CommandCancelled -= Cut;
        }

        void Cut(CommandMessage command, string reason) => _player.Cut();

        // After the animator, whose pose it blends with.
        void LateUpdate()
        {
            _player.Step(Time.deltaTime);
            if (_bind == null || !_joints.Take(_player)) return;
            _bind.Solver.Solve(_joints, 0, _rotations);
            for (int i = 0; i < AvatarBones.Count; i++)
            {
                int parent = AvatarBones.ParentOf(i);
                Quaternion before = parent < 0 ? Quaternion.identity : _turns[parent];
                _turns[i] = before * _rotations[i];
            }
            // The hips are the animator's: a motion that is made for somebody who stands may be seated.
            for (int i = (int)AvatarBone.Hips + 1; i < AvatarBones.Count; i++)
            {
                if (_bones[i] == null) continue;
                Quaternion wanted = _bind.World(i, _root.rotation, _turns[i]);
                _bones[i].rotation = Quaternion.Slerp(_bones[i].rotation, wanted, Weight);
            }
        }
    }
}
