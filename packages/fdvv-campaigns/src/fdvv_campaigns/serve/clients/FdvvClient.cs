// The client of `fdvv serve` for Unity and other .NET programs (.NET Standard 2.1). One file, no dependencies.
// Calls and events are those of docs/reference/serve-messages.md. JSON objects are Dictionary<string, object>,
// arrays List<object>, numbers double.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Net.WebSockets;
using System.Text;
using System.Threading;
using System.Threading.Tasks;

namespace Fdvv
{
    /// <summary>What the server refuses: of what, where in it, why, and what to do.</summary>
    public sealed class FdvvException : Exception
    {
        public readonly string Place, Reason, Remedy;

        public FdvvException(string source, string place, string reason, string remedy)
            : base(source + ": " + place + ": " + reason + "; " + remedy)
        {
            Source = source;
            Place = place;
            Reason = reason;
            Remedy = remedy;
        }
    }

    /// <summary>The connection was lost before the answer came; whether the call was done is not known.</summary>
    public sealed class FdvvLostException : Exception
    {
        public FdvvLostException() : base("the connection to fdvv serve was lost") { }
    }

    /// <summary>A design to try; Trial is null at the end of a run.</summary>
    public sealed class FdvvTrial
    {
        public int? Trial;
        public Dictionary<string, double> Design;
        /// <summary>The FDVV model of a button space, as its file says; else null.</summary>
        public Dictionary<string, object> Model;
        public int Left;
        public bool Finished;
    }

    /// <summary>The recommended design; what is expected of it lies between Low and High with 95 %.</summary>
    public sealed class FdvvBest
    {
        public Dictionary<string, double> Design;
        public double Mean, Low, High;
        public int Count;
    }

    /// <summary>
    /// A connection that comes back by itself. Calls about a run survive that: the server keeps every score,
    /// and the same report twice counts once. Calls of a device fail with FdvvLostException: its force was set
    /// to zero; open it again. Awaits resume, and events come, where ConnectAsync was called: in Unity on the
    /// main thread, once a frame; take times from the events, not from when they come.
    /// </summary>
    public sealed class FdvvClient : IDisposable
    {
        public event Action<Dictionary<string, object>> OnEvent;
        public event Action<bool> OnConnection;
        /// <summary>What a handler of the two above threw; else it goes to standard error.</summary>
        public event Action<Exception> OnError;

        const int AgainMilliseconds = 500;
        static readonly HashSet<string> Repeatable = new HashSet<string> {
            "clock", "optimize.resume", "optimize.ask", "optimize.tell", "optimize.best", "optimize.compare",
            "optimize.prefer" };

        sealed class Call
        {
            public string Text;
            public bool Repeat, Sent;
            public readonly TaskCompletionSource<Dictionary<string, object>> Answer =
                new TaskCompletionSource<Dictionary<string, object>>(
                    TaskCreationOptions.RunContinuationsAsynchronously);
        }

        readonly Uri address;
        readonly string token;
        readonly SortedDictionary<long, Call> waiting = new SortedDictionary<long, Call>();
        readonly SemaphoreSlim sending = new SemaphoreSlim(1, 1);
        readonly CancellationTokenSource over = new CancellationTokenSource();
        ClientWebSocket socket;
        long next = 1;

        /// <summary>What the server offers, while connected; else null.</summary>
        public Dictionary<string, object> Welcome { get; private set; }

        /// <param name="address">as `fdvv serve` prints it, such as ws://127.0.0.1:8378/fdvv</param>
        /// <param name="token">as it prints it</param>
        public FdvvClient(string address, string token)
        {
            this.address = new Uri(address);
            this.token = token;
        }

        /// <summary>Connect, as soon as there is a server; fails where it refuses the token.</summary>
        public Task<Dictionary<string, object>> ConnectAsync()
        {
            var first = new TaskCompletionSource<Dictionary<string, object>>(
                TaskCreationOptions.RunContinuationsAsynchronously);
            _ = StayAsync(first);
            return first.Task;
        }

        /// <summary>End the connection for good; a device that was open falls to zero force.</summary>
        public void Dispose()
        {
            over.Cancel();
            socket?.Abort();
            Fail(_ => true);
        }

        /// <summary>Do a call and return its result.</summary>
        /// <param name="fields">values: string, bool, number, null, dictionaries and lists of them</param>
        public async Task<Dictionary<string, object>> CallAsync(
            string call, Dictionary<string, object> fields = null)
        {
            var one = new Call { Repeat = Repeatable.Contains(call) };
            long id;
            lock (waiting)
            {
                if (over.IsCancellationRequested || (Welcome == null && !one.Repeat)) throw new FdvvLostException();
                id = next++;
                var message = fields == null
                    ? new Dictionary<string, object>()
                    : new Dictionary<string, object>(fields);
                message["id"] = id;
                message["call"] = call;
                one.Text = FdvvJson.Write(message);
                waiting[id] = one;
            }
            if (Welcome != null) await SendWaitingAsync();
            return await one.Answer.Task;
        }

        /// <summary>Begin a run, or continue it where there is one of this name.</summary>
        public async Task RunAsync(string run, Dictionary<string, object> fields)
        {
            var known = Welcome == null ? null : (List<object>)Welcome["runs"];
            if (known == null || !known.Contains(run))
            {
                await CallAsync("optimize.begin", new Dictionary<string, object>(fields) { ["run"] = run });
                known?.Add(run);
            }
            await CallAsync("optimize.resume", Of(run));
        }

        /// <summary>The design to try next: the same one until its outcome is reported.</summary>
        public async Task<FdvvTrial> AskAsync(string run)
        {
            var found = await CallAsync("optimize.ask", Of(run));
            return new FdvvTrial {
                Trial = found["trial"] == null ? (int?)null : (int)(double)found["trial"],
                Design = Numbers(found["design"]),
                Model = found["model"] as Dictionary<string, object>,
                Left = (int)(double)found["left"],
                Finished = (bool)found["finished"] };
        }

        /// <summary>Report a score, and its standard error where it is known.</summary>
        public Task TellAsync(string run, int trial, double score, double? error = null)
        {
            var fields = Of(run);
            fields["trial"] = trial;
            fields["score"] = score;
            if (error != null) fields["error"] = error.Value;
            return CallAsync("optimize.tell", fields);
        }

        /// <summary>Report a trial that could not be scored ("failed"), or that was stopped ("abandoned").</summary>
        public Task TellAsync(string run, int trial, string outcome, string reason = "")
        {
            var fields = Of(run);
            fields["trial"] = trial;
            fields["outcome"] = outcome;
            fields["reason"] = reason;
            return CallAsync("optimize.tell", fields);
        }

        /// <summary>The recommended design with its 95 % interval.</summary>
        public async Task<FdvvBest> BestAsync(string run)
        {
            var found = await CallAsync("optimize.best", Of(run));
            return new FdvvBest {
                Design = Numbers(found["design"]), Mean = (double)found["mean"], Low = (double)found["low"],
                High = (double)found["high"], Count = (int)(double)found["count"] };
        }

        static Dictionary<string, object> Of(string run)
        {
            return new Dictionary<string, object> { ["run"] = run };
        }

        static Dictionary<string, double> Numbers(object found)
        {
            var numbers = new Dictionary<string, double>();
            foreach (var pair in (Dictionary<string, object>)found) numbers[pair.Key] = (double)pair.Value;
            return numbers;
        }

        async Task StayAsync(TaskCompletionSource<Dictionary<string, object>> first)
        {
            while (!over.IsCancellationRequested)
            {
                try
                {
                    await TalkAsync(first);
                }
                catch (FdvvException refused)
                {
                    first.TrySetException(refused);
                    return;
                }
                catch (Exception gone) when (gone is WebSocketException || gone is IOException
                    || gone is OperationCanceledException || gone is ObjectDisposedException
                    || gone is System.Net.Sockets.SocketException || gone is InvalidOperationException) { }
                var connected = Welcome != null;
                Welcome = null;
                if (connected) Raise(() => OnConnection?.Invoke(false));
                lock (waiting) foreach (var one in waiting.Values) one.Sent = one.Sent && !one.Repeat;
                Fail(one => one.Sent);
                try { await Task.Delay(AgainMilliseconds, over.Token); } catch (OperationCanceledException) { }
            }
            first.TrySetException(new FdvvLostException());
        }

        /// <summary>Connect, say hello, and pass on what comes until the connection ends.</summary>
        async Task TalkAsync(TaskCompletionSource<Dictionary<string, object>> first)
        {
            using (socket = new ClientWebSocket())
            {
                await socket.ConnectAsync(address, over.Token);
                await SendAsync(FdvvJson.Write(new Dictionary<string, object> {
                    ["id"] = 0, ["call"] = "hello", ["token"] = token }));
                while (true)
                {
                    var message = await ReceiveAsync();
                    if (message == null) return;
                    if (message.ContainsKey("event")) Raise(() => OnEvent?.Invoke(message));
                    else if (message["id"] is double id && id == 0) await WelcomedAsync(Result(message), first);
                    else Answered(message);
                }
            }
        }

        async Task WelcomedAsync(Dictionary<string, object> welcome, TaskCompletionSource<Dictionary<string, object>> first)
        {
            Welcome = welcome;
            Raise(() => OnConnection?.Invoke(true));
            first.TrySetResult(welcome);
            await SendWaitingAsync();
        }

        void Raise(Action handlers)
        {
            try { handlers(); }
            catch (Exception error)
            {
                if (OnError == null) Console.Error.WriteLine(error);
                else OnError(error);
            }
        }

        void Answered(Dictionary<string, object> message)
        {
            Call one = null;
            lock (waiting)
            {
                if (!(message["id"] is double id) || !waiting.TryGetValue((long)id, out one)) return;
                waiting.Remove((long)id);
            }
            try { one.Answer.TrySetResult(Result(message)); }
            catch (FdvvException refused) { one.Answer.TrySetException(refused); }
        }

        static Dictionary<string, object> Result(Dictionary<string, object> message)
        {
            if (message.TryGetValue("error", out var found))
            {
                var error = (Dictionary<string, object>)found;
                throw new FdvvException((string)error["source"], (string)error["place"], (string)error["reason"],
                    (string)error["remedy"]);
            }
            return (Dictionary<string, object>)message["result"];
        }

        void Fail(Func<Call, bool> chosen)
        {
            var failed = new List<Call>();
            lock (waiting)
            {
                foreach (var pair in new List<KeyValuePair<long, Call>>(waiting))
                    if (chosen(pair.Value)) { waiting.Remove(pair.Key); failed.Add(pair.Value); }
            }
            foreach (var one in failed) one.Answer.TrySetException(new FdvvLostException());
        }

        async Task SendWaitingAsync()
        {
            var texts = new List<string>();
            lock (waiting)
                foreach (var one in waiting.Values)
                    if (!one.Sent) { texts.Add(one.Text); one.Sent = true; }
            try { foreach (var text in texts) await SendAsync(text); }
            catch (Exception gone) when (gone is WebSocketException || gone is OperationCanceledException
                || gone is ObjectDisposedException || gone is InvalidOperationException) { } // StayAsync sees it too
        }

        async Task SendAsync(string text)
        {
            await sending.WaitAsync();
            try
            {
                var bytes = new ArraySegment<byte>(Encoding.UTF8.GetBytes(text));
                await socket.SendAsync(bytes, WebSocketMessageType.Text, true, over.Token);
            }
            finally { sending.Release(); }
        }

        async Task<Dictionary<string, object>> ReceiveAsync()
        {
            var buffer = new ArraySegment<byte>(new byte[16384]);
            using (var whole = new MemoryStream())
            {
                while (true)
                {
                    var part = await socket.ReceiveAsync(buffer, over.Token);
                    if (part.MessageType == WebSocketMessageType.Close) return null;
                    whole.Write(buffer.Array, 0, part.Count);
                    if (part.EndOfMessage) break;
                }
                return (Dictionary<string, object>)FdvvJson.Read(Encoding.UTF8.GetString(whole.ToArray()));
            }
        }
    }

    /// <summary>JSON as dictionaries, lists, strings, doubles, bools and null.</summary>
    public static class FdvvJson
    {
        public static string Write(object value)
        {
            var text = new StringBuilder();
            Write(text, value);
            return text.ToString();
        }

        static void Write(StringBuilder text, object value)
        {
            if (value == null) text.Append("null");
            else if (value is string s) WriteString(text, s);
            else if (value is bool b) text.Append(b ? "true" : "false");
            else if (value is System.Collections.IDictionary map)
            {
                var first = true;
                text.Append('{');
                foreach (System.Collections.DictionaryEntry pair in map)
                {
                    if (!first) text.Append(',');
                    first = false;
                    WriteString(text, (string)pair.Key);
                    text.Append(':');
                    Write(text, pair.Value);
                }
                text.Append('}');
            }
            else if (value is System.Collections.IEnumerable list)
            {
                var first = true;
                text.Append('[');
                foreach (var item in list)
                {
                    if (!first) text.Append(',');
                    first = false;
                    Write(text, item);
                }
                text.Append(']');
            }
            else WriteNumber(text, value);
        }

        static void WriteNumber(StringBuilder text, object value)
        {
            if (value is double || value is float)
            {
                var number = Convert.ToDouble(value, CultureInfo.InvariantCulture);
                if (double.IsNaN(number) || double.IsInfinity(number))
                    throw new ArgumentException("JSON has no number that is not finite");
                text.Append(number.ToString("R", CultureInfo.InvariantCulture));
            }
            else text.Append(Convert.ToString(value, CultureInfo.InvariantCulture));
        }

        static void WriteString(StringBuilder text, string s)
        {
            text.Append('"');
            foreach (var c in s)
            {
                if (c == '"' || c == '\\') text.Append('\\').Append(c);
                else if (c < ' ') text.Append("\\u").Append(((int)c).ToString("x4"));
                else text.Append(c);
            }
            text.Append('"');
        }

        public static object Read(string text)
        {
            var at = 0;
            return Value(text, ref at);
        }

        static object Value(string text, ref int at)
        {
            Blank(text, ref at);
            switch (text[at])
            {
                case '{': return Map(text, ref at);
                case '[': return Items(text, ref at);
                case '"': return String(text, ref at);
                case 't': at += 4; return true;
                case 'f': at += 5; return false;
                case 'n': at += 4; return null;
            }
            var start = at;
            while (at < text.Length && "+-.eE0123456789".IndexOf(text[at]) >= 0) at++;
            return double.Parse(text.Substring(start, at - start), CultureInfo.InvariantCulture);
        }

        static Dictionary<string, object> Map(string text, ref int at)
        {
            var map = new Dictionary<string, object>();
            at++;
            for (Blank(text, ref at); text[at] != '}'; Blank(text, ref at))
            {
                if (text[at] == ',') { at++; Blank(text, ref at); }
                var key = String(text, ref at);
                Blank(text, ref at);
                at++; // the colon
                map[key] = Value(text, ref at);
            }
            at++;
            return map;
        }

        static List<object> Items(string text, ref int at)
        {
            var items = new List<object>();
            at++;
            for (Blank(text, ref at); text[at] != ']'; Blank(text, ref at))
            {
                if (text[at] == ',') at++;
                items.Add(Value(text, ref at));
            }
            at++;
            return items;
        }

        static string String(string text, ref int at)
        {
            var s = new StringBuilder();
            for (at++; text[at] != '"'; at++)
            {
                if (text[at] != '\\') { s.Append(text[at]); continue; }
                at++;
                var c = text[at];
                if (c == 'u')
                {
                    s.Append((char)int.Parse(text.Substring(at + 1, 4), NumberStyles.HexNumber));
                    at += 4;
                }
                else s.Append(c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c == 'b' ? '\b' : c == 'f' ? '\f' : c);
            }
            at++;
            return s.ToString();
        }

        static void Blank(string text, ref int at)
        {
            while (at < text.Length && char.IsWhiteSpace(text[at])) at++;
        }
    }
}
