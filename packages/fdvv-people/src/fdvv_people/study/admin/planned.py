"""The plan of a study in a folder, whatever it declares: put there, changed, frozen."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

from fdvv._version import __version__
from fdvv.errors import InputError
from fdvv.io.files import read_limited, sync_folder, write_atomic
from fdvv.rendering.session import now
from fdvv_people.study.files import layout
from fdvv_people.study.files.chained_log import ChainedLog
from fdvv_people.study.files.folder import StudyFolder
from fdvv_people.study.files.layout import LOG_FILE, PEOPLE, Frozen, digest
from fdvv_people.study.files.log_head import head_path
from fdvv_people.study.files.seal import PASSPHRASE_COST, Cost, new_key_holder
from fdvv_people.study.kind import StudyKind, kind_of_text
from fdvv_people.study.plan.plan_file import STUDY_FILE, refuse_problems

UNFIT = "change it: it could not be run as it says"


class PlannedStudy(StudyFolder):
    """A study up to its freezing; no file is held open between two calls."""

    def check(self) -> None:
        """Raise InputError on a plan that could not be run or analysed as it says, its buttons among it."""
        source = self.folder / STUDY_FILE
        refuse_problems(self.kind.problems(self.plan), source)
        for problem in self.kind.unfit(self.plan, self.folder):
            raise InputError(source, "plan", problem, UNFIT)

    @classmethod
    def declare(cls, folder: Path, plan_file: Path) -> Self:
        """Declare a study in a folder that is new or empty: copy its plan and all files that it names.

        InputError on a plan that cannot be read, or that names a file that is not there. OSError.
        """
        text = read_limited(plan_file, layout.LARGEST_bytes, layout.SMALLER).decode(errors="replace")
        return cls.declare_text(folder, text, Path(plan_file).parent, plan_file)

    @classmethod
    def declare_text(cls, folder: Path, text: str, beside: Path, source: object = STUDY_FILE) -> Self:
        """Declare a study from the text of its plan, whole or not at all. beside : where its files lie."""
        make_folder(folder, lambda building: _put_plan(building, kind_of_text(text), text, beside, source))
        return cls(folder)

    @classmethod
    def open(cls, folder: Path) -> Self:
        """Open a study. InputError where there is none."""
        if not (Path(folder) / STUDY_FILE).is_file():
            raise InputError(folder, "folder", f"holds no study ({STUDY_FILE})", "name the folder of a study")
        return cls(folder)

    def change_plan(self, text: str, beside: Path | None = None) -> None:
        """Replace the plan of a study that is not frozen. beside : where files lie that it names."""
        if self.frozen:
            raise InputError(self.folder, "study", "is frozen", "declare a new study in another folder")
        _put_plan(self.folder, self.kind, text, beside or self.folder, STUDY_FILE)

    def freeze(self, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
        """Freeze the study, and return its fingerprint: from now on every change is noticed.

        passphrase : the key holder's; it is not stored. Sessions are open in this object from then on.
        Files beside the plan that it names are copied into the study first: what is frozen is rendered.
        InputError on a plan with problems, a study that was frozen before, a short passphrase. BuildError: no
        PyNaCl. OSError.
        """
        folder, plan = self.folder, self.plan
        self.check()
        if (folder / layout.FROZEN_FILE).exists() or (folder / PEOPLE).exists():
            remedy = "declare a new study in another folder"
            raise InputError(folder, "study", "was frozen before", remedy)
        names = layout.named_files(plan)
        layout.keep_files(names, folder)
        paths = [folder / STUDY_FILE, *(layout.kept_path(folder, name) for name in names)]
        files = {path.relative_to(folder).as_posix(): digest(layout.content(path)) for path in paths}
        holder, keeper = new_key_holder(passphrase, cost)
        write_atomic(folder / layout.KEEPER_FILE, keeper, private=True)
        files[layout.KEEPER_FILE] = digest(keeper)
        digests = {name: layout.builtin_digest(name) for name in layout.named_builtins(plan)}
        frozen = Frozen(files=files, builtins=digests, seal=holder.seal.text, fdvv=__version__, when=now())
        fingerprint, self.run_key = self._begin_log(frozen), holder.run_key
        return fingerprint

    def _begin_log(self, frozen: Frozen) -> str:
        log_path, sha256 = self.folder / LOG_FILE, digest(frozen.text)
        for left in (log_path, head_path(log_path)):
            left.unlink(missing_ok=True)  # of a freezing that was killed
        with ChainedLog.create(log_path, {"study": sha256}) as log:
            log.write({"frozen": {"when": frozen.when, "sha256": sha256, "fdvv": frozen.fdvv}})
        # last of all: before it is there, nothing is frozen
        write_atomic(self.folder / layout.FROZEN_FILE, frozen.text)
        sync_folder(self.folder)
        return layout.fingerprint_of(sha256)


def _put_plan(folder: Path, kind: StudyKind[Any], text: str, beside: Path, source: object) -> None:
    """Write a plan, behind all files that it names. InputError where one is not there, OSError."""
    layout.copy_files(layout.named_files(kind.read_plan(text, source)), Path(beside), folder)
    write_atomic(folder / STUDY_FILE, text)


def make_folder(folder: Path, put: Callable[[Path], None]) -> None:
    """Make the folder of a study, whole or not at all. put : writes its files into a folder that exists not.

    InputError where it is there and not empty, and what put raises. OSError.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty", "name a new one, or open the study in it")
    if folder.exists():  # it may be the working directory of a shell
        put(folder)
        return
    building = folder.with_name(f".{folder.name}.new")
    shutil.rmtree(building, ignore_errors=True)  # of a process that was killed
    try:
        put(building)
        building.replace(folder)
    finally:
        shutil.rmtree(building, ignore_errors=True)
    sync_folder(folder.parent)
