// An experiment in Unity: fdvv chooses the size of a target and the pause before it, so that people press it
// soonest. Put FdvvClient.cs and this file into Assets, this component on an empty object, the token of
// `fdvv serve` into its field, and a button on a Canvas into `target`.

using System;
using System.Collections.Generic;
using System.Threading.Tasks;
using Fdvv;
using UnityEngine;
using UnityEngine.UI;

public class FdvvTarget : MonoBehaviour
{
    public string address = "ws://127.0.0.1:8378/fdvv";
    public string token = "";
    public string run = "target-unity";
    public int rounds = 8;
    public Button target;

    FdvvClient fdvv;
    TaskCompletionSource<bool> pressed;

    async void Start()
    {
        target.gameObject.SetActive(false);
        target.onClick.AddListener(() => pressed?.TrySetResult(true));
        fdvv = new FdvvClient(address, token);
        fdvv.OnConnection += connected => Debug.Log(connected ? "fdvv is connected" : "fdvv is gone; trying again");
        fdvv.OnError += Debug.LogException;
        try
        {
            await fdvv.ConnectAsync();
            await OptimiseAsync();
        }
        catch (FdvvException refused) { Debug.LogError(refused.Message); }
        catch (FdvvLostException) { Debug.Log("the experiment has ended"); }
    }

    void OnDestroy() => fdvv?.Dispose();

    async Task OptimiseAsync()
    {
        await fdvv.RunAsync(run, new Dictionary<string, object> {
            ["parameters"] = new List<object> {
                new Dictionary<string, object> { ["name"] = "size_px", ["low"] = 20, ["high"] = 200, ["scale"] = "log" },
                new Dictionary<string, object> { ["name"] = "pause_s", ["low"] = 0.2, ["high"] = 1.5 } },
            ["objective"] = "time_s",
            ["budget"] = 12 });
        while (true)
        {
            var trial = await fdvv.AskAsync(run);
            if (trial.Trial == null) break;
            var times_s = new List<double>();
            for (var i = 0; i < rounds; i++)
                times_s.Add(await PressAsync((float)trial.Design["size_px"], trial.Design["pause_s"]));
            await fdvv.TellAsync(run, trial.Trial.Value, Mean(times_s), Error(times_s));
        }
        var best = await fdvv.BestAsync(run);
        Debug.Log($"best: {best.Design["size_px"]:0} px, {best.Mean:0.000} s (95 %: {best.Low:0.000} to {best.High:0.000})");
    }

    async Task<double> PressAsync(float size_px, double pause_s)
    {
        await Task.Delay(TimeSpan.FromSeconds(pause_s * UnityEngine.Random.Range(0.8f, 1.2f)));
        var place = (RectTransform)target.transform;
        place.sizeDelta = new Vector2(size_px, size_px);
        place.anchoredPosition = new Vector2(UnityEngine.Random.Range(-300f, 300f), UnityEngine.Random.Range(-200f, 200f));
        pressed = new TaskCompletionSource<bool>();
        target.gameObject.SetActive(true);
        var shown_s = Time.realtimeSinceStartupAsDouble;
        await pressed.Task;
        target.gameObject.SetActive(false);
        return Time.realtimeSinceStartupAsDouble - shown_s;
    }

    static double Mean(List<double> values)
    {
        var sum = 0.0;
        foreach (var value in values) sum += value;
        return sum / values.Count;
    }

    static double Error(List<double> values)
    {
        double mean = Mean(values), sum = 0.0;
        foreach (var value in values) sum += (value - mean) * (value - mean);
        return Math.Sqrt(sum / (values.Count - 1) / values.Count);
    }
}
