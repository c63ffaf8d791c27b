"""A person presses a virtual button: one simulated rig per page, at real pace."""

from __future__ import annotations

from functools import singledispatchmethod
from typing import Any

import msgspec
import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model import model_from_json
from fdvv.program import program_from_json
from fdvv.protocol import Fault
from fdvv.studio import _messages_press as m
from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._press_tell import choices, frame, meant, ready
from fdvv.studio._programs import Programs
from fdvv.studio._studio import Studio
from fdvv.workflow import (
    LiveEventKind,
    LiveFrame,
    LivePress,
    LiveRun,
    PressSubject,
    PressTrace,
    drawn_trace,
    model_subject,
    program_subject,
    read_press_trace,
)


def list_choices(studio: Studio, _ask: m.PressListAsk) -> m.PressList:
    """Tell what can be pressed."""
    return choices(studio.shelf, studio.part(Programs).shelf)


def read_trace(_studio: Studio, ask: m.TraceReadAsk) -> m.TraceRead:
    """Read a file of a key's travel."""
    found = read_press_trace(ask.text.encode(), ask.name)
    return m.TraceRead(found.name, found.told, found.t_s.tolist(), found.displacement_mm.tolist())


def subject_of(studio: Studio, ask: m.PressStart) -> PressSubject:
    """Make ready what is asked for. Raises InputError."""
    given = [thing for thing in (ask.button, ask.program, ask.model, ask.code) if thing is not None]
    if len(given) != 1:
        raise InputError("press", "start", f"{len(given)} things to press were named", "name one")
    if ask.button is not None:
        return model_subject(studio.shelf.model(ask.button), ask.mode, ask.rig)
    if ask.model is not None:
        return model_subject(model_from_json(msgspec.json.encode(ask.model), "model"), ask.mode, ask.rig)
    if ask.program is not None:
        return program_subject(studio.part(Programs).shelf.program(ask.program), ask.mode, ask.rig)
    return program_subject(program_from_json(msgspec.json.encode(ask.code), "program"), ask.mode, ask.rig)


class PressChannel:
    """What serves one page: nothing, or a run."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studio, self._tell = studio, tell
        self._run: LiveRun | None = None

    def receive(self, ask: Any) -> None:
        """Do what the page asks; without a run most asks have come too late and do nothing."""
        self._do(ask)

    def close(self) -> None:
        """The page is gone."""
        if self._run:
            self._run.close()
        self._run = None

    @singledispatchmethod
    def _do(self, ask: Any) -> None:
        raise TypeError(f"no such ask: {ask}")

    @_do.register
    def _(self, ask: m.PressStart) -> None:
        self.close()
        subject = subject_of(self._studio, ask)
        press = LivePress(subject, ask.seed)
        self._tell(ready(subject))
        self._run = LiveRun(
            press,
            lambda seen: self._show(press, seen),
            lambda line: self._tell(m.PressRefused(line)),
            lambda line: self._tell(m.PressOver(line)),
        )

    def _show(self, press: LivePress, seen: LiveFrame) -> None:
        """Tell a frame, and after a press what one at its speed is meant to feel like."""
        self._tell(frame(seen, press.replaying))
        for event in seen.events:
            if event.kind is LiveEventKind.PRESSED:
                self._tell(meant(press.subject, round(event.velocity_mm_s, 1)))

    @_do.register
    def _(self, ask: m.PressLead) -> None:
        self._ask(lambda press: press.lead(ask.referent_mm, ask.velocity_mm_s, ask.near_1_s), ask.sequence)

    @_do.register
    def _(self, ask: m.PressPush) -> None:
        self._ask(lambda press: press.push(ask.force_cN), ask.sequence)

    @_do.register
    def _(self, ask: m.PressLift) -> None:
        self._ask(LivePress.lift, ask.sequence)

    @_do.register
    def _(self, ask: m.PressReplay) -> None:
        trace = _trace(ask)
        self._ask(lambda press: press.replay(trace))

    @_do.register
    def _(self, ask: m.PressHostEvent) -> None:
        self._ask(lambda press: press.event(ask.number))

    @_do.register
    def _(self, _ask: m.PressFail) -> None:
        self._ask(lambda press: press.fail(Fault.POSITION_STUCK))

    @_do.register
    def _(self, _ask: m.PressClear) -> None:
        self._ask(LivePress.clear_fault)

    @_do.register
    def _(self, _ask: m.PressHere) -> None:
        if self._run:
            self._run.here()

    @_do.register
    def _(self, _ask: m.PressPause) -> None:
        if self._run:
            self._run.pause()

    @_do.register
    def _(self, _ask: m.PressStop) -> None:
        self.close()
        self._tell(m.PressOver(""))

    def _ask(self, work: Any, sequence: int | None = None) -> None:
        if self._run:
            self._run.ask(work, sequence)


def _trace(ask: m.PressReplay) -> PressTrace:
    if ask.t_s is None or ask.displacement_mm is None:
        return drawn_trace(ask.name)
    try:
        return PressTrace(ask.name, "", np.array(ask.t_s), np.array(ask.displacement_mm))
    except ModelError as error:
        raise InputError("trace", ask.name, str(error), "choose another") from error


ASKS = (
    m.PressStart,
    m.PressLead,
    m.PressPush,
    m.PressLift,
    m.PressReplay,
    m.PressHostEvent,
    m.PressHere,
    m.PressPause,
    m.PressStop,
    m.PressFail,
    m.PressClear,
)
TELLS = (m.PressReady, m.PressMeant, m.PressFrame, m.PressRefused, m.PressOver)
CALLS = (
    Call("press.list", m.PressListAsk, m.PressList, list_choices),
    Call("press.trace", m.TraceReadAsk, m.TraceRead, read_trace),
)
CHANNELS = (ChannelKind("press", ASKS, TELLS, PressChannel),)
