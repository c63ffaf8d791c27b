"""A trial of a timing study under the hand: simulated, on a device, or a switch that tells itself."""

from __future__ import annotations

from collections import deque

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv.program.program import Program
from fdvv_people.pages.participant.steps import TimingKept, TimingRound
from fdvv_people.pages.play_trials import DeviceTrial, LiveTrial
from fdvv_people.pages.played_trial import PlayDelay
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.task.rounds import ClockSource, RoundTiming
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.device_key import DeviceKey
from fdvv_studio.live.press_subject import PressSubject, model_subject, program_subject
from fdvv_studio.studio.contract import Tell

PRESSES = 1000
"""Of one round, at the most: what a page says is bounded."""


class TimedRounds:
    """Where the rounds of one beginning of a trial are kept.

    participant : whose they are. number : of the trial. kept : of its rounds already.

    Attributes
    ----------
    seed : of everything random in its simulation. tapping : a round is a second of tapping.
    """

    def __init__(self, participant: TimingParticipant, number: int, kept: int) -> None:
        self.seed = participant.state.started.seed
        self.tapping = participant.study.plan.tapping
        self._participant, self._number, self._kept, self._over = participant, number, kept, False

    def keep(self, ask: TimingRound, activations_s: tuple[float, ...], timing: RoundTiming) -> TimingKept:
        """Keep a round with what was pressed in it. ModelError where it is not the next one. OSError."""
        if self._over or ask.number != self._kept + 1:
            raise ModelError(f"round {ask.number} of trial {self._number} is not the next one")
        target_s = None if ask.target_ms is None else (ask.target_ms + ask.display.ms) / 1e3
        found = self._participant.keep(self._number, target_s, activations_s, timing)
        self._kept = found.round
        return TimingKept(found.round, timing.transport_ms, found.finished)

    def close(self) -> None:
        """Keep no more."""
        self._over = True


class KeyTrial:
    """A trial on a switch or key whose board, or keyboard, is heard by the page: what it tells is the press.

    rounds : where they are kept. hand : "switch" or "key". latency : from contact to the browser's event;
    None: what the page states for a keyboard.
    """

    def __init__(self, rounds: TimedRounds, hand: str, latency: PlayDelay | None) -> None:
        self._rounds, self._hand, self._latency = rounds, hand, latency
        self._downs_ms = deque[float](maxlen=PRESSES)

    def down(self, at_ms: float) -> None:
        """Note a press. at_ms : of the browser's event."""
        self._downs_ms.append(at_ms)

    def keep(self, ask: TimingRound) -> TimingKept:
        """Keep a round. ModelError where it is not the next one. OSError."""
        latency = self._latency or ask.input
        timing = ask.timing(ClockSource.PAGE, latency, None, self._hand)
        found = sorted(at for at in self._downs_ms if ask.start_ms <= at <= ask.end_ms)
        return self._rounds.keep(ask, tuple((at - latency.ms) / 1e3 for at in found), timing)

    def close(self) -> None:
        self._rounds.close()


OpenTrial = LiveTrial[TimingRound, TimingKept] | DeviceTrial[TimingRound, TimingKept] | KeyTrial


def button_trial(
    rounds: TimedRounds, button: FDVVModel | Program, key: DeviceKey | None, tell: Tell
) -> tuple[OpenTrial, PressSubject | None]:
    """Put a button under the hand: on the device of a key, or simulated; then return its subject too.

    InputError, ModelError on one that cannot be rendered, DeviceError.
    """
    if key:
        return DeviceTrial(rounds, key, button), None
    subject = program_subject(button) if isinstance(button, Program) else model_subject(button)
    finger = BinaryFinger.tapping(subject) if rounds.tapping else BinaryFinger.of(subject)
    return LiveTrial(rounds, subject, tell, finger), subject
