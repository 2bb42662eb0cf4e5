using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>Makes the first message of every connection.</summary>
    sealed class HelloSource
    {
        static readonly string[] OthersCapabilities = { "heartbeat" };
        static readonly string[] RendererCapabilities = { "heartbeat", "resume", "progress" };
        static readonly string[] PlayerCapabilities = { "heartbeat", "resume", "progress", "pose_stream" };

        readonly ConnectionSettings _settings;
        readonly string _instance = Guid.NewGuid().ToString("N");

        string[] Capabilities
        {
            get
            {
                if (_settings.Role != Role.Renderer) return OthersCapabilities;
                return _settings.PlaysMotion ? PlayerCapabilities : RendererCapabilities;
            }
        }

        public HelloSource(ConnectionSettings settings)
        {
            _settings = settings;
        }

        /// <param name="last">The last welcome; null before the first.</param>
        /// <param name="resume">What a renderer adds; null for other roles.</param>
        public Hello Make(Welcome last, Func<ResumeState> resume)
        {
            ResumeState state = resume == null ? null : resume();
            return new Hello(
                ProtocolVersion.Protocol,
                _settings.ClientName,
                _settings.ClientVersion,
                instance: _instance,
                token: _settings.Token,
                session: _settings.Session,
                role: _settings.Role,
                capabilities: Capabilities,
                face: _settings.Face,
                mirror: _settings.Mirror,
                takeOver: _settings.TakeOver,
                topics: _settings.Topics,
                lastEpoch: last == null ? null : last.Epoch,
                ledger: state == null ? null : state.Ledger,
                lastSequence: state == null ? null : state.LastSequence,
                objects: state == null ? null : state.Objects);
        }
    }
}
