using UnityEngine;

namespace AgentServer.Unity
{
    /// <summary>
    /// How an avatar moves: <see cref="AnimatorMotion"/> for one with an Animator, <see cref="FigureMotion"/>
    /// for the figure of the sample room, or one of your own.
    /// </summary>
    public interface IAgentMotion
    {
        /// <summary>Plays a step.</summary>
        /// <param name="step">What to do, and in what time.</param>
        /// <param name="mapping">Its line of the table; null if it has none.</param>
        void Play(StepMessage step, StepMapping mapping);

        /// <summary>Back to standing or sitting still, after a step or a cut.</summary>
        void Rest(bool isStanding);

        /// <summary>Turns the head to a point of the world; null lets it go.</summary>
        void LookAt(Vector3? point);
    }
}
