using System.IO;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEditor.UnityLinker;

namespace AgentServer.Unity.EditorTools
{
    /// <summary>Hands the package's link.xml to the stripper, which does not look for it in packages.</summary>
    sealed class LinkXml : IUnityLinkerProcessor
    {
        const string Place = "Packages/com.agentserver.bridge/link.xml";

        public int callbackOrder => 0;

        public string GenerateAdditionalLinkXmlFile(BuildReport report, UnityLinkerBuildPipelineData data) =>
            Path.GetFullPath(Place);
    }
}
