using System.Linq;
using AgentServer.Unity.EditorTools;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class SampleRoomTests : World
    {
        GameObject _top;
        Room _room;
        AgentAnimator _agent;
        MockTransport _socket;

        [SetUp]
        public void BuildRoom()
        {
            _top = SampleRoomBuilder.Build();
            _top.GetComponent<AgentClient>().Use(Sockets, Clock);
            _room = _top.GetComponent<Room>();
            _agent = _top.GetComponentsInChildren<AgentAnimator>(true).Single();
            Lifecycle.Start();
            _socket = Greet("renderer");
        }

        [Test]
        public void NothingIsAmiss()
        {
            Assert.AreEqual(0, Debug.Lines.Count(line => !line.StartsWith("log")), string.Join("\n", Debug.Lines.ToArray()));
        }

        [Test]
        public void TheHelloTellsOfTheRoom()
        {
            Hello hello = _socket.Heard.OfType<Hello>().Single();
            Assert.AreEqual(4, hello.Objects.Count);
            Assert.AreEqual("open", hello.Objects["window"]);
            Assert.AreEqual("lit", hello.Objects["cigarette"]);
            Assert.IsTrue(hello.TakeOver);
        }

        [Test]
        public void ACommandIsCarriedOut()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            Pass(1);
            Assert.AreEqual(new[] { "accepted", "started" }, Words(_socket));
            Pass(3);
            Vector3 place = _agent.transform.position;
            Assert.IsTrue((place - new Vector3(-2.3f, 0, -0.8f)).magnitude < 0.05f, place.ToString());
            Assert.AreEqual("open", _room.Find("window").Shown);
            Pass(2);
            // Seen as closed when the step has ended; the server's word follows when all is done.
            Assert.AreEqual("closed", _room.Find("window").Shown);
            Assert.AreEqual("open", _room.Find("window").State);
            Pass(8);
            Assert.AreEqual(
                new[]
                {
                    "accepted", "started", "progress 0", "progress 1", "progress 2", "progress 3", "progress 4", "done",
                },
                Words(_socket));
            Assert.IsTrue(!_agent.IsStanding);
            Assert.IsTrue(_agent.transform.position.magnitude < 0.05f);
            Assert.AreEqual(1, _agent.GetComponent<FigureMotion>().Sitting, 1e-3);
        }

        [Test]
        public void ItTakesNoLongerThanTheServerWaits()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            // The nominal time is 8 s; after 16 s of silence the server would give up.
            Pass(13);
            Assert.AreEqual("done", Words(_socket).Last());
        }

        [Test]
        public void ANewerCommandCutsItShort()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            Pass(5.6);
            Assert.AreEqual("closed", _room.Find("window").Shown);
            _socket.Say(new CommandMessage(
                "demo/c2", 2, "e1", "greet", "hello",
                new[] { new StepMessage("stand_up", 1.2), new StepMessage("turn_to_person", 0.8) }, 20, 0, 0, 5000, "demo/c1"));
            Pass(Frame);
            // The server knows of no closed window.
            Assert.AreEqual("open", _room.Find("window").Shown);
            Vector3 place = _agent.transform.position;
            _socket.Say(Scene("attention"));
            Pass(3);
            string[] words = Words(_socket);
            Assert.AreEqual(new[] { "failed preempted", "accepted", "started" }, words.Skip(5).Take(3).ToArray());
            Assert.AreEqual("done", words.Last());
            // It stood already, and stays where it was.
            Assert.IsTrue((_agent.transform.position - place).magnitude < 1e-3f);
            Vector3 way = new Vector3(0, 0, 3.2f) - place;
            way.y = 0;
            Assert.IsTrue(Vector3.Angle(way, _agent.transform.forward) < 2);
        }

        [Test]
        public void WhoIsCutWhileStandingUpEndsWhereItIsNearer()
        {
            foreach (double seconds in new[] { 0.3, 0.9 })
            {
                BuildAnew();
                _socket.Say(CloseWindow("demo/c1", 1));
                Pass(seconds);
                _socket.Say(new CommandMessage(
                    "demo/c2", 2, "e1", "greet", "hello", new[] { new StepMessage("look_at_person", 1) }, 20, 0, 0, 5000));
                Pass(0.1);
                Assert.AreEqual(seconds > 0.6, _agent.IsStanding);
            }
        }

        [Test]
        public void AHelloTellsNothingOfAPreview()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            Pass(5.6);
            Assert.AreEqual("closed", _room.Find("window").Shown);
            _socket.End(1006);
            Pass(2);
            MockTransport next = Socket("renderer");
            next.Accept();
            Pass(Frame);
            Assert.AreEqual("open", next.Heard.OfType<Hello>().Single().Objects["window"]);
        }

        [Test]
        public void WhoWasCutShortGoesBackToWork()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            Pass(4);
            _socket.Say(new CommandMessage(
                "demo/c2", 2, "e1", "resume_work", "attention_timeout",
                new[] { new StepMessage("look_at", 0.5, "screen") }, 0, 0, 0, 5000, "demo/c1"));
            Pass(1);
            Assert.IsTrue(_agent.IsStanding);
            Pass(6);
            Assert.IsTrue(!_agent.IsStanding);
            Assert.IsTrue(_agent.transform.position.magnitude < 0.05f, _agent.transform.position.ToString());
        }

        [Test]
        public void AnUnknownObjectFailsTheCommand()
        {
            _socket.Say(new CommandMessage(
                "demo/c1", 1, "e1", "dim", "bright", new[] { new StepMessage("dim", 1, "lamp") }, 10, 0, 0, 5000));
            Pass(1);
            Assert.AreEqual("failed there is no object 'lamp' in the scene", Words(_socket).Last());
        }

        [Test]
        public void AnUnknownStepTakesItsTime()
        {
            _socket.Say(new CommandMessage(
                "demo/c1", 1, "e1", "dance", "loud", new[] { new StepMessage("dance", 1) }, 10, 0, 0, 5000));
            Pass(0.9);
            Assert.AreEqual("started", Words(_socket).Last());
            Pass(0.3);
            Assert.AreEqual("done", Words(_socket).Last());
        }

        [Test]
        public void SwitchingTheAgentOffFailsTheCommand()
        {
            _socket.Say(CloseWindow("demo/c1", 1));
            Pass(1);
            _agent.enabled = false;
            Lifecycle.Send(_agent, "OnDisable");
            Assert.AreEqual("failed the agent was switched off", Words(_socket).Last());
        }

        [Test]
        public void TheServersWordIsShown()
        {
            _socket.Say(Scene("attention", "closed"));
            Pass(Frame);
            Assert.AreEqual("closed", _room.Find("window").State);
            Assert.AreEqual("attention", _room.Mode);
        }

        [Test]
        public void AChangeByHandIsReported()
        {
            _room.Find("window").Change("closed");
            SceneEvent said = _socket.Heard.OfType<SceneEvent>().Single();
            Assert.AreEqual("window closed", said.Object + " " + said.State);
        }

        [Test]
        public void AChangeWithoutAConnectionIsInTheNextHello()
        {
            _socket.End(1006);
            Pass(Frame);
            _room.Find("window").Change("closed");
            Pass(2);
            MockTransport next = Socket("renderer");
            next.Accept();
            Pass(Frame);
            Assert.AreEqual("closed", next.Heard.OfType<Hello>().Single().Objects["window"]);
        }

        [Test]
        public void DifferencesAreSettledAsTheServerSays()
        {
            _socket.End(1006);
            Pass(2);
            Greet("renderer", Scene("working", "closed"), new Difference("window", "open", "closed", Authority.Server));
            Assert.AreEqual("closed", _room.Find("window").State);
            Assert.AreEqual(1, Logged("the server's state holds"));
        }

        [Test]
        public void AnObjectThatOneSideLacksIsSaidOnce()
        {
            var scene = new SceneState("working", new System.Collections.Generic.Dictionary<string, string>
            {
                { "window", "ajar" }, { "lamp", "bright" }, { "hifi", "high" }, { "cigarette", "lit" },
            });
            _socket.Say(scene);
            _socket.Say(scene);
            Pass(Frame);
            Assert.AreEqual(1, Logged("'window' has no state 'ajar'"));
            Assert.AreEqual(1, Logged("no object 'lamp'"));
            Assert.AreEqual(1, Logged("no states for 'curtain'"));
        }

        [Test]
        public void ThePersonIsShown()
        {
            HumanoidRetargeter person = _top.GetComponentsInChildren<HumanoidRetargeter>(true).Single();
            Transform arm = person.transform.Find("Hips/Spine/Chest/RightShoulder/RightUpperArm");
            Greet("monitor").Say(new PoseMessage(0, 1, new[]
            {
                new JointSample(0, 0.7, 2, 1), new JointSample(0, 0.45, 2, 1), new JointSample(0, 0.15, 2, 1),
                new JointSample(-0.17, 0.4, 2, 1), new JointSample(-0.17, 0.1, 2, 1), new JointSample(-0.17, -0.15, 2, 1),
                new JointSample(0.17, 0.4, 2, 1), new JointSample(0.17, 0.4, 1.7, 1), new JointSample(0.17, 0.4, 1.4, 1),
            }));
            Pass(1);
            // The right arm reaches for the sensor: forwards, for a figure that looks along z.
            Assert.IsTrue((arm.rotation * Vector3.right - Vector3.forward).magnitude < 0.01f);
        }

        void BuildAnew()
        {
            Reset();
            BuildRoom();
        }
    }
}
