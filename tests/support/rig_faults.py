"""Rigs with one part that goes wrong at some press, and boards whose every command is kept. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fdvv.device.boards import LibraryBoard
from fdvv.device.plant import Inputs, Outputs
from fdvv.device.twin import SimulatedPerson
from fdvv.protocol.messages import CN64_PER_cN
from fdvv.protocol.tables import NONE, BoardLimits, CellSpec, ForceLoopGains, Settings
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig
from fdvv.twin.trace import Trace
from fdvv_rig.selftest.faults import BOARD_SILENT, FULL, RIG_FAULTS, RigFault
from fdvv_rig.selftest.operator import SOUND

JAMMED_N = 5.0
"""Dry friction of a mover that nothing moves."""
WARM_ratio = 0.75
"""Force that is left of a coil that is 85 K warmer, on a voltage drive."""
WANDER_cN = 20.0
"""By which the zero of a force sensor goes on at each press."""


class WatchedBoard(LibraryBoard):
    """The firmware as a library, with the largest command and duty since they were last taken."""

    def __init__(self) -> None:
        super().__init__()
        self.largest_cN = 0.0

    def tick(self, inputs: Inputs) -> Outputs:
        out = super().tick(inputs)
        self.largest_cN = max(self.largest_cN, abs(out.commanded_cN64) / CN64_PER_cN)
        return out


@dataclass(frozen=True)
class PlantedFault:
    """One fault and how it shows.

    Attributes
    ----------
    parts : any of which names it rightly.
    about : what is wrong. fault : of the self-test, which says what it does to duty, readings and stop.
    sticks : the mover is jammed from then on. wander_cN : of the force sensor's zero, at each press.
    late : part of the press after which it begins, in the press it begins in.
    begins_late : it makes no sense from the start.
    """

    parts: tuple[str, ...]
    about: str
    fault: RigFault
    sticks: bool = False
    wander_cN: float = 0.0
    late: float = 0.0
    begins_late: bool = False


def _scaled(ratio: float) -> RigFault:
    return RigFault("coil", f"pushes {ratio:g} of its force", duty=lambda r, _t, _s: ratio * r)


PLANTED = {
    "coil reversed": PlantedFault(("coil",), "its wires are exchanged", RIG_FAULTS["coil-reversed"]),
    "position reversed": PlantedFault(
        ("position sensor",), "its secondaries are exchanged", RIG_FAULTS["position-reversed"]
    ),
    "force sensor reversed": PlantedFault(
        ("force sensor",), "it is mounted the other way", RIG_FAULTS["force-reversed"]
    ),
    "force sensor dead": PlantedFault(("force sensor",), "its wire is off", RIG_FAULTS["force-dead"]),
    "force sensor dies": PlantedFault(
        ("force sensor",), "its wire comes off", RIG_FAULTS["force-dead"], late=0.4, begins_late=True
    ),
    "mover stuck": PlantedFault(("mover",), "nothing moves it", SOUND, sticks=True),
    "position frozen": PlantedFault(
        ("position sensor",), "its conditioner stands still", RIG_FAULTS["position-dead"]
    ),
    "gain halved": PlantedFault(("coil",), "half of the force", _scaled(0.5)),
    "coil warming": PlantedFault(
        ("coil",), "a quarter of the force goes", _scaled(WARM_ratio), begins_late=True
    ),
    "force zero wanders": PlantedFault(
        ("force sensor",), "20 cN a press", SOUND, wander_cN=WANDER_cN, begins_late=True
    ),
    "vibration cable off": PlantedFault(("vibration board",), "I2C is off", RIG_FAULTS["wire-dead"]),
    "limiter stuck": PlantedFault(("travel limiter",), "does not move", RigFault("", "", stop_mm=5.6)),
}
"""What may go wrong, by name."""


class PlantedPerson:
    """A simulated person at a rig of which something breaks; what a LinkedDevice needs.

    Parameters
    ----------
    planted : what breaks; None for a sound rig. begins : the press, from 1, at which it does; 0: at once.
    """

    def __init__(
        self, rig: Rig, finger: Finger, seed: int, planted: PlantedFault | None = None, begins: int = 0
    ) -> None:
        self._rig, self._finger, self._seed = rig, finger, seed
        self._person = SimulatedPerson(rig, finger, seed)
        self._planted, self._begins = planted, begins
        self.presses = self._tick = self._wait = 0
        self._loop: ForceLoopGains | None = None
        self._jammed = False
        self._image = b""
        if planted and planted.sticks and not begins:
            self._jam()

    # -- what the device asks of a person ---------------------------------------------------------------

    @property
    def settle_s(self) -> float:
        return self._person.settle_s

    @property
    def settings(self) -> Settings:
        return self._person.settings

    @property
    def limits(self) -> BoardLimits:
        return self._person.limits

    @property
    def load_cell(self) -> CellSpec | None:
        return self._person.load_cell

    @property
    def loop(self) -> ForceLoopGains | None:
        return self._loop

    @loop.setter
    def loop(self, gains: ForceLoopGains | None) -> None:
        self._loop = self._person.loop = gains

    @property
    def ticks(self) -> int:
        return self._person.ticks

    def lift(self) -> None:
        self._person.lift()

    def load(self, image: bytes) -> None:
        self._image = image
        self._person.load(image)

    def rest(self, settings: Settings) -> PlantedPerson:
        return self

    def record(self) -> Trace:
        return self._person.record()

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> PlantedPerson:
        self.presses += 1
        if self._planted and self._planted.sticks and self.presses >= max(self._begins, 1):
            self._jam()
        self._person.press(image, velocity_mm_s, settings)
        starts = self._planted is not None and self.presses == self._begins
        self._wait = round(self._planted.late * self.ticks) if starts and self._planted else 0
        return self

    def _jam(self) -> None:
        """Replace the rig by one whose mover is jammed where a fresh one lies."""
        if self._jammed:
            return
        self._jammed = True
        jammed = replace(self._rig, mover=replace(self._rig.mover, coulomb_N=JAMMED_N))
        known = self._person
        self._person = SimulatedPerson(jammed, self._finger, self._seed + 1)
        self._person._pace_s = known._pace_s  # type: ignore[method-assign]  # nobody expects a jammed cap
        self._person.loop = self._loop
        if self._image:
            self._person.load(self._image)
        self._person.step(0, 0, 0, NONE)  # a press forgets what was before it, and there must be something

    # -- one tick --------------------------------------------------------------------------------------

    @property
    def _is_broken(self) -> bool:
        return self._planted is not None and self.presses >= self._begins and self._wait <= 0

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        self._wait -= self._wait > 0
        self._tick += 1
        if not self._is_broken:
            return self._person.step(duty_q15, enable, stop_us, slot)
        planted = self._planted
        assert planted is not None
        fault, settings = planted.fault, self.settings
        tick_s = settings.tick_us * 1e-6
        ratio = fault.duty(duty_q15 / (FULL + 1), self._tick * tick_s, tick_s)
        duty = 0 if ratio is None else max(-FULL, min(FULL, round(ratio * (FULL + 1))))
        if fault.stop_mm is not None:
            stop_us = round(settings.stop_zero_us + settings.stop_us_mm * fault.stop_mm)
        slot = NONE if fault.silent else slot
        sensed = self._person.step(duty, enable and ratio is not None, stop_us, slot)
        if planted.fault is RIG_FAULTS["wire-dead"]:
            return sensed._replace(board=sensed.board | BOARD_SILENT)
        return self._read(sensed, planted)

    def _read(self, sensed: Inputs, planted: PlantedFault) -> Inputs:
        sensor = self._rig.position_sensor
        seen = planted.fault.inputs(sensed, sensor.reads, 2**sensor.converter_bits)
        if not planted.wander_cN:
            return seen if seen.force_counts == sensed.force_counts else self._about_zero(sensed, planted)
        per_count = self.settings.force_gain_q14 / 2**14 / CN64_PER_cN
        many = self.presses - max(self._begins, 1) + 1
        return seen._replace(
            force_counts=max(0, round(sensed.force_counts + many * planted.wander_cN / per_count))
        )

    def _about_zero(self, sensed: Inputs, planted: PlantedFault) -> Inputs:
        """Break the force sensor about its own zero."""
        zero = self.settings.force_offset_counts
        return planted.fault.inputs(sensed, 0, 2 * zero)
