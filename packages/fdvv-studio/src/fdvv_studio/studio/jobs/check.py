"""Check an order, wherever it comes from: the page, or a project's file that anyone may have written."""

from __future__ import annotations

import re

from fdvv.device.open import is_manual
from fdvv.errors import InputError, SettingError
from fdvv.rendering.rig_catalog import SHIPPED_RIGS
from fdvv.twin.capture.participant import PARTICIPANTS
from fdvv.twin.files import button_names, current_rig_name
from fdvv_studio.studio.devices import may_be_listed, require_listed
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, RigOrder, TuneOrder, kind_of

RIGS = tuple(SHIPPED_RIGS)
"""Of simulated devices, the one to use first."""
LARGEST_COUNT = 2**31
NAME = re.compile(r"[^\W_][\w .+()-]{0,79}")
"""Of what comes out: it becomes part of a file's name."""
LONGEST_WORD = 255
BENCH = "the capture bench "
"""Before the name of a simulated bench: it is no rig."""


def check_order(order: Order) -> None:
    """Check all that an order says by itself; what it names may still not be there. InputError."""
    check_name(order.name)
    _check_device(order)
    if isinstance(order, CaptureOrder):
        _check_capture(order)
    else:
        _check_rig_order(order)


def simulates(order: Order) -> bool:
    """Return whether the device of an order is simulated."""
    return order.device == "twin" if isinstance(order, CaptureOrder) else not is_manual(order.device)


def lock_name(order: Order) -> str:
    """Return the device of an order as the device locks name it."""
    bench = isinstance(order, CaptureOrder) and simulates(order)
    return BENCH + order.device if bench else order.device


def check_name(name: str) -> None:
    """Refuse a name that is not valid in a file's name. InputError."""
    if not NAME.fullmatch(name) or name.endswith((".", " ")):
        reason = f"cannot be {name[:80]!r}"
        raise InputError("name", "name", reason, "use letters, digits, spaces and . + - ( ), 80 at most")


def check_count(name: str, value: int) -> None:
    """Refuse a count that no work reaches. InputError."""
    if not 0 <= value <= LARGEST_COUNT:
        raise InputError(name, name, f"cannot be {str(value)[:20]}", f"give 0 to {LARGEST_COUNT}")


def _check_device(order: Order) -> None:
    """Refuse a device that a file defines: opening it runs that file, which is for a typed command alone."""
    if not may_be_listed(order.device):
        reason = f"there is no {order.device[:80]!r} in the studio"
        remedy = "choose one of its list; only a command that you type runs a device's file"
        raise InputError("device", "device", reason, f"{remedy}: fdvv {kind_of(order)} --device SPEC")


def _check_capture(order: CaptureOrder) -> None:
    if simulates(order):
        require_listed("switch", order.switch, button_names(), "choose one of the list")
        require_listed("participant", order.participant, PARTICIPANTS)
    elif not is_manual(order.device):
        reason = f"{order.device} is no capture bench"
        raise InputError("device", "device", reason, "use the simulated bench, or one on a serial port")


def _check_rig_order(order: RigOrder) -> None:
    for name in ("button", "known_rig", "actuation"):
        _check_word(name, getattr(order, name, ""))
    require_listed("rig", str(current_rig_name(order.rig)), RIGS)
    if isinstance(order, CompensateOrder):
        _check_known(order)
    if isinstance(order, TuneOrder) and order.observer != "person" and is_manual(order.device):
        reason = "a person presses this device, and a simulated observer would answer for them"
        raise InputError("observer", "observer", reason, "answer yourself")


def _check_word(what: str, word: str) -> None:
    """Refuse what no file of a project's folders is called; the word itself is never joined to a path."""
    if len(word) > LONGEST_WORD or not word.isprintable() or set(word) & set("/\\"):
        raise InputError(what, word[:80], "there is none of this name in the project", "choose another")


def _check_known(order: CompensateOrder) -> None:
    try:
        order.settings.check_known(known_rig=order.known_rig)
    except SettingError as error:
        raise InputError(error.name, error.name, error.reason, error.remedy) from error
