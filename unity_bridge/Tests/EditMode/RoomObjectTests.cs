using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class RoomObjectTests
    {
        GameObject _thing, _openLook, _closedLook;
        RoomObject _window;

        [SetUp]
        public void MakeWindow()
        {
            _thing = new GameObject("window");
            _openLook = new GameObject("open look");
            _closedLook = new GameObject("closed look");
            _openLook.transform.SetParent(_thing.transform, false);
            _closedLook.transform.SetParent(_thing.transform, false);
            _window = _thing.AddComponent<RoomObject>();
            _window.Describe(
                "window", null, "open", new ObjectState("open", _openLook), new ObjectState("closed", _closedLook));
        }

        [TearDown]
        public void DestroyWindow() => Object.DestroyImmediate(_thing);

        [Test]
        public void OnlyTheLooksOfItsStateAreSeen()
        {
            Assert.IsTrue(_openLook.activeSelf && !_closedLook.activeSelf);
            Assert.IsTrue(_window.Apply("closed"));
            Assert.IsTrue(!_openLook.activeSelf && _closedLook.activeSelf);
            Assert.AreEqual("closed", _window.State);
        }

        [Test]
        public void AStateThatItHasNotChangesNothing()
        {
            Assert.IsTrue(!_window.Apply("ajar"));
            Assert.IsTrue(!_window.Preview("ajar"));
            Assert.IsTrue(!_window.Change("ajar"));
            Assert.AreEqual("open", _window.State);
            Assert.IsTrue(_openLook.activeSelf);
        }

        [Test]
        public void AChangeByHandIsTold()
        {
            var told = new List<string>();
            _window.ChangedByHand += (thing, state) => told.Add(thing.ObjectName + " " + state);
            Assert.IsTrue(_window.Change("closed"));
            Assert.IsTrue(!_window.Change("closed"));
            _window.ChangeToNext();
            Assert.AreEqual(new[] { "window closed", "window open" }, told.ToArray());
        }

        [Test]
        public void WhatTheServerSaysIsNotTold()
        {
            int told = 0;
            _window.ChangedByHand += (thing, state) => told++;
            _window.Apply("closed");
            Assert.AreEqual(0, told);
        }

        [Test]
        public void APreviewIsSeenAndTheStateStays()
        {
            _window.Preview("closed");
            Assert.AreEqual("open", _window.State);
            Assert.AreEqual("closed", _window.Shown);
            Assert.IsTrue(_closedLook.activeSelf);
            _window.EndPreview();
            Assert.IsTrue(_openLook.activeSelf && !_closedLook.activeSelf);
        }

        [Test]
        public void AStateTellsWhenItIsShown()
        {
            int shown = 0;
            var state = new ObjectState("low");
            state.OnShown.AddListener(() => shown++);
            _window.Describe("hifi", null, "high", new ObjectState("high"), state);
            _window.Apply("low");
            _window.Apply("low");
            Assert.AreEqual(1, shown);
        }

        [Test]
        public void SceneryHasNoState()
        {
            _window.Describe("desk", null, "");
            Assert.IsTrue(!_window.HasStates);
            Assert.AreEqual("", _window.State);
            _window.ChangeToNext();
            Assert.IsTrue(!_window.Apply("open"));
        }
    }
}
