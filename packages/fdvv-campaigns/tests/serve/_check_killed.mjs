// A client whose server is killed between a design and its score, as test_clients.py does.
import { once } from "node:events";
import { Fdvv } from "../../src/fdvv_campaigns/serve/clients/fdvv.mjs";

const [address, token, run] = process.argv.slice(2);
let connections = 0;
const onConnection = (connected) => {
  if (!connected) console.log("lost");
  else if (++connections > 1) console.log("connected");
};
const fdvv = new Fdvv(address, token, { onConnection });
await fdvv.connect();
await fdvv.run(run, { parameters: [{ name: "a", low: 0, high: 1 }], engine: "sobol", budget: 1 });
const { trial } = await fdvv.ask(run);
await fdvv.call("device.open", { device: "twin" });
console.log("asked");
await once(process.stdin, "data");
process.stdin.unref?.();
const press = await fdvv.call("device.press").catch((error) => error.name);
const found = await fdvv.tell(run, trial, 1.5);
console.log("done", found.done, "of", found.budget);
console.log("device lost", press);
fdvv.close();
process.exit(0);
