"""Freezing: from here on the study is what it is, and whoever changes it is noticed."""

from __future__ import annotations

from pathlib import Path

import fdvv
from fdvv.errors import InputError
from fdvv.files import read_limited, sync_folder, write_atomic
from fdvv.study import STUDY_FILE, StudyPlan, check_plan
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_chain import head_path
from fdvv.workflow._study_files import (
    FROZEN_FILE,
    KEEPER_FILE,
    LOG_FILE,
    PEOPLE,
    REMEDY,
    Frozen,
    LARGEST_bytes,
    builtin_digest,
    digest,
    fingerprint_of,
    keep_files,
    kept_path,
    named_builtins,
    named_files,
)
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_look import look_at_plan
from fdvv.workflow._study_renderable import twin_problems
from fdvv.workflow._study_seal import PASSPHRASE_COST, Cost, new_keeper


def freeze_folder(folder: Path, plan: StudyPlan, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
    """Freeze a study; give its fingerprint. frozen.json is written last: before it, nothing is frozen.

    Files beside the plan that it names are copied into the study first: what is frozen is what is played.

    InputError on a plan with problems, a frozen study, a short passphrase. BuildError: no PyNaCl. OSError.
    """
    check_plan(plan, folder / STUDY_FILE)
    look = look_at_plan(plan, folder)
    for problem in (*look.problems, *twin_problems(plan, folder, opened=look.models)):
        raise InputError(folder / STUDY_FILE, "plan", problem, "change it: it could not be run as it says")
    if (folder / FROZEN_FILE).exists() or (folder / PEOPLE).exists():
        raise InputError(folder, "study", "was frozen before", "declare a new study in another folder")
    keep_files(plan, folder)
    files = {STUDY_FILE: digest(_content(folder / STUDY_FILE))}
    for name in named_files(plan):
        path = kept_path(folder, name)
        files[path.relative_to(folder).as_posix()] = digest(_content(path))
    seal, keeper = new_keeper(passphrase, cost)
    write_atomic(folder / KEEPER_FILE, keeper)
    files[KEEPER_FILE] = digest(keeper)
    builtins = {name: builtin_digest(name) for name in named_builtins(plan)}
    frozen = Frozen(files=files, builtins=builtins, seal=seal.text, fdvv=fdvv.__version__, when=now())
    return _keep(folder, frozen)


def _keep(folder: Path, frozen: Frozen) -> str:
    sha256 = digest(frozen.text)
    for left in (folder / LOG_FILE, head_path(folder / LOG_FILE)):
        left.unlink(missing_ok=True)  # of a freezing that was killed
    with ChainedLog.create(folder / LOG_FILE, {"study": sha256}) as log:
        log.write({"frozen": {"when": frozen.when, "sha256": sha256, "fdvv": frozen.fdvv}})
    write_atomic(folder / FROZEN_FILE, frozen.text)
    sync_folder(folder)
    return fingerprint_of(sha256)


def _content(path: Path) -> bytes:
    return read_limited(path, LARGEST_bytes, REMEDY)
