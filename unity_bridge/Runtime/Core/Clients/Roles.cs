using System;

namespace AgentServer
{
    static class Roles
    {
        /// <summary>Refuses settings of another role.</summary>
        public static void Require(ConnectionSettings settings, Role role)
        {
            if (settings.Role != role)
                throw new ArgumentException(
                    "Role: it is " + settings.Role.Text() + ", and this client is a " + role.Text() + ": set Role");
        }
    }
}
