using System.Collections.Generic;
using UnityEngine;

namespace AgentServer.Unity.Tests
{
    /// <summary>Chance that falls as it is told.</summary>
    sealed class FixedRandom : IRandom
    {
        public double Unit;

        public double NextUnit() => Unit;
    }

    /// <summary>Plays each step for its time, and writes down what it does.</summary>
    sealed class FakeBody : IStepBody
    {
        public readonly List<string> Said = new List<string>();
        public string Problem;
        double _left;
        StepMessage _step;

        public bool IsStanding { get; set; }

        public string Begin(StepMessage step)
        {
            if (Problem != null) return Problem;
            _step = step;
            _left = step.DurationS;
            Said.Add(step.Target == null ? step.Action : step.Action + " " + step.Target);
            return null;
        }

        public bool Play(float seconds)
        {
            _left -= seconds;
            if (_left > 1e-6) return false;
            if (_step.Action == "stand_up") IsStanding = true;
            if (_step.Action == "sit_down") IsStanding = false;
            return true;
        }

        public void Cut() => Said.Add("cut");
    }

    /// <summary>Writes down what becomes of commands.</summary>
    sealed class FakeReport : ICommandReport
    {
        public readonly List<string> Said = new List<string>();
        public bool IsTooLate;
        public int OverAfter = int.MaxValue;

        public bool Start(string commandId)
        {
            Said.Add("start " + commandId);
            return !IsTooLate;
        }

        public bool Progress(string commandId, int step)
        {
            Said.Add("progress " + step);
            return step < OverAfter;
        }

        public void Done(string commandId) => Said.Add("done " + commandId);

        public void Fail(string commandId, string reason) => Said.Add("fail " + commandId + ": " + reason);
    }

    static class Make
    {
        public static CommandMessage Command(string id, params StepMessage[] steps) =>
            new CommandMessage(id, 1, "e1", "close_window", "cold", steps, 10, 0, 0, 5000);

        public static StepMessage Step(string action, double seconds, string target = null) =>
            new StepMessage(action, seconds, target);

        /// <summary>Standing before the sensor, arms hanging, in Unity's axes.</summary>
        public static CoreJoints Person()
        {
            var person = new CoreJoints();
            person.Take(new PoseMessage(0, 1, new[]
            {
                new JointSample(0, 0.7, 2, 1), new JointSample(0, 0.45, 2, 1), new JointSample(0, 0.15, 2, 1),
                new JointSample(-0.17, 0.4, 2, 1), new JointSample(-0.17, 0.1, 2, 1), new JointSample(-0.17, -0.15, 2, 1),
                new JointSample(0.17, 0.4, 2, 1), new JointSample(0.17, 0.1, 2, 1), new JointSample(0.17, -0.15, 2, 1),
            }));
            return person;
        }
    }

    /// <summary>Comparisons of the engine's values.</summary>
    static class Near
    {
        public static bool Are(Vector3 a, Vector3 b, float tolerance = 1e-4f) => (a - b).magnitude < tolerance;

        /// <summary>Whether two rotations are the same, whatever the sign of the quaternion.</summary>
        public static bool Are(Quaternion a, Quaternion b, float tolerance = 1e-5f) =>
            1 - Mathf.Abs(Quaternion.Dot(a, b)) < tolerance;
    }
}
