using NUnit.Framework;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    [TestFixture]
    public class CoordinatesTests
    {
        static readonly Vector3 Some = new Vector3(0.3f, -1.2f, 2.1f);
        static readonly Vector3 Other = new Vector3(-0.7f, 0.4f, 1.1f);

        [Test]
        public void ThePersonsRightHandIsTheAvatarsRightHand()
        {
            // Right of an avatar that looks along +z is +x.
            Assert.IsTrue(Coordinates.ToUnity(new Vector3(0.4f, 1, 2)).x > 0);
        }

        [Test]
        public void SomebodyWhoReachesForTheSensorIsAnAvatarThatReachesForwards()
        {
            Vector3 reach = new Vector3(0, 0, 1.4f) - new Vector3(0, 0, 2);
            Assert.IsTrue(Coordinates.ToUnity(reach).z > 0);
        }

        [Test]
        public void HandednessChanges()
        {
            Vector3 cross = Coordinates.ToUnity(Vector3.Cross(Some, Other));
            Vector3 crossed = Vector3.Cross(Coordinates.ToUnity(Some), Coordinates.ToUnity(Other));
            Assert.IsTrue(Near.Are(cross, -crossed));
        }

        [Test]
        public void BackIsTheInverse()
        {
            var turn = new Quaternion(0.1f, -0.5f, 0.3f, 0.8f).normalized;
            Assert.AreEqual(Some, Coordinates.ToCamera(Coordinates.ToUnity(Some)));
            Assert.AreEqual(turn, Coordinates.ToCamera(Coordinates.ToUnity(turn)));
        }

        [Test]
        public void ATurnedPointIsTheTurnOfThePoint()
        {
            var turn = new Quaternion(0.1f, -0.5f, 0.3f, 0.8f).normalized;
            Vector3 turned = Coordinates.ToUnity(turn * Some);
            Assert.IsTrue(Near.Are(turned, Coordinates.ToUnity(turn) * Coordinates.ToUnity(Some)));
        }

        [Test]
        public void APersonIsPlacedWhereTheSensorSeesThem()
        {
            Transform sensor = new GameObject("sensor").transform;
            sensor.position = new Vector3(1, 1, 1);
            // It looks along the world's x; its left is the world's z.
            sensor.rotation = Quaternion.LookRotation(Vector3.right);
            Vector3 rightHand = Coordinates.Place(sensor, new Vector3(0.4f, 0.2f, 2));
            Object.DestroyImmediate(sensor.gameObject);
            // The right hand of somebody who faces the sensor is on the sensor's left.
            Assert.IsTrue(Near.Are(new Vector3(3, 1.2f, 1.4f), rightHand), rightHand.ToString());
        }

        [Test]
        public void WhatIsPlacedIsLocated()
        {
            Transform sensor = new GameObject("sensor").transform;
            sensor.position = new Vector3(1, 2, 3);
            sensor.rotation = Quaternion.Euler(10, 200, -5);
            Vector3 located = Coordinates.Locate(sensor, Coordinates.Place(sensor, Some));
            Vector3 way = Coordinates.Place(sensor, Some) - Coordinates.Place(sensor, Other);
            Vector3 direction = Coordinates.LocateDirection(sensor, way);
            Object.DestroyImmediate(sensor.gameObject);
            Assert.IsTrue(Near.Are(Some, located));
            Assert.IsTrue(Near.Are(Some - Other, direction));
        }
    }
}
