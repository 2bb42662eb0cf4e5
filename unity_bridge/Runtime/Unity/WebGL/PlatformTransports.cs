namespace AgentServer.Unity
{
    /// <summary>The sockets of the platform that runs: the browser's in a WebGL build, else .NET's.</summary>
    public sealed class PlatformTransports
    {
#if UNITY_WEBGL && !UNITY_EDITOR
        readonly WebGLTransportFactory _web = new WebGLTransportFactory(new BrowserSockets());

        /// <summary>Makes the sockets; null for .NET's.</summary>
        public ITransportFactory Factory => _web;

        /// <summary>Brings what has happened to the connections; once a frame, before they are polled.</summary>
        public void Pump() => _web.Pump();
#else
        /// <summary>Makes the sockets; null for .NET's.</summary>
        public ITransportFactory Factory => null;

        /// <summary>Brings what has happened to the connections; once a frame, before they are polled.</summary>
        public void Pump()
        {
        }
#endif
    }
}
