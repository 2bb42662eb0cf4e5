using System;

namespace AgentServer
{
    /// <summary>The ears of one socket: notes when something came, and decodes it on the socket's thread.</summary>
    sealed class Listener : ITransportListener
    {
        readonly Codec _codec;
        readonly IClock _clock;
        readonly Action<Heard> _tell;

        /// <param name="coding">How messages are written.</param>
        /// <param name="clock">Says when something came.</param>
        /// <param name="tell">Takes what was heard, on the socket's thread.</param>
        public Listener(Coding coding, IClock clock, Action<Heard> tell)
        {
            _codec = Codec.Of(coding);
            _clock = clock;
            _tell = tell;
        }

        public void OnOpen()
        {
            _tell(new Heard(this, HeardKind.Opened, _clock.NowNs));
        }

        public void OnText(string text)
        {
            Decode(new Frame(text));
        }

        public void OnBinary(byte[] data)
        {
            Decode(new Frame(data));
        }

        public void OnClose(int code, string reason)
        {
            _tell(new Heard(this, HeardKind.Closed, _clock.NowNs, code: code, words: reason));
        }

        void Decode(Frame frame)
        {
            long now = _clock.NowNs;
            Heard heard;
            try
            {
                heard = new Heard(this, HeardKind.Message, now, _codec.DecodeServer(frame));
            }
            catch (ProtocolException wrong)
            {
                heard = new Heard(this, HeardKind.Unreadable, now, words: wrong.Message);
            }
            _tell(heard);
        }
    }
}
