"""What an export returns: the file, and what of the button it holds and loses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from fdvv.io.files import write_atomic


@dataclass(frozen=True, eq=False)
class Exported:
    """A file of another program, and what became of the button in it.

    Attributes
    ----------
    format : its name, as ``fdvv export --to`` takes it.
    data : the file.
    kept, lost : one phrase for each thing that the file holds, and that it cannot hold.
    figures : what was lost, as numbers; the units stand in the names.
    """

    format: str
    data: bytes
    kept: tuple[str, ...] = ()
    lost: tuple[str, ...] = ()
    figures: Mapping[str, float | None] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """Return the file as text; all formats but sounds are UTF-8."""
        return self.data.decode()

    def save(self, path: Path | str) -> None:
        """Write the file, whole or not at all. Raises OSError."""
        write_atomic(Path(path), self.data)
