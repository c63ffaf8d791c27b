// Drives a real server with the client for C#, as packages/fdvv-campaigns/tests/serve/test_clients.py asks; prints what it found.

using System;
using System.Collections.Generic;
using System.Threading.Tasks;
using Fdvv;

static class Check
{
    static int Main(string[] words)
    {
        var work = Task.Run(() => Drive(words[0], words[1], words[2]));
        if (!work.Wait(TimeSpan.FromSeconds(60))) return 3;
        return work.Result;
    }

    static async Task<int> Drive(string address, string token, string run)
    {
        var events = new List<string>();
        using (var stranger = new FdvvClient(address, "wrong"))
        {
            try { await stranger.ConnectAsync(); return 4; }
            catch (FdvvException refused) { Console.WriteLine("refused " + refused.Place); }
        }
        using (var fdvv = new FdvvClient(address, token))
        {
            fdvv.OnError += error => Console.WriteLine("handler " + error.Message);
            fdvv.OnConnection += connected => { if (connected) throw new ArgumentException("failed"); };
            fdvv.OnEvent += found => {
                if ((string)found["event"] == "device.press") lock (events) events.Add((string)found["kind"]);
            };
            await fdvv.ConnectAsync();
            await fdvv.RunAsync(run, new Dictionary<string, object> {
                ["parameters"] = new List<object> {
                    new Dictionary<string, object> { ["name"] = "size_px", ["low"] = 20, ["high"] = 200, ["scale"] = "log" } },
                ["engine"] = "sobol", ["budget"] = 6, ["objective"] = "größe \"x\"" });
            var first = await fdvv.AskAsync(run);
            var again = await fdvv.AskAsync(run);
            Console.WriteLine("pending " + (first.Trial == again.Trial));
            await fdvv.TellAsync(run, first.Trial.Value, "failed", "it fell");
            for (var trial = await fdvv.AskAsync(run); trial.Trial != null; trial = await fdvv.AskAsync(run))
                await fdvv.TellAsync(run, trial.Trial.Value, trial.Design["size_px"], 1.0);
            var best = await fdvv.BestAsync(run);
            Console.WriteLine("best " + (best.Low < best.Mean && best.Mean < best.High) + " " + best.Count);
            try { await fdvv.CallAsync("device.press"); return 5; }
            catch (FdvvException refused) { Console.WriteLine("no device " + refused.Reason); }
            await fdvv.CallAsync("device.open", new Dictionary<string, object> { ["device"] = "twin" });
            await fdvv.CallAsync("device.upload", new Dictionary<string, object> { ["button"] = "mx-clear" });
            await fdvv.CallAsync("device.press", new Dictionary<string, object> { ["velocity_mm_s"] = 100.0 });
            await fdvv.CallAsync("clock");
            await fdvv.CallAsync("device.close");
            lock (events) { events.Sort(); Console.WriteLine("events " + string.Join(" ", events)); }
        }
        return 0;
    }
}
