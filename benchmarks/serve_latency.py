"""How soon `fdvv serve` answers another program, and how soon that sees a press.

    python -m benchmarks.serve_latency

Loopback, client in Python. A press is that of a simulated rig in real time behind a terminal line; its time
on the host's clock is what the joined clocks say, so the line is in the figure, as on a real rig.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from tests.serve.running import Client, RunningServer

OWN = {"parameters": [{"name": "a", "low": 0.0, "high": 1.0}, {"name": "b", "low": 0.0, "high": 1.0}]}
PRESSES = 20
ASKS = """
import sys
from types import SimpleNamespace
from benchmarks.serve_latency import OWN
from tests.serve.running import Client
client = Client(SimpleNamespace(address=sys.argv[1], token=sys.argv[2]))
client.call("optimize.begin", run="other", budget=10_000, **OWN)
while True:
    trial = client.call("optimize.ask", run="other")
    client.call("optimize.tell", run="other", trial=trial["trial"], score=trial["design"]["a"])
"""
"""A client that lets `gp` think all the time."""


def timed_ms(client: Client, call: str, **fields: Any) -> tuple[float, Any]:
    began_s = time.perf_counter()
    found = client.call(call, **fields)
    return 1e3 * (time.perf_counter() - began_s), found


def asked(client: Client, engine: str, trials: int) -> tuple[list[float], list[float]]:
    """Return how long each design, and each report of its score, took, in ms."""
    asks, tells, rng = [], [], np.random.default_rng(0)
    client.call("optimize.begin", run=engine, engine=engine, budget=trials, **OWN)
    for _ in range(trials):
        took_ms, trial = timed_ms(client, "optimize.ask", run=engine)
        asks.append(took_ms)
        score = float(rng.normal(trial["design"]["a"], 0.1))
        tells.append(timed_ms(client, "optimize.tell", run=engine, trial=trial["trial"], score=score)[0])
    return asks, tells


def delays_ms(client: Client) -> list[float]:
    """Return how long after their moment key events came, in ms."""
    keys = [e for e in client.events if e.get("kind") in ("actuation", "reset")]
    return [1e3 * (e["came_s"] - e["host_s"]) for e in keys]


def pressed(client: Client, device: str) -> list[float]:
    """Have the simulated hand of a rig in real time press, and return the delays of its key."""
    client.events.clear()
    client.call("device.open", device=device)
    client.call("device.upload", button="mx-clear")
    client.call("device.arm")
    while len(delays_ms(client)) < 2 * PRESSES + 4:
        client.receive(60)
    client.call("device.close")
    return delays_ms(client)[4:]  # a cap that comes up as it is armed is no press


def shown(what: str, values_ms: list[float]) -> None:
    median, most = np.percentile(values_ms, [50, 95])
    print(f"{what:<52} {len(values_ms):4d}  {median:8.2f}  {most:8.2f}")


def main() -> None:
    rig = subprocess.Popen(
        [sys.executable, "-m", "fdvv", "device", "serve", "twin"], stdout=subprocess.PIPE, text=True
    )
    assert rig.stdout is not None
    device = rig.stdout.readline().split("--device ")[1].partition(";")[0]
    with TemporaryDirectory() as folder:
        server = RunningServer(Path(folder), more=("--device", device))
        try:
            client = Client(server)
            print(f"{'ms':<52} {'n':>4}  {'median':>8}  {'95 %':>8}")
            shown("clock, there and back", [timed_ms(client, "clock")[0] for _ in range(1000)])
            for engine, trials in (("sobol", 200), ("gp", 30)):
                asks, tells = asked(client, engine, trials)
                shown(f"ask, {engine}, the design on the disk", asks)
                shown(f"tell, {engine}, the score on the disk", tells)
            again = [timed_ms(client, "optimize.ask", run="sobol")[0] for _ in range(200)]
            shown("ask, nothing left", again)
            shown("key of a rig to event in the client, simulated", pressed(client, device))
            with subprocess.Popen([sys.executable, "-c", ASKS, server.address, server.token]) as other:
                shown("the same, while gp suggests for another client", pressed(client, device))
                other.kill()
        finally:
            server.stop()
            rig.terminate()


if __name__ == "__main__":
    main()
