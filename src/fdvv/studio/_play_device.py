"""A trial on a device beside the page: the screen shows the bullet, the device tells of its own key."""

from __future__ import annotations

from collections.abc import Callable

from fdvv.device import open_device, pressed_by_person
from fdvv.errors import InputError
from fdvv.studio import _messages_play as m
from fdvv.studio._jobs import SharedLeases
from fdvv.studio._played_trial import PlayedTrial
from fdvv.studio._studio import Studio
from fdvv.studio._work_choices import devices
from fdvv.workflow import ClockSource, DeviceKey, RoundTiming

HOLDER = "the pointing task"


def pressed_devices() -> tuple[tuple[str, str], ...]:
    """Give the devices that a person presses, with what they are."""
    return tuple((name, about) for name, about in devices()[0] if pressed_by_person(name))


class Table:
    """The table beside one page: the device on it is open from its first trial until the page goes.

    Parameters
    ----------
    failed : told in one line when the device fell to zero force or is gone, from a thread of the device.
    """

    def __init__(self, studio: Studio, failed: Callable[[str], None]) -> None:
        self._leases, self._failed = studio.part(SharedLeases), failed
        self._name = ""
        self._key: DeviceKey | None = None

    def put(self, name: str) -> DeviceKey | None:
        """Give the key of a device of the list, opened if it is not; none and a clear table if name is empty.

        Raises InputError on one that is not listed or in use, DeviceError.
        """
        if self._key and (name != self._name or self._key.problem):
            self.clear()
        if name and not self._key:
            self._open(name)
        return self._key

    def clear(self) -> None:
        """Let the device fall to zero force and go."""
        key, name = self._key, self._name
        self._name, self._key = "", None
        if key:
            key.close()
            self._leases.give_back(name)

    def _open(self, name: str) -> None:
        if name not in dict(pressed_devices()):
            raise InputError("device", "device", f"there is no {name[:80]!r}", "choose one of the list")
        self._leases.take(name, HOLDER)
        try:
            self._key = DeviceKey(open_device(name), self._failed)
        except BaseException:
            self._leases.give_back(name)
            raise
        self._name = name


class DeviceTrial:
    """A trial on a device: the page leads no finger and shows nothing but the bullet.

    Parameters
    ----------
    played : the trial, its rounds and its task. key : of the device, which renders the trial's button.

    Raises InputError, ModelError on a button that the device cannot hold, DeviceError.
    """

    def __init__(self, played: PlayedTrial, key: DeviceKey) -> None:
        self._played, self._key = played, key
        key.render(played.model)

    def down(self, at_ms: float) -> None:
        """Do nothing: what the hand does on the page is no press."""

    def up(self, at_ms: float) -> None:
        """Do nothing."""

    def here(self) -> None:
        """Do nothing: a device renders whether or not a page is looked at."""

    def keep(self, ask: m.PlayRound) -> m.PlayKept:
        """Bring a round to the disk, and score the trial after the last one.

        Raises DeviceError where the device or its line failed, InputError where the clocks are not joined.
        """
        if ask.clock_ms is None:
            reason = "the page's clock is not yet joined with the studio's"
            raise InputError("round", f"round {ask.number}", reason, "wait a second and play the trial again")
        timing = RoundTiming(
            ClockSource.KEY,
            ask.display.ms,
            ask.display.error_ms,
            0.0,
            self._key.clock_error_ms,
            ask.clock_ms,
            ask.clock_error_ms,
            None,
            ask.frame_ms,
            "button",
        )
        start_s, end_s = (1e-3 * (at_ms + ask.clock_ms) for at_ms in (ask.start_ms, ask.end_ms))
        pressed_s = self._key.pressed_s(start_s, end_s)
        return self._played.over(ask, tuple(at_s - 1e-3 * ask.clock_ms for at_s in pressed_s), timing)

    def close(self) -> None:
        """Have the device fall to zero force, and put the trial away."""
        self._key.rest()
        self._played.close()
