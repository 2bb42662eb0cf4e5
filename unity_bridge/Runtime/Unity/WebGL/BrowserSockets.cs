#if UNITY_WEBGL && !UNITY_EDITOR
using System.Runtime.InteropServices;

namespace AgentServer.Unity
{
    /// <summary>The functions of AgentServerSockets.jslib.</summary>
    sealed class BrowserSockets : IBrowserSockets
    {
        // An array of length 0 has no address.
        readonly byte[] _spare = new byte[1];

        public int Open(string url, string subprotocol) => AgentServerOpen(url, subprotocol);

        public BrowserEvent Next(int id) => (BrowserEvent)AgentServerNext(id);

        public int Size(int id) => AgentServerSize(id);

        public int Code(int id) => AgentServerCode(id);

        public void Take(int id, byte[] buffer) => AgentServerTake(id, buffer.Length > 0 ? buffer : _spare);

        public void Send(int id, byte[] data, int length, bool isText) =>
            AgentServerSend(id, length > 0 ? data : _spare, length, isText ? 1 : 0);

        public int Waiting(int id) => AgentServerWaiting(id);

        public void Close(int id, int code, string reason) => AgentServerClose(id, code, reason);

        public void Free(int id) => AgentServerFree(id);

        [DllImport("__Internal")]
        static extern int AgentServerOpen(string url, string subprotocol);

        [DllImport("__Internal")]
        static extern int AgentServerNext(int id);

        [DllImport("__Internal")]
        static extern int AgentServerSize(int id);

        [DllImport("__Internal")]
        static extern int AgentServerCode(int id);

        [DllImport("__Internal")]
        static extern void AgentServerTake(int id, byte[] buffer);

        [DllImport("__Internal")]
        static extern void AgentServerSend(int id, byte[] buffer, int length, int isText);

        [DllImport("__Internal")]
        static extern int AgentServerWaiting(int id);

        [DllImport("__Internal")]
        static extern void AgentServerClose(int id, int code, string reason);

        [DllImport("__Internal")]
        static extern void AgentServerFree(int id);
    }
}
#endif
