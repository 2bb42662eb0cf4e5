using System;
using System.Collections.Generic;
using System.IO;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Plays bodies from a file of JSON lines, for work without a sensor.</summary>
    [AddComponentMenu("Agent Server/Recorded Skeleton Source")]
    public sealed class RecordedSkeletonSource : MonoBehaviour, ISkeletonSource
    {
        [SerializeField, Tooltip("The recording as an asset (rename it to .txt); or give a path.")]
        TextAsset _recording;

        [SerializeField, Tooltip("A file: absolute, or below StreamingAssets. Used if no asset is given.")]
        string _path = "";

        [SerializeField, Tooltip("Begin anew at the end.")]
        bool _loop = true;

        [SerializeField, Range(0.1f, 4), Tooltip("1 is real time. The stamps stay those of the recording.")]
        float _speed = 1;

        SkeletonPlayer _player;

        /// <summary>Whether everything was played, or nothing could be.</summary>
        public bool IsOver => _player == null || _player.IsOver;

        /// <summary>Plays a recording from its start.</summary>
        public void Play(SkeletonRecording recording) => _player = new SkeletonPlayer(recording, _loop);

        /// <inheritdoc/>
        public void Collect(List<SkeletonSample> samples)
        {
            if (_player != null) _player.Advance(Time.deltaTime * _speed, samples);
        }

        void OnEnable()
        {
            if (_recording == null && _path == "") return;
            try
            {
                Play(_recording != null
                    ? SkeletonRecording.Parse(_recording.text, _recording.name)
                    : SkeletonRecording.Parse(File.ReadAllText(FullPath()), _path));
            }
            catch (Exception wrong) when (wrong is FormatException || wrong is IOException || wrong is UnauthorizedAccessException)
            {
                _player = null;
                Debug.LogError("The recording of '" + name + "' cannot be played. " + wrong.Message, this);
            }
        }

        string FullPath() => Path.Combine(Application.streamingAssetsPath, _path);
    }
}
