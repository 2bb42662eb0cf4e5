using System;
using System.Collections.Generic;

namespace AgentServer
{
    /// <summary>Where to connect, and as what.</summary>
    public sealed class ConnectionSettings
    {
        /// <summary>Address of the server: `ws://HOST:PORT` or `wss://HOST`; `http` will do.</summary>
        public string Address { get; set; } = "ws://127.0.0.1:8765";

        /// <summary>Session: 1 to 64 letters, digits, `.`, `_` or `-`.</summary>
        public string Session { get; set; } = "demo";

        /// <summary>What to come as.</summary>
        public Role Role { get; set; } = Role.Renderer;

        /// <summary>What the client is called, for people; 1 to 64 characters.</summary>
        public string ClientName { get; set; } = "agent-server-csharp";

        /// <summary>Version of the client, for people; at most 64 characters.</summary>
        public string ClientVersion { get; set; } = "";

        /// <summary>Secret that admits the client; null where none is needed.</summary>
        public string Token { get; set; }

        /// <summary>How messages are written.</summary>
        public Coding Coding { get; set; } = Coding.Json;

        /// <summary>Whether to replace the sensor or acting renderer that is there already.</summary>
        public bool TakeOver { get; set; }

        /// <summary>Renderers: get commands, and send no acks.</summary>
        public bool Mirror { get; set; }

        /// <summary>Renderers: get motions that are made while they play.</summary>
        public bool PlaysMotion { get; set; }

        /// <summary>Sensors: what is told of the face.</summary>
        public FaceKind Face { get; set; } = FaceKind.Expected;

        /// <summary>Monitors: kinds of telemetry that are wanted; null for all.</summary>
        public IReadOnlyList<Topic> Topics { get; set; }

        /// <summary>Address of the websocket.</summary>
        public string Url
        {
            get
            {
                string address = Address.TrimEnd('/');
                if (address.StartsWith("http", StringComparison.OrdinalIgnoreCase)) address = "ws" + address.Substring(4);
                return address + "/v1/sessions/" + Session + "/" + Role.Text();
            }
        }

        /// <summary>Refuses what cannot work.</summary>
        /// <exception cref="ArgumentException">With a sentence that names the setting and the fix.</exception>
        public void Validate()
        {
            Uri uri;
            if (Address == null || !Uri.TryCreate(Address, UriKind.Absolute, out uri) || !IsWebsocket(uri))
                throw Wrong("Address", "'" + Address + "' is no address of a server: give ws://HOST:PORT or wss://HOST");
            if (Session == null || Session.Length < 1 || Session.Length > 64 || !IsSession(Session))
                throw Wrong("Session", "'" + Session + "' is no session: give 1 to 64 letters, digits, '.', '_' or '-'");
            if (string.IsNullOrEmpty(ClientName) || ClientName.Length > 64)
                throw Wrong("ClientName", "give a name of 1 to 64 characters");
            if (ClientVersion == null || ClientVersion.Length > 64)
                throw Wrong("ClientVersion", "give a version of at most 64 characters");
            if (Token != null && Token.Length > 4096)
                throw Wrong("Token", "it has " + Token.Length + " characters: give at most 4096");
            if (Mirror && Role != Role.Renderer)
                throw Wrong("Mirror", "a " + Role.Text() + " cannot be a mirror: choose the role renderer");
            if (Mirror && TakeOver)
                throw Wrong("TakeOver", "a mirror takes nobody's place: choose either Mirror or TakeOver");
            if (TakeOver && Role == Role.Monitor)
                throw Wrong("TakeOver", "a monitor takes nobody's place: leave it false");
            if (Topics != null && Role != Role.Monitor)
                throw Wrong("Topics", "a " + Role.Text() + " gets no telemetry: choose the role monitor");
            if (Face != FaceKind.Expected && Role != Role.Sensor)
                throw Wrong("Face", "a " + Role.Text() + " tells of no face: choose the role sensor");
        }

        internal ConnectionSettings Copy() => (ConnectionSettings)MemberwiseClone();

        static bool IsWebsocket(Uri uri)
        {
            bool isKnown = uri.Scheme == "ws" || uri.Scheme == "wss" || uri.Scheme == "http" || uri.Scheme == "https";
            return isKnown && uri.Host.Length != 0 && uri.PathAndQuery == "/";
        }

        static bool IsSession(string session)
        {
            foreach (char unit in session)
            {
                bool isLetter = unit >= 'a' && unit <= 'z' || unit >= 'A' && unit <= 'Z';
                bool isOther = unit >= '0' && unit <= '9' || unit == '.' || unit == '_' || unit == '-';
                if (!isLetter && !isOther) return false;
            }
            return true;
        }

        static ArgumentException Wrong(string setting, string sentence)
        {
            return new ArgumentException(setting + ": " + sentence);
        }
    }
}
