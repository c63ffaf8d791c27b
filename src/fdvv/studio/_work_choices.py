"""What forms of long work offer to choose from."""

from __future__ import annotations

from fdvv.device import BUILT_ELF, KINDS, pressed_by_person, serial_ports
from fdvv.errors import BuildError, FdvvError
from fdvv.model import builtin_names
from fdvv.studio._job_order import BENCH, RIGS
from fdvv.studio._job_results import kept_names
from fdvv.studio._jobs import SharedLeases
from fdvv.studio._messages_jobs import ButtonChoice, DeviceChoice, WorkChoices
from fdvv.studio._studio import Studio
from fdvv.twin import PARTICIPANTS, button_names


def devices() -> tuple[tuple[tuple[str, str], ...], str]:
    """Give every device that there is, with what it is; and why serial ports cannot be listed, if so."""
    names = ["twin", "host", *(["emulated"] if BUILT_ELF.is_file() else [])]
    found = [(name, KINDS[name]) for name in names]
    try:
        return (*found, *((f"serial:{path}", about) for path, about in serial_ports())), ""
    except BuildError as error:
        return tuple(found), str(error)


def device_names() -> tuple[str, ...]:
    """Give the names of the devices that there are."""
    return tuple(name for name, _ in devices()[0])


def choices(studio: Studio) -> WorkChoices:
    """Give everything that forms offer."""
    known, note = devices()
    leases = studio.part(SharedLeases)
    return WorkChoices(
        tuple(_buttons(studio)),
        tuple(
            DeviceChoice(
                name,
                about,
                not pressed_by_person(name),
                True,
                name == "twin" or pressed_by_person(name),
                leases.holder(name) or leases.holder(BENCH + name),
            )
            for name, about in known
        ),
        RIGS,
        kept_names(studio.project, "rig"),
        kept_names(studio.project, "actuation"),
        button_names(),
        tuple(PARTICIPANTS),
        note,
    )


def _buttons(studio: Studio) -> list[ButtonChoice]:
    """List the person's own buttons, then the built-in ones; a file that cannot be read is passed over."""
    ids = [f"own:{name}" for name in kept_names(studio.project, "button")]
    ids += [f"builtin:{name}" for name in builtin_names()]
    found = []
    for button in ids:
        try:
            model = studio.shelf.model(button)
        except FdvvError:
            continue
        vibrates = any(v.stroke == "press" for v in model.vibrations)
        found.append(ButtonChoice(button, button.partition(":")[2], vibrates))
    return found
