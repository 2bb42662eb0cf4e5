using System.Collections.Generic;

namespace AgentServer.Unity
{
    /// <summary>The joints of a body format, in the order in which they are sent.</summary>
    public sealed class JointTable
    {
        /// <summary>25 joints of a Kinect v2: metres, y up.</summary>
        public static readonly JointTable KinectV2 = new JointTable("kinect_v2",
            "spine_base spine_mid neck head shoulder_left elbow_left wrist_left hand_left "
            + "shoulder_right elbow_right wrist_right hand_right hip_left knee_left "
            + "ankle_left foot_left hip_right knee_right ankle_right foot_right "
            + "spine_shoulder hand_tip_left thumb_left hand_tip_right thumb_right");

        /// <summary>20 joints of a Kinect v1: metres, y up.</summary>
        public static readonly JointTable KinectV1 = new JointTable("kinect_v1",
            "hip_center spine shoulder_center head shoulder_left elbow_left wrist_left "
            + "hand_left shoulder_right elbow_right wrist_right hand_right hip_left "
            + "knee_left ankle_left foot_left hip_right knee_right ankle_right foot_right");

        /// <summary>32 joints of an Azure Kinect: millimetres, y down.</summary>
        public static readonly JointTable AzureKinect = new JointTable("azure_kinect",
            "pelvis spine_navel spine_chest neck clavicle_left shoulder_left elbow_left "
            + "wrist_left hand_left handtip_left thumb_left clavicle_right shoulder_right "
            + "elbow_right wrist_right hand_right handtip_right thumb_right hip_left "
            + "knee_left ankle_left foot_left hip_right knee_right ankle_right foot_right "
            + "head nose eye_left ear_left eye_right ear_right");

        /// <summary>33 world landmarks of MediaPipe: metres, y down.</summary>
        public static readonly JointTable BlazePose = new JointTable("blazepose",
            "nose left_eye_inner left_eye left_eye_outer right_eye_inner right_eye "
            + "right_eye_outer left_ear right_ear mouth_left mouth_right left_shoulder "
            + "right_shoulder left_elbow right_elbow left_wrist right_wrist left_pinky "
            + "right_pinky left_index right_index left_thumb right_thumb left_hip right_hip "
            + "left_knee right_knee left_ankle right_ankle left_heel right_heel "
            + "left_foot_index right_foot_index");

        /// <summary>The nine joints that the server sees: metres, y up.</summary>
        public static readonly JointTable Core9 = new JointTable("core9",
            "head neck navel left_shoulder left_elbow left_wrist right_shoulder "
            + "right_elbow right_wrist");

        static readonly JointTable[] All = { KinectV2, KinectV1, AzureKinect, BlazePose, Core9 };

        readonly Dictionary<string, int> _indices = new Dictionary<string, int>();

        JointTable(string format, string names)
        {
            Format = format;
            string[] each = names.Split(' ');
            Names = each;
            for (int i = 0; i < each.Length; i++) _indices.Add(Plain(each[i]), i);
        }

        /// <summary>What skeleton messages call the format.</summary>
        public string Format { get; }

        /// <summary>The joints, in order.</summary>
        public IReadOnlyList<string> Names { get; }

        /// <summary>The table of a format; null if this package has none.</summary>
        public static JointTable Find(string format)
        {
            foreach (JointTable table in All)
            {
                if (table.Format == format) return table;
            }
            return null;
        }

        /// <summary>Index of a joint, spelled as here or as its sensor's library does; -1 if unknown.</summary>
        public int IndexOf(string joint)
        {
            int index;
            return _indices.TryGetValue(Plain(joint), out index) ? index : -1;
        }

        static string Plain(string joint) => joint.Replace("_", "").Replace(" ", "").ToLowerInvariant();
    }
}
