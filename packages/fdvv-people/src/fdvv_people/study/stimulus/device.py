"""Labels on a device: uploaded together beforehand, changed by one short message, judged from telemetry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv.device.contract import Device
from fdvv.device.linked import LinkedDevice
from fdvv.device.remote import PressedDevice
from fdvv.device.telemetry import TickColumns
from fdvv.errors import DeviceError, InputError
from fdvv.program.surface import Limits
from fdvv.protocol.tables import BoardFlag, Fault, Mode, TickFlag
from fdvv.rendering.press_made import clear_latched
from fdvv.rendering.tuning import tune
from fdvv.vibration.exciter import KnownExciter
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.evidence import RenderingEvidence, fault_name
from fdvv_people.study.stimulus.program import TrialProgram, trial_program
from fdvv_people.study.stimulus.renderer import ConstantTimeSwitch, EvidenceRenderer, check_label
from fdvv_studio.live.device_key import DeviceLine, RealLine, SimulatedLine

RemoteDevice = LinkedDevice | PressedDevice
PACE_mm_s = 100.0
"""At which a simulated finger presses, as the person of a simulated rig varies."""


class DeviceRenderer(EvidenceRenderer):
    """A device that renders the labels of a trial, pressed by a person or, in lockstep, by a simulated one.

    Parameters
    ----------
    device : open; the renderer closes it. One in lockstep with a simulated rig, or one on a line.
    folder : of the study, where its files are.
    switch_s : every change of labels takes as long. presses : of a simulated finger, each time a label is
        shown. exciter : of the rig's vibration board, if it is known. limits : of the rig; found from its
        settings if None. failed : called once with one line when the device has fallen to zero force, from
        a thread of the renderer.

    On a line only what the rig senses is known: true displacement is its position sensor's, and without a
    force sensor on the cap no error is known. Raises InputError on a device that runs no programs.

    Attributes
    ----------
    device : that renders.
    """

    def __init__(
        self,
        device: Device,
        folder: Path,
        switch_s: float = 0.6,
        presses: int = 1,
        exciter: KnownExciter | None = None,
        limits: Limits | None = None,
        failed: Callable[[str], None] = lambda _line: None,
    ) -> None:
        super().__init__()
        self.device, self._rig = _remote(device), device if isinstance(device, LinkedDevice) else None
        self._folder, self._presses, self._exciter = folder, presses, exciter
        self._limits, self._failed = limits, failed
        self._program: TrialProgram | None = None
        self._label, self._last_tick, self._closed = "", -1, False
        self._vibrates = bool(self.device.client.hello.board_flags & BoardFlag.VIBRATION)
        self._line: DeviceLine = (
            SimulatedLine(self._rig)
            if self._rig
            else RealLine(self.device, self._heard, self._look, self._lost)
        )
        self._switch = ConstantTimeSwitch(switch_s, self._line.now_s, self._line.wait)

    @property
    def simulated(self) -> bool:
        return self.device.info().simulated

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Upload the stimuli of all labels at once, and clear the record; no label is shown."""
        self._check()
        limits = self._limits or Limits(largest_travel_mm=self.device.info().travel_limit_mm)
        limits = replace(limits, settings=self.device.settings())
        program = trial_program(labels, self._folder, limits, self._exciter)
        evidence = {
            name: RenderingEvidence(name, labels[name].name, model)
            for name, model in zip(program.labels, program.models, strict=True)
        }
        self._guarded(lambda: self._load(program, evidence))

    def show(self, label: str) -> None:
        """Switch to a label by two short messages: to rest, and to the label."""
        check_label(label, self._evidence)
        self._check()
        program = self._program
        assert program is not None
        self._switch.make(lambda: self._tell(0), lambda: self._tell(program.event(label)))
        self._label = label
        for _ in range(self._presses if self._rig else 0):
            self._press(program, label)
        self._check()

    def close(self) -> None:
        """Fall to zero force and release the device."""
        if self._closed:
            return
        self._closed = True
        self.problem = self.problem or "the renderer is closed; open another"
        self._line.close()
        self.device.close()

    # -- on the line ---------------------------------------------------------------------------------------

    def _load(self, program: TrialProgram, evidence: dict[str, RenderingEvidence]) -> None:
        device = self.device
        device.stop()
        clear_latched(device, lambda _line: None)
        tune(device, program.tuning)
        device.upload_program(program.image)
        device.client.telemetry.clear()
        device.client.stream(1)
        device.client.arm()
        with self._lock:
            self._program, self._evidence, self._label, self._last_tick = program, evidence, "", -1

    def _tell(self, event: int) -> None:
        self._guarded(lambda: self.device.client.event(event))

    def _guarded(self, work: Callable[[], None]) -> None:
        try:
            self._line.do(work)
        except DeviceError as error:
            self._lost(error)
            raise DeviceError(self.problem) from error

    def _press(self, program: TrialProgram, label: str) -> None:
        assert self._rig is not None
        try:
            press = self._rig.press_armed(PACE_mm_s)
        except DeviceError as error:
            self._look()
            self._lost(error)
            raise DeviceError(self.problem) from error
        telemetry, evidence = self._rig.client.telemetry.columns(), self._evidence[label]
        if (program.places(telemetry.state) != program.labels.index(label)).any():
            evidence.failed("another label")
        evidence.take(press.t_s, press.displacement_mm, press.force_cN)
        evidence.cut()
        self._count(evidence, telemetry)
        self._look()

    def _heard(self, telemetry: TickColumns) -> None:
        """Sort ticks by the label that the device itself says it renders; in the line's thread."""
        program = self._program
        if program is None or not telemetry.tick.size:
            return
        settings = self.device.settings()
        t_s = np.asarray(telemetry.tick * (settings.tick_us * 1e-6), dtype=np.float64)
        force_cN = telemetry.force_cN if settings.force_gain_q14 else np.full(t_s.size, np.nan)
        places = program.places(telemetry.state)
        with self._lock:
            if telemetry.tick[0] != self._last_tick + 1:
                self._cut_but(program, -1)
            self._last_tick = int(telemetry.tick[-1])
            for rows in np.split(np.arange(t_s.size), np.flatnonzero(np.diff(places)) + 1):
                place = int(places[rows[0]])
                self._cut_but(program, place)
                if place >= 0:
                    evidence = self._evidence[program.labels[place]]
                    evidence.take(t_s[rows], telemetry.displacement_mm[rows], force_cN[rows])
                    self._count(evidence, telemetry.part(np.isin(np.arange(t_s.size), rows)))
        last = self.device.client.telemetry.last
        if last is not None and last.mode == Mode.FAULT:
            self._look()

    def _cut_but(self, program: TrialProgram, place: int) -> None:
        for other, name in enumerate(program.labels):
            if other != place:
                self._evidence[name].cut()

    def _count(self, evidence: RenderingEvidence, telemetry: TickColumns) -> None:
        if self._vibrates:
            evidence.played(int(((telemetry.flags & TickFlag.VIBRATED) > 0).sum()))

    # -- what goes wrong -----------------------------------------------------------------------------------

    def _look(self) -> None:
        """Look for a latched fault, a warning among them; end the force and name it, without a number.

        Force and place of a fault could reveal what a label hides.
        """
        if self.problem or self._program is None:
            return
        found = self.device.fault()
        if found.fault is not Fault.NONE:
            self._note(found.fault)
            self._end(f"{self.device.info().name}: fell to zero force: {fault_name(found.fault)}")

    def _lost(self, error: DeviceError) -> None:
        if not self.problem:
            self._note("lost")
            self._end(str(error))

    def _note(self, fault: Fault | str) -> None:
        with self._lock:
            if self._label:
                self._evidence[self._label].failed(fault)

    def _end(self, line: str) -> None:
        self.problem = line
        with suppress(DeviceError):  # it is gone, and at zero force by itself
            self.device.stop()
        self._failed(line)


def _remote(device: Device) -> RemoteDevice:
    if isinstance(device, (LinkedDevice, PressedDevice)):
        return device
    remedy = "use host or serial:PORT; the twin is pressed without a device"
    raise InputError("device", device.info().name, "keeps no labels ready side by side", remedy)
