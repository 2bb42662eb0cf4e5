using System.Linq;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class AgentClientTests : World
    {
        AgentClient _client;

        [SetUp]
        public void MakeClient()
        {
            _client = new GameObject("client").AddComponent<AgentClient>();
            _client.Use(Sockets, Clock);
        }

        [Test]
        public void ItConnectsAndTellsOfCommands()
        {
            string heard = "";
            _client.CommandReceived += command => heard += command.Id;
            _client.OnCommand.AddListener(command => heard += "!");
            _client.OnScene.AddListener(scene => heard += scene.Mode + " ");
            Lifecycle.Start();
            Assert.AreEqual("ws://127.0.0.1:8765/v1/sessions/demo/renderer", Sockets.Last.Url);
            MockTransport socket = Greet("renderer");
            Assert.AreEqual(Phase.Live, _client.Phase);
            socket.Say(CloseWindow("c1", 1));
            // Nothing is told outside a frame.
            Assert.AreEqual("working ", heard);
            Lifecycle.Frames(1, 0);
            Assert.AreEqual("working c1!", heard);
        }

        [Test]
        public void DisablingSaysGoodbyeAndEnablingResumes()
        {
            Lifecycle.Start();
            MockTransport first = Greet("renderer");
            first.Say(CloseWindow("c1", 1));
            Lifecycle.Frames(1, 0);
            _client.enabled = false;
            Lifecycle.Send(_client, "OnDisable");
            Assert.AreEqual(1000, first.ClosedWith);
            Assert.AreEqual(Phase.Stopped, _client.Phase);
            _client.enabled = true;
            Lifecycle.Send(_client, "OnEnable");
            Socket("renderer").Accept();
            Lifecycle.Frames(1, 0);
            Hello hello = Socket("renderer").Heard.OfType<Hello>().Single();
            Assert.AreEqual("l1", hello.Ledger);
            Assert.AreEqual(1L, hello.LastSequence);
        }

        [Test]
        public void APauseSaysGoodbyeAndComesBack()
        {
            Lifecycle.Start();
            MockTransport first = Greet("renderer");
            Lifecycle.Send("OnApplicationPause", true);
            Assert.AreEqual(1000, first.ClosedWith);
            Lifecycle.Send("OnApplicationPause", false);
            Greet("renderer");
            Assert.AreEqual(Phase.Live, _client.Phase);
        }

        [Test]
        public void TheEndSaysGoodbye()
        {
            Lifecycle.Start();
            MockTransport socket = Greet("renderer");
            Lifecycle.Send("OnApplicationQuit");
            Assert.AreEqual(1000, socket.ClosedWith);
        }

        [Test]
        public void ALostConnectionIsToldOnceWithWhatToDo()
        {
            Lifecycle.Start();
            Sockets.Last.End(1006);
            Pass(6);
            foreach (MockTransport socket in Sockets.Made.Skip(1).Where(one => one.Url != null)) socket.End(1006);
            Pass(1);
            Assert.IsTrue(Sockets.Made.Count >= 2);
            Assert.AreEqual(1, Logged("agent-server serve"), string.Join("\n", Debug.Lines.ToArray()));
        }

        [Test]
        public void ATakenPlaceIsAnErrorThatSaysWhatToDo()
        {
            Lifecycle.Start();
            MockTransport socket = Greet("renderer");
            socket.End(4409);
            Pass(20);
            Assert.AreEqual(1, Sockets.Made.Count);
            Assert.AreEqual(1, Debug.Lines.Count(line => line.StartsWith("error") && line.Contains("Take Over")));
        }

        [Test]
        public void AWrongSettingIsSaidAndCostsNothingElse()
        {
            _client.Server.Session = "no good";
            Lifecycle.Start();
            Pass(1);
            Assert.AreEqual(0, Sockets.Made.Count);
            Assert.AreEqual(1, Logged("Session: 'no good'"));
            _client.Server.Session = "good";
            _client.Connect();
            Assert.AreEqual(1, Sockets.Made.Count);
        }

        [Test]
        public void TelemetryIsASecondConnection()
        {
            _client.Telemetry = true;
            int poses = 0;
            _client.PoseReceived += pose => poses++;
            Lifecycle.Start();
            MockTransport monitor = Greet("monitor");
            Hello hello = monitor.Heard.OfType<Hello>().Single();
            Assert.AreEqual(new[] { Topic.Pose, Topic.Forecast, Topic.Decision }, hello.Topics.ToArray());
            monitor.Say(new PoseMessage(0, 1, new JointSample[9]));
            Lifecycle.Frames(1, 0);
            Assert.AreEqual(1, poses);
            Lifecycle.Send(_client, "OnDisable");
            Assert.AreEqual(1000, monitor.ClosedWith);
        }

        [Test]
        public void WhatTheServerRefusesIsSaid()
        {
            Lifecycle.Start();
            Greet("renderer").Say(new ErrorMessage("unknown_state", "window has no state ajar"));
            Lifecycle.Frames(1, 0);
            Assert.AreEqual(1, Logged("window has no state ajar"));
        }
    }
}
