namespace UnityEngine
{
    public class GUILayoutOption
    {
    }

    public class GUIStyle
    {
    }

    public struct Rect
    {
        public Rect(float x, float y, float width, float height)
        {
        }
    }

    public static class GUILayout
    {
        public static bool Button(string text, params GUILayoutOption[] options) => false;
        public static void Label(string text, params GUILayoutOption[] options)
        {
        }

        public static void BeginArea(Rect area)
        {
        }

        public static void EndArea()
        {
        }
    }
}
