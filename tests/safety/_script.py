"""Scripts of calls on the supervisor, each with what the oracle expects, for the C code to play."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from fdvv.firmware.core import INPUTS, CoreRequest
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import BoardLimits, Evidence, Settings
from tests.safety._build import safety_library
from tests.safety._oracle import Inputs, Supervisor

NAMES = "init settings ask host check fault limit heat thermistor resume poke_mode poke_faults"
CALLS = {name: number for number, name in enumerate(NAMES.split())}
STEP = np.dtype(
    [
        ("call", "<u4"),
        ("settings", "<u4"),
        ("arguments", "<i4", 3),
        ("inputs", INPUTS),
        ("displacement_um16", "<i4"),
        ("force_cN64", "<i2"),
        ("commanded_cN64", "<i2"),
        ("state", "u1"),
        ("mode", "u1"),
        ("fault", "u1"),
        ("spare", "u1"),
        ("heat_K_q16", "<u4"),
        ("heat_rest_q48", "<u4"),
        ("gives", "<i4"),
        ("faults", "<u2"),
        ("spare2", "<u2"),
        ("evidence", f"V{Evidence.length_bytes()}"),
    ]
)
"""As `step` in _replay.c."""


def c_settings_check(packed: bytes, limits: BoardLimits | None = None) -> int:
    """Ask the C code: 0, or 1 + the number of the first wrong field. None: limits of the default rig."""
    board = (limits or limits_like(Settings())).pack()
    pair = (ctypes.create_string_buffer(data, len(data)) for data in (packed, board))
    check = safety_library().fdvv_settings_check
    check.restype = ctypes.c_uint8
    return int(check(*pair))


class Script:
    """Calls as they are made: each is played on the oracle at once, and kept with what that did."""

    def __init__(self) -> None:
        self.oracle = self._fresh(limits_like(Settings()))
        self.all_settings: list[Settings] = []
        self.all_limits: list[BoardLimits] = []
        self.steps: list[tuple[Any, ...]] = []
        self._evidence = (self.oracle.evidence, self.oracle.evidence.pack())

    @staticmethod
    def _fresh(limits: BoardLimits) -> Supervisor:
        return Supervisor(
            usable=lambda settings: c_settings_check(settings.pack(), limits) == 0, limits=limits
        )

    def start(self, settings: Settings, limits: BoardLimits | None = None) -> None:
        """Boot with these settings on a board; None: on one that was built for them."""
        limits = limits or limits_like(settings)
        self.oracle = self._fresh(limits)
        if not self.all_limits or self.all_limits[-1] != limits:
            self.all_limits.append(limits)
        self._keep("init", settings, (len(self.all_limits) - 1, 0, 0))
        self.mean(settings)

    def mean(self, settings: Settings) -> None:
        """Write settings."""
        self.oracle.settings(settings)
        self._keep("settings", settings)

    def ask(self, settings: Settings, ask: int, number: int = 0) -> int:
        """Ask for a change of mode."""
        gives = self.oracle.ask(settings, ask, number)
        self._keep("ask", settings, (ask, number, 0), gives)
        return gives

    def host(self, time_us: int) -> None:
        """Hear the host."""
        self.oracle.host(time_us)
        self._keep("host", None, ((time_us + 2**31) % 2**32 - 2**31, 0, 0))

    def check(self, settings: Settings, inputs: Inputs) -> None:
        """Look at a tick."""
        self.oracle.check(settings, inputs)
        self._keep("check", settings, inputs=inputs)

    def limit(self, settings: Settings) -> int:
        """Ask for the force limit."""
        gives = self.oracle.limit_cN64(settings)
        self._keep("limit", settings, gives=gives)
        return gives

    def heat(self, duty_q15: int, elapsed_ticks: int = 1, supply_mV: int = 12_000) -> None:
        """Warm the coil, or let it cool."""
        self.oracle.heat(duty_q15, supply_mV, elapsed_ticks)
        self._keep("heat", None, (duty_q15, supply_mV, elapsed_ticks))

    def thermistor(self, counts: int, elapsed_ticks: int = 1) -> None:
        """Hand over the reading of a tick."""
        self.oracle.read_thermistor(counts, elapsed_ticks)
        self._keep("thermistor", None, (counts, elapsed_ticks, 0), self.oracle.thermistor.counts)

    def resume(self, settings: Settings, spoilt: tuple[int, int] = (0, 0)) -> None:
        """Start anew with what was kept, some bits of heat and check turned over."""
        heat, check = self.oracle.kept()
        self.oracle = self._fresh(self.oracle.limits)
        self.oracle.settings(settings)
        self.oracle.resume(heat ^ spoilt[0], check ^ spoilt[1])
        self._keep("resume", settings, (0, *spoilt))

    def tick(self, settings: Settings, inputs: Inputs, duty_q15: int = 0) -> int:
        """Run what the core runs of the supervisor in a tick; return the limit."""
        self.check(settings, inputs)
        limit = self.limit(settings)
        self.heat(duty_q15 if limit else 0, max(1, inputs.elapsed_ticks), inputs.supply_mV)
        if self.oracle.limits.thermistor_lag_ms:
            self.thermistor(inputs.thermistor_counts, max(1, inputs.elapsed_ticks))
        return limit

    def found(self, number: int, value: int, bound: int) -> None:
        """Report a fault found elsewhere."""
        self.oracle.found(number, value, bound)
        self._keep("fault", None, (number, value, bound))

    def poke_mode(self, mode: int) -> None:
        """Corrupt the mode, as a flipped bit would."""
        self.oracle.mode = mode
        self._keep("poke_mode", None, (mode, 0, 0))

    def poke_faults(self, faults: int) -> None:
        """Pretend that many faults were counted."""
        self.oracle.faults = faults
        self._keep("poke_faults", None, (faults, 0, 0))

    def armed(self, settings: Settings, inputs: Inputs | None = None) -> None:
        """Boot and arm with the host heard at the inputs' time."""
        self.start(settings)
        self.ask(settings, CoreRequest.BOOTED)
        self.tick(settings, inputs or Inputs())
        self.host((inputs or Inputs()).time_us)
        self.ask(settings, CoreRequest.ARM)

    def _keep(
        self,
        call: str,
        settings: Settings | None,
        arguments: tuple[int, int, int] = (0, 0, 0),
        gives: int = 0,
        inputs: Inputs | None = None,
    ) -> None:
        if settings is not None and (not self.all_settings or self.all_settings[-1] is not settings):
            self.all_settings.append(settings)
        it, oracle = inputs or Inputs(), self.oracle
        if oracle.evidence is not self._evidence[0]:
            self._evidence = (oracle.evidence, oracle.evidence.pack())
        given = (it.time_us, it.sum, it.lowest, it.highest, it.elapsed_ticks, it.supply_mV, it.force_counts)
        self.steps.append(
            (
                CALLS[call],
                max(0, len(self.all_settings) - 1),
                arguments,
                (*given, it.thermistor_counts, it.board),
                it.displacement_um16,
                it.force_cN64,
                it.commanded_cN64,
                it.state,
                int(oracle.mode),
                int(oracle.fault),
                0,
                oracle.heat_K_q48 >> 32,
                oracle.heat_K_q48 % 2**32,
                gives,
                oracle.faults,
                0,
                self._evidence[1],
            )
        )

    def packed(self) -> tuple[bytes, bytes, bytes]:
        """Return the settings, the steps and the limits as the C side reads them."""
        settings, limits = (
            b"".join(record.pack() for record in records) for records in (self.all_settings, self.all_limits)
        )
        return settings, np.array(self.steps, STEP).tobytes(), limits

    def play(self) -> str:
        """Play it on the C code; empty if all went as expected, else what came at which step."""
        settings, steps, limits = self.packed()
        first = safety_library().safety_replay(steps, ctypes.c_int(len(self.steps)), settings, limits)
        return "" if first == len(self.steps) else f"step {first}: {self.steps[first]}"
