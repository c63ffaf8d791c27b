"""Declare a study, whole or not at all, and freeze it: from then on every change is noticed."""

from __future__ import annotations

import shutil
from pathlib import Path

import fdvv
from fdvv.errors import InputError
from fdvv.io.files import sync_folder, write_atomic
from fdvv.rendering.session import now
from fdvv.study.admin.review import review_plan, twin_problems
from fdvv.study.files import layout
from fdvv.study.files.chained_log import ChainedLog, head_path
from fdvv.study.files.layout import FROZEN_FILE, KEEPER_FILE, LOG_FILE, PEOPLE, Frozen, digest
from fdvv.study.files.seal import PASSPHRASE_COST, Cost, new_key_holder
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.plan_file import STUDY_FILE, check_plan, read_plan_text


def declare_folder(folder: Path, text: str, beside: Path, source: object) -> None:
    """Make the folder of a study from the text of its plan; see `Study.declare_text`. InputError, OSError."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty", "name a new one, or open the study in it")
    if folder.exists():  # it may be the working directory of a shell
        put_plan(folder, text, beside, source)
        return
    building = folder.with_name(f".{folder.name}.new")
    shutil.rmtree(building, ignore_errors=True)  # of a process that was killed
    try:
        put_plan(building, text, beside, source)
        building.replace(folder)
    finally:
        shutil.rmtree(building, ignore_errors=True)
    sync_folder(folder.parent)


def put_plan(folder: Path, text: str, beside: Path, source: object) -> None:
    """Write a plan, behind all files that it names. InputError where one is not there, OSError."""
    layout.copy_files(read_plan_text(text, source), beside, folder)
    write_atomic(folder / STUDY_FILE, text)


def freeze_folder(folder: Path, plan: StudyPlan, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
    """Freeze a study; return its fingerprint. frozen.json is written last: before it, nothing is frozen.

    Files beside the plan that it names are copied into the study first: what is frozen is what is rendered.

    InputError on a plan with problems, a frozen study, a short passphrase. BuildError: no PyNaCl. OSError.
    """
    check_plan(plan, folder / STUDY_FILE)
    review = review_plan(plan, folder)
    for problem in (*review.problems, *twin_problems(plan, folder, opened=review.models)):
        raise InputError(folder / STUDY_FILE, "plan", problem, "change it: it could not be run as it says")
    if (folder / FROZEN_FILE).exists() or (folder / PEOPLE).exists():
        raise InputError(folder, "study", "was frozen before", "declare a new study in another folder")
    layout.keep_files(plan, folder)
    paths = [folder / STUDY_FILE, *(layout.kept_path(folder, name) for name in layout.named_files(plan))]
    files = {path.relative_to(folder).as_posix(): digest(layout.content(path)) for path in paths}
    seal, keeper = new_key_holder(passphrase, cost)
    write_atomic(folder / KEEPER_FILE, keeper)
    files[KEEPER_FILE] = digest(keeper)
    builtins = {name: layout.builtin_digest(name) for name in layout.named_builtins(plan)}
    frozen = Frozen(files=files, builtins=builtins, seal=seal.text, fdvv=fdvv.__version__, when=now())
    sha256 = digest(frozen.text)
    for left in (folder / LOG_FILE, head_path(folder / LOG_FILE)):
        left.unlink(missing_ok=True)  # of a freezing that was killed
    with ChainedLog.create(folder / LOG_FILE, {"study": sha256}) as log:
        log.write({"frozen": {"when": frozen.when, "sha256": sha256, "fdvv": frozen.fdvv}})
    write_atomic(folder / FROZEN_FILE, frozen.text)
    sync_folder(folder)
    return layout.fingerprint_of(sha256)
