// Drives a real server with the client for JavaScript, as test_clients.py asks; prints what it found.
import { Fdvv } from "../../src/fdvv_campaigns/serve/clients/fdvv.mjs";

const [address, token, run] = process.argv.slice(2);
const title = (truth) => (truth ? "True" : "False");

await new Fdvv(address, "wrong").connect().catch((error) => console.log("refused", error.place));

const events = [];
const fdvv = new Fdvv(address, token, { onEvent: (e) => e.event === "device.press" && events.push(e.kind) });
await fdvv.connect();
const parameters = [{ name: "size_px", low: 20, high: 200, scale: "log" }];
await fdvv.run(run, { parameters, engine: "sobol", budget: 6, objective: 'größe "x"' });
const first = await fdvv.ask(run);
console.log("pending", title((await fdvv.ask(run)).trial === first.trial));
await fdvv.fail(run, first.trial, "it fell");
for (;;) {
  const { trial, design } = await fdvv.ask(run);
  if (trial === null) break;
  await fdvv.tell(run, trial, design.size_px, 1.0);
}
const best = await fdvv.best(run);
console.log("best", title(best.low < best.mean && best.mean < best.high), best.count);
await fdvv.call("device.press").catch((error) => console.log("no device", error.reason));
await fdvv.call("device.open", { device: "twin" });
await fdvv.call("device.upload", { button: "mx-clear" });
await fdvv.call("device.press", { velocity_mm_s: 100 });
await fdvv.call("clock");
await fdvv.call("device.close");
console.log("events", events.sort().join(" "));
fdvv.close();
