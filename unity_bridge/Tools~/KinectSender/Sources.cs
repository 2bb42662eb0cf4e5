using System;

namespace AgentServer.KinectSender
{
    /// <summary>The sources that this program was compiled with.</summary>
    static class Sources
    {
#if KINECT_V2 && AZURE_KINECT
        public const string Names = "kinect-v2, azure-kinect, synthetic";
        public const string Default = "kinect-v2";
#elif KINECT_V2
        public const string Names = "kinect-v2, synthetic";
        public const string Default = "kinect-v2";
#elif AZURE_KINECT
        public const string Names = "azure-kinect, synthetic";
        public const string Default = "azure-kinect";
#else
        public const string Names = "synthetic";
        public const string Default = "synthetic";
#endif

        /// <exception cref="ArgumentException">If there is none of that name.</exception>
        public static IBodySource Open(string name)
        {
            switch (name)
            {
#if KINECT_V2
                case "kinect-v2": return new KinectV2Source();
#endif
#if AZURE_KINECT
                case "azure-kinect": return new AzureKinectSource();
#endif
                case "synthetic": return new SyntheticSource();
                default: throw new ArgumentException("--source is '" + name + "': give one of " + Names);
            }
        }
    }
}
