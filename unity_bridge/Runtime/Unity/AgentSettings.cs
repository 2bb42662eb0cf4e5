using System;
using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>Where the server is, and which session is meant.</summary>
    [Serializable]
    public sealed class ServerAddress
    {
        [SerializeField, Tooltip("ws://HOST:PORT, or wss://HOST for a page that was loaded by https.")]
        string _address = "ws://127.0.0.1:8765";

        [SerializeField, Tooltip("1 to 64 letters, digits, '.', '_' or '-'; the same for sensor, renderer and monitor.")]
        string _session = "demo";

        [SerializeField, Tooltip("Secret that admits the client; empty where none is needed. It is stored as it is: do not ship a build with one.")]
        string _token = "";

        [SerializeField, Tooltip("JSON can be read in a network trace; MessagePack is smaller.")]
        Coding _coding = Coding.Json;

        /// <summary>Address of the server.</summary>
        public string Address
        {
            get => _address;
            set => _address = value;
        }

        /// <summary>Name of the session.</summary>
        public string Session
        {
            get => _session;
            set => _session = value;
        }

        /// <summary>Secret that admits the client; empty where none is needed.</summary>
        public string Token
        {
            get => _token;
            set => _token = value;
        }

        /// <summary>How messages are written.</summary>
        public Coding Coding
        {
            get => _coding;
            set => _coding = value;
        }

        /// <summary>Settings of a connection in a role.</summary>
        public ConnectionSettings For(Role role) => new ConnectionSettings
        {
            Address = _address.Trim(),
            Session = _session.Trim(),
            Token = _token == "" ? null : _token,
            Coding = _coding,
            Role = role,
            ClientName = "unity",
            ClientVersion = PackageVersion.Text,
        };
    }

    /// <summary>A server's address as an asset, shared by several components and scenes.</summary>
    [CreateAssetMenu(fileName = "AgentSettings", menuName = "Agent Server/Settings")]
    public sealed class AgentSettings : ScriptableObject
    {
        [SerializeField]
        ServerAddress _server = new ServerAddress();

        /// <summary>Where the server is, and which session is meant.</summary>
        public ServerAddress Server => _server;
    }
}
