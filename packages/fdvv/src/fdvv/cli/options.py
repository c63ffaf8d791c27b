"""Options that several commands share, and what is made of their values."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.errors import InputError

if TYPE_CHECKING:
    from fdvv.compensation.method import Method
    from fdvv.compensation.paper import PaperLaw
    from fdvv.device.contract import Device
    from fdvv.device.remote import Remote
    from fdvv.model.noticeable import Jnds
    from fdvv.parallel.executor import Executor
    from fdvv.rendering.settings import CompensateSettings
    from fdvv.vibration.exciter import KnownExciter


def packed(
    name: str, record: Any, *several: Callable[[Any], Any]
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Join options whose values reach the command as one record.

    name : the parameter of the command that gets the record. record : a dataclass with a field for each of
        the options.
    """

    def add(command: Callable[..., Any]) -> Any:
        @functools.wraps(command)
        def call(**values: Any) -> Any:
            values[name] = record(**{field.name: values.pop(field.name) for field in fields(record)})
            return command(**values)

        return ui.options(*several)(call)

    return add


@dataclass(frozen=True)
class Workers:
    """Where a command works: processes of this machine, dask workers, or the cluster of a scheduler."""

    processes: int | None
    workers: int | None
    cluster: str | None

    def __post_init__(self) -> None:
        if sum(choice is not None for choice in (self.processes, self.workers, self.cluster)) > 1:
            raise click.UsageError("--processes, --workers and --cluster exclude each other")

    @contextmanager
    def at_work(
        self, folder: Path, label: str, total: int
    ) -> Iterator[tuple[Executor, Callable[[int, int], None]]]:
        """Open the executor and show progress; on Ctrl-C say that the folder keeps what is done."""
        from fdvv.parallel.open import open_executor

        with (
            kept_on_interrupt(f"interrupted; what is done is kept in {folder}, the same command goes on"),
            open_executor(self.processes, self.workers, self.cluster) as executor,
            ui.progress(label, total) as tell,
        ):
            yield executor, tell


executor_options = packed(
    "where",
    Workers,
    ui.option(
        "--processes", type=click.IntRange(1, 1024), help="Of this machine; by default all processors."
    ),
    ui.option("--workers", type=click.IntRange(1, 1024), help="Start so many dask workers instead."),
    ui.option("--cluster", metavar="ADDRESS", help="Use the dask cluster of this scheduler instead."),
)


@contextmanager
def kept_on_interrupt(message: str) -> Iterator[None]:
    """Say what Ctrl-C leaves."""
    try:
        yield
    except KeyboardInterrupt:
        raise KeyboardInterrupt(message) from None


exciter_option = ui.option(
    "--exciter", type=ui.FILE,
    help="File of fdvv device exciter; vibrations are played through its inverse.",
)  # fmt: skip


def opened_exciter(path: Path | None) -> KnownExciter | None:
    from fdvv.vibration.exciter import load_exciter

    return load_exciter(path) if path else None


jnds_option = ui.option(
    "--jnds", "jnds_from", type=ui.EXISTING,
    help="What your own people notice: the jnds.json of fdvv study jnds, or a project's folder that has one; "
         "else the literature's.",
)  # fmt: skip


def opened_jnds(path: Path | None) -> Jnds:
    from fdvv.model.jnd_file import load_jnds
    from fdvv.model.noticeable import LITERATURE

    return load_jnds(path) if path else LITERATURE


sensor_option = ui.option(
    "--sensor", type=ui.FILE, help="TOML file of the force sensor's data sheet, where it is not ours."
)

knowledge_options = ui.options(
    ui.option("--rig-known", type=ui.FILE, help="The *.rig.json that was learned from this rig before."),
    ui.option("--prior", type=ui.FILE, help="TOML file of what is known of the rig before any press."),
    sensor_option,
    ui.option("--save-rig", type=ui.PATH, help="The *.rig.json to write of what is learned from the rig."),
)  # fmt: skip


def law_of(
    settings: CompensateSettings,
    rig_known: Path | None,
    save_rig: Path | None,
    prior: Path | None,
    sensor: Path | None,
) -> PaperLaw | Method[Any]:
    """Return the method with what files say of the rig and of its force sensor. SettingError, InputError."""
    settings.check_known(rig_known=rig_known, save_rig=save_rig, prior=prior, sensor=sensor)
    if prior and rig_known:
        raise InputError(
            "--prior", "option", "says what --rig-known FILE holds already", "leave one of them out"
        )
    if settings.method == "paper":
        return settings.law()
    from fdvv.compensation.identification.prior_file import load_prior, load_sensor
    from fdvv.compensation.identification.rig_file import load_learned_rig

    law: Any = settings.law(load_learned_rig(rig_known) if rig_known else None)
    if prior:
        law = replace(law, prior=load_prior(prior))
    if sensor:
        sheet = load_sensor(sensor)
        law = replace(law, sensor=sheet.sensor, cell=sheet.cell)
    return law  # type: ignore[no-any-return]


device_option = ui.option("--device", "spec", default="host", help="See fdvv device.")

record_option = ui.option(
    "--record", "recording", type=ui.NEW_FILE,
    help="Append the session to this file, for --device replay:FILE.",
)  # fmt: skip

velocity_option = ui.speeds_option(
    "--velocity", "velocities_mm_s", help="Rows of a model's table, mm/s; repeatable."
)


@contextmanager
def opened(
    spec: str, recording: Path | None = None, rig: Path | None = None, seed: int = 0
) -> Iterator[Device]:
    """Open a device and close it again, whatever happens; rig and seed are of a simulated one."""
    from fdvv.device.recording import Recorder
    from fdvv.rendering.tuning import open_device

    with ExitStack() as stack:
        # a recorder closes its device too, but one that cannot open its file does not come to be
        found = stack.enter_context(closing(open_device(spec, rig, None, seed)))
        yield stack.enter_context(Recorder(found, recording)) if recording else found


@contextmanager
def closing(device: Device) -> Iterator[Device]:
    """Close a device at the end, whatever happens; some have nothing to close."""
    try:
        yield device
    finally:
        if hasattr(device, "close"):
            device.close()


@contextmanager
def remote(spec: str) -> Iterator[Remote]:
    """Open a device that has the firmware in it; InputError if it has not."""
    from fdvv.device.remote import Remote

    with opened(spec) as found:
        if not isinstance(found, Remote):
            raise InputError("--device", spec, "there is no firmware in it", "use host or serial:PORT")
        yield found
