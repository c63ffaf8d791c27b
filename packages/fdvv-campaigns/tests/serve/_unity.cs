// The parts of Unity that the example uses, without content: enough to compile it.
using System;

namespace UnityEngine
{
    public struct Vector2 { public Vector2(float x, float y) { } }
    public class Transform { }
    public class RectTransform : Transform { public Vector2 sizeDelta, anchoredPosition; }
    public class GameObject { public void SetActive(bool active) { } }
    public class MonoBehaviour { public Transform transform; public GameObject gameObject; }
    public static class Debug { public static void Log(object o) { } public static void LogError(object o) { } public static void LogException(Exception e) { } }
    public static class Random { public static float Range(float low, float high) => low; }
    public static class Time { public static double realtimeSinceStartupAsDouble => 0.0; }
}

namespace UnityEngine.UI
{
    public class Clicked { public void AddListener(Action call) { } }
    public class Button : MonoBehaviour { public Clicked onClick; }
}
