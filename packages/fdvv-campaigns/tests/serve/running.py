"""`fdvv serve` in a process of its own, and a client in Python."""

from __future__ import annotations

import atexit
import inspect
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

DIRECT: dict[str, Any] = {"proxy": None} if "proxy" in inspect.signature(connect).parameters else {}


class RefusedCall(Exception):  # noqa: N818 - it is what the server answers
    """The server refused a call. error : its four parts."""

    def __init__(self, error: dict[str, str]) -> None:
        self.error = error
        super().__init__(": ".join(error.values()))


class RunningServer:
    """``fdvv serve`` on a free port, or a named one. more : options. address, token : as printed."""

    def __init__(self, project: Path, port: int = 0, more: tuple[str, ...] = ()) -> None:
        self.project = project
        self.process = subprocess.Popen(
            [sys.executable, "-m", "fdvv", "serve", "--project", str(project), "--port", str(port), *more],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        )
        atexit.register(self.process.kill)  # a test that fails does not stop it
        assert self.process.stdout is not None
        self.address, self.token = (self.process.stdout.readline().split()[-1] for _ in range(2))
        self.port = int(self.address.split(":")[-1].partition("/")[0])

    def stop(self, how: int = signal.SIGINT) -> str:
        """End it, by default as Ctrl-C does; return its standard error."""
        if self.process.poll() is None:
            self.process.send_signal(how)
            self.process.wait(15)
        return self.process.communicate()[1]


class Client:
    """One client. events : all that came, each with the host's time of its arrival as `came_s`."""

    def __init__(self, server: RunningServer, token: str | None = None, **more: Any) -> None:
        self.socket: ClientConnection = connect(server.address, **DIRECT, **more).__enter__()
        self.events: list[dict[str, Any]] = []
        self._next = 0
        self.welcome = self.call("hello", token=server.token if token is None else token)

    def call(self, call: str, **fields: Any) -> Any:
        """Return a call's result. Raises RefusedCall."""
        self.send(call, **fields)
        return self.answer(self._next)

    def send(self, call: str, **fields: Any) -> int:
        self._next += 1
        self.socket.send(json.dumps({"id": self._next, "call": call, **fields}))
        return self._next

    def answer(self, number: int | None) -> Any:
        """Wait for an answer, and keep events that come before it."""
        while True:
            message = self.receive()
            if "event" not in message:
                assert message["id"] == number
                if "error" in message:
                    raise RefusedCall(message["error"])
                return message["result"]

    def receive(self, timeout_s: float = 30.0) -> dict[str, Any]:
        message: dict[str, Any] = json.loads(self.socket.recv(timeout_s))
        if "event" in message:
            self.events.append({**message, "came_s": time.monotonic()})
        return message

    def kinds(self, event: str = "device.press") -> list[str]:
        """Return the kinds of press events in the order of the device's clock."""
        found = sorted((e for e in self.events if e["event"] == event), key=lambda e: e["device_s"])
        return [e["kind"] for e in found]

    def close(self) -> None:
        self.socket.close()

    def vanish(self) -> None:
        """Go as a killed process does: the system closes the socket, and nothing is said."""
        self.socket.socket.shutdown(2)
        self.socket.socket.close()
