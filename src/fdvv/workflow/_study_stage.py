"""What makes a label of a trial felt: the seam between a study and whatever renders."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Protocol

from fdvv.errors import InputError
from fdvv.model import FDVVModel, builtin_names, load_builtin, load_model
from fdvv.study import Rendered, Stimulus
from fdvv.workflow._probe import fd_only
from fdvv.workflow._study_files import study_file

WORK_s = 0.05
"""So long before the end of a change its second half begins, which takes some milliseconds."""
CLOCK_s = 1e-6


class StudyStage(Protocol):
    """Makes labels felt, one at a time, and keeps what was physically rendered.

    Errors are DeviceError in one line: whatever renders is at zero force then, and what had been rendered
    before can still be asked for. A stage is used from one thread at a time.
    """

    @property
    def simulated(self) -> bool:
        """Tell whether the rig is a simulated one; says nothing of who presses."""

    @property
    def person(self) -> bool:
        """Tell whether a person presses; else a simulated finger does."""

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Make ready what each label hides, and forget what was rendered before; no label is shown.

        Raises InputError on a stimulus that cannot be rendered, DeviceError.
        """
        ...

    def show(self, label: str) -> None:
        """Render a label from now on; always takes as long, whichever it is and whichever was before.

        Raises InputError on a label that was not prepared, DeviceError.
        """
        ...

    def rendered(self) -> tuple[Rendered, ...]:
        """Tell what was rendered since prepare(), one for every label, in the order of their names."""
        ...

    def close(self) -> None:
        """Fall to zero force and let go; a second time does nothing."""
        ...


class EvenSwitch:
    """Has every change take as long, whatever is done in it.

    Parameters
    ----------
    switch_s : from asked to done. clock, sleep : of time.

    Attributes
    ----------
    late : changes whose work alone took longer; they took the next whole multiple of switch_s.
    """

    def __init__(
        self,
        switch_s: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.switch_s, self._clock, self._sleep = switch_s, clock, sleep
        self._work_s = min(WORK_s, switch_s / 4)
        self.late = 0

    def make(self, before: Callable[[], None], after: Callable[[], None] = lambda: None) -> None:
        """Do the one at once, the other near the end of the time; an error does not shorten it."""
        began_s = self._clock()
        try:
            before()
            self._wait(began_s, self.switch_s - self._work_s)
            after()
        finally:
            self._end(began_s)

    def _end(self, began_s: float) -> None:
        worked_s = self._clock() - began_s
        late = worked_s > self.switch_s + CLOCK_s
        self.late += late
        whole = math.ceil(worked_s / self.switch_s) if late and self.switch_s else 1
        self._wait(began_s, whole * self.switch_s)

    def _wait(self, began_s: float, until_s: float) -> None:
        self._sleep(max(0.0, began_s + until_s - self._clock()))


def stimulus_model(stimulus: Stimulus, folder: Path) -> FDVVModel:
    """Give what a stimulus is meant to feel like: its button, reduced to FD if it says so, forces in ratio.

    folder : of the study; a button that is no built-in's name is a file in it or in its ``buttons``.
    Raises InputError.
    """
    if stimulus.button in builtin_names():
        model = load_builtin(stimulus.button)
    else:
        model = load_model(study_file(folder, stimulus.button))
    model = fd_only(model) if stimulus.rendered == "FD" else model
    return in_ratio(model, stimulus.force_ratio)


@lru_cache(maxsize=256)
def in_ratio(model: FDVVModel, force_ratio: float) -> FDVVModel:
    """Multiply all forces of a model; vibrations stay, and what was measured of spread is left out."""
    if force_ratio == 1.0:
        return model
    curves = tuple(
        replace(curve, control_points_cN=force_ratio * curve.control_points_cN, spread=None)
        for curve in model.curves
    )
    return replace(model, curves=curves)


def check_label(label: str, labels: Mapping[str, object]) -> None:
    """Refuse a label that was not prepared. Raises InputError."""
    if label not in labels:
        known = ", ".join(sorted(labels)) or "none"
        raise InputError("label", label, "is none of this trial", f"use one of: {known}")
