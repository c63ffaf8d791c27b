"""Watches the parts of a rig in a session: a check before the first press, then a look at each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from fdvv.compensation.parts.guard import Diagnosis, PartGuard
from fdvv.device.contract import Device
from fdvv.device.remote import Remote
from fdvv.eventlog import read_bodies
from fdvv.force_text import force_text
from fdvv.rendering.session import now
from fdvv.rendering.session_log import PRESSES, PRESSES_KIND, CheckRecord, PressLog
from fdvv.rendering.session_run import Guide, PressRequest


@dataclass(frozen=True, eq=False)
class PartWatch:
    """What a session on a real rig, or on a board that behaves like one, is watched by."""

    guard: PartGuard
    checked_in: tuple[Path, ...] = ()

    def check(self, device: Device, guide: Guide, log: PressLog) -> None:
        """Check the parts, unless the log has a check of today. Raises PartFaultError, DeviceError."""
        from fdvv.rendering.part_check import CHECK_cN, check_parts

        assert isinstance(device, Remote)
        checks = (log.checked, *map(_last_check, self.checked_in))
        if any(check and _is_today(check.made) for check in checks):
            return
        most = force_text(CHECK_cN, ".0f")
        guide.notice(f"first the rig's parts are checked, at {most} at most: hands off, then one press")
        checked = check_parts(
            device, self.guard, lambda speed, travel: guide.ask(PressRequest(speed, travel, 1, 1))
        )
        log.add_check(CheckRecord(list(checked.unseen), now()))
        if checked.unseen:
            guide.notice(str(checked))

    def confirm(self, device: Device, diagnosis: Diagnosis) -> Diagnosis:
        """Return what was found, after a look at the rig at rest where a press cannot tell parts apart."""
        from fdvv.rendering.part_check import confirm

        assert isinstance(device, Remote)
        return replace(diagnosis, fault=confirm(device, diagnosis.fault))


def watch_of(device: Device, travel_mm: float, checked_in: tuple[Path, ...] = ()) -> PartWatch | None:
    """Return what watches a device; None for one without a board, such as the twin, which nobody wires.

    checked_in : folders of other sessions on this rig.
    """
    if not isinstance(device, Remote):
        return None
    guard = PartGuard(travel_mm, bool(device.settings().force_gain_q14))
    return PartWatch(guard, checked_in)


def _last_check(folder: Path) -> CheckRecord | None:
    """Return the last check in a session's folder; None without one, and since a part was at fault."""
    path = folder / PRESSES
    check: CheckRecord | None = None
    for key, body, _ in read_bodies(path, PRESSES_KIND) if path.is_file() else ():
        check = body if key == "check" else None if key == "part" else check
    return check


def _is_today(made: str) -> bool:
    """Return whether a time in UTC is of the same day here; a rig that stood overnight is checked again."""
    then = datetime.fromisoformat(made)
    return then.astimezone().date() == datetime.now(UTC).astimezone().date()
