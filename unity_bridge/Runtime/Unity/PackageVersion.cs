namespace AgentServer.Unity
{
    /// <summary>Version of this package, as package.json has it.</summary>
    public static class PackageVersion
    {
        /// <summary>Three numbers, as in semantic versioning.</summary>
        public const string Text = "0.1.0";
    }
}
