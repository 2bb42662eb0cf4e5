using System.Collections.Generic;
using System.Text;
using NUnit.Framework;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class WebGLTransportTests
    {
        FakeSockets _sockets;
        WebGLTransportFactory _factory;
        Listener _listener;
        ITransport _transport;

        [SetUp]
        public void OpenSocket()
        {
            _sockets = new FakeSockets();
            _factory = new WebGLTransportFactory(_sockets);
            _listener = new Listener();
            _transport = _factory.Create();
            _transport.Open("ws://host/", "agent-server.v1.json", _listener);
        }

        [Test]
        public void EventsComeInOrderWhenItIsPumped()
        {
            _sockets.Happen(BrowserEvent.Open, new byte[0]);
            _sockets.Happen(BrowserEvent.Text, Encoding.UTF8.GetBytes("grüße"));
            _sockets.Happen(BrowserEvent.Binary, new byte[] { 1, 2 });
            Assert.AreEqual(0, _listener.Said.Count);
            _factory.Pump();
            Assert.AreEqual(new[] { "open", "text grüße", "binary 2" }, _listener.Said.ToArray());
        }

        [Test]
        public void TheEndHasItsCodeAndFreesTheSocket()
        {
            _sockets.Happen(BrowserEvent.Close, Encoding.UTF8.GetBytes("taken"), 4409);
            _sockets.Happen(BrowserEvent.Text, Encoding.UTF8.GetBytes("late"));
            _factory.Pump();
            _factory.Pump();
            Assert.AreEqual(new[] { "close 4409 taken" }, _listener.Said.ToArray());
            Assert.AreEqual(new[] { "open 1 ws://host/ agent-server.v1.json", "free 1" }, _sockets.Said.ToArray());
        }

        [Test]
        public void TextAndBinaryAreSent()
        {
            _transport.SendText("grüße");
            _transport.SendBinary(new byte[] { 9 });
            Assert.AreEqual("send 7 text", _sockets.Said[1]);
            Assert.AreEqual("send 1 binary", _sockets.Said[2]);
        }

        [Test]
        public void WaitingCountsMessagesThatHaveNotLeft()
        {
            _sockets.Left = 15;
            _transport.SendBinary(new byte[10]);
            _sockets.Left = 10;
            _transport.SendBinary(new byte[10]);
            _sockets.Left = 20;
            Assert.AreEqual(2, _transport.Waiting);
            _sockets.Left = 10;
            Assert.AreEqual(1, _transport.Waiting);
            _sockets.Left = 0;
            Assert.AreEqual(0, _transport.Waiting);
        }

        [Test]
        public void ItIsClosedOnceAndSendsNothingThen()
        {
            _transport.Close(1000, "goodbye");
            _transport.Close(1000, "goodbye");
            _transport.SendText("late");
            Assert.AreEqual(2, _sockets.Said.Count);
            Assert.AreEqual("close 1000 goodbye", _sockets.Said[1]);
            Assert.IsTrue(_transport.WaitClosed(0));
        }

        [Test]
        public void AnotherSocketHasItsOwnEvents()
        {
            var second = new Listener();
            _factory.Create().Open("ws://other/", "x", second);
            _sockets.Happen(BrowserEvent.Open, new byte[0], 0, 2);
            _factory.Pump();
            Assert.AreEqual(0, _listener.Said.Count);
            Assert.AreEqual(new[] { "open" }, second.Said.ToArray());
        }

        sealed class Listener : ITransportListener
        {
            public readonly List<string> Said = new List<string>();

            public void OnOpen() => Said.Add("open");

            public void OnText(string text) => Said.Add("text " + text);

            public void OnBinary(byte[] data) => Said.Add("binary " + data.Length);

            public void OnClose(int code, string reason) => Said.Add("close " + code + " " + reason);
        }

        sealed class FakeSockets : IBrowserSockets
        {
            public readonly List<string> Said = new List<string>();
            public int Left;
            readonly List<Event> _events = new List<Event>();
            int _last;

            public void Happen(BrowserEvent kind, byte[] bytes, int code = 0, int id = 1) =>
                _events.Add(new Event { Id = id, Kind = kind, Bytes = bytes, Code = code });

            public int Open(string url, string subprotocol)
            {
                _last++;
                Said.Add("open " + _last + " " + url + " " + subprotocol);
                return _last;
            }

            public BrowserEvent Next(int id) => First(id).Kind;

            public int Size(int id) => First(id).Bytes.Length;

            public int Code(int id) => First(id).Code;

            public void Take(int id, byte[] buffer)
            {
                Event first = First(id);
                first.Bytes.CopyTo(buffer, 0);
                _events.Remove(first);
            }

            public void Send(int id, byte[] data, int length, bool isText) =>
                Said.Add("send " + length + (isText ? " text" : " binary"));

            public int Waiting(int id) => Left;

            public void Close(int id, int code, string reason) => Said.Add("close " + code + " " + reason);

            public void Free(int id) => Said.Add("free " + id);

            Event First(int id) => _events.Find(one => one.Id == id) ?? new Event { Bytes = new byte[0] };

            sealed class Event
            {
                public int Id;
                public BrowserEvent Kind;
                public byte[] Bytes;
                public int Code;
            }
        }
    }
}
