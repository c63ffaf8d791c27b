"""Declaring: a study's folder appears whole or not at all."""

from __future__ import annotations

import shutil
from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import sync_folder, write_atomic
from fdvv.study import STUDY_FILE, read_plan_text
from fdvv.workflow._study_files import copy_files


def declare_folder(folder: Path, text: str, beside: Path, source: object) -> None:
    """Make the folder of a study from the text of its plan; see `Study.declare_text`. InputError, OSError."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty", "name a new one, or open the study in it")
    if folder.exists():  # somebody may stand in it
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
    copy_files(read_plan_text(text, source), beside, folder)
    write_atomic(folder / STUDY_FILE, text)
