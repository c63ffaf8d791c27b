"""What the parts of a running studio share."""

from __future__ import annotations

from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any, TypeVar, cast

from fdvv.errors import InputError

if TYPE_CHECKING:
    from fdvv.model.noticeable import Jnds
    from fdvv.rendering.rig_catalog import RigCatalog
    from fdvv_studio.library.catalog import Catalog
    from fdvv_studio.project.programs import ProgramCatalog

P = TypeVar("P")


class Studio:
    """One studio: a person's project, the folders beside it, and the service of every part.

    project : folder of the person's work; made when something is first kept in it.
    sources : folders of measured switches. libraries : folders of libraries of them, which save reading.
    """

    def __init__(
        self, project: Path, sources: tuple[Path, ...] = (), libraries: tuple[Path, ...] = ()
    ) -> None:
        self.project, self.sources, self.libraries = project, sources, libraries
        self._parts: dict[type[Any], Any] = {}
        self._lock = RLock()

    # imported at first use, for the page need not wait for them

    @property
    def catalog(self) -> Catalog:
        from fdvv_studio.library.catalog import Catalog

        return self._only(Catalog, self.project, self.sources)

    @property
    def programs(self) -> ProgramCatalog:
        from fdvv_studio.project.programs import ProgramCatalog

        return self._only(ProgramCatalog, self.project)

    @property
    def rigs(self) -> RigCatalog:
        from fdvv.rendering.rig_catalog import RigCatalog

        return self._only(RigCatalog, self.project)

    @property
    def jnds(self) -> Jnds:
        """What people notice: those of the project, read anew each time, or the literature's. InputError."""
        from fdvv.model.jnd_file import FILE_NAME, project_jnds

        try:
            return project_jnds(self.project)
        except InputError as error:  # pages get no paths, so the place names the file
            place = f"{FILE_NAME}, {error.place}"
            raise InputError(error.source, place, error.reason, error.remedy) from error

    def part(self, service: type[P]) -> P:
        """Return the one instance of a service, made with this studio on first use."""
        return self._only(service, self)

    def _only(self, service: type[P], *given: Any) -> P:
        with self._lock:
            if service not in self._parts:
                self._parts[service] = service(*given)
            return cast(P, self._parts[service])

    def close(self) -> None:
        """End every part that has something to end, the youngest first."""
        with self._lock:
            parts = list(self._parts.values())[::-1]
            self._parts.clear()
        for part in parts:
            if hasattr(part, "close"):
                part.close()
