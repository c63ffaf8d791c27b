"""The power of a study's claim, from its file: what a number of people could show. Simulated."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.study import (
    STUDY_FILE,
    PowerTable,
    ProxySettings,
    StudyPlan,
    check_plan,
    power_table,
    read_plan_text,
)
from fdvv.workflow._study_effects import claim_of, power_design

LARGEST_bytes = 1_000_000
REMEDY = "name the file of a study, or begin with fdvv study new"
SHARE_NAMES = ("for", "equal", "against")


@dataclass(frozen=True, eq=False)
class StudyPower:
    """What a plan can show. **Simulated**: the word of proxies, for planning; never evidence.

    Attributes
    ----------
    plan : that it is of. table : see there. given_JND : difference that was assumed; None: as the proxies
        feel the plan's own stimuli.
    """

    plan: StudyPlan
    table: PowerTable
    given_JND: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Give it for JSON."""
        return {
            "simulated": True,
            "study": self.plan.name,
            "kind": self.plan.kind,
            "planned_people": self.plan.people,
            "claim": msgspec.to_builtins(claim_of(self.plan)),
            "test": "signed rank of people's means, exact, two-sided",
            "studies": self.table.studies,
            "seed": self.table.seed,
            "given_JND": self.given_JND,
            "enough_people": self.table.enough(),
            "items": self._items(),
            "rows": [asdict(row) for row in self.table.rows],
            "proxy": asdict(self.table.settings),
        }

    def _items(self) -> list[dict[str, Any]]:
        found = []
        for effect, shares in zip(self.table.design.effects, self.table.shares.tolist(), strict=True):
            felt = effect.between
            parts = {"force_JND": felt.force_JND, "speed_JND": felt.speed_JND}
            parts |= {"vibration_JND": felt.vibration_JND, "total_JND": felt.total_JND}
            told = (share if math.isfinite(share) else None for share in shares)
            found.append({"item": effect.item, **parts, **dict(zip(SHARE_NAMES, told, strict=True))})
        return found


def study_power(
    path: Path,
    people: Sequence[int],
    studies: int = 2000,
    seed: int = 0,
    settings: ProxySettings | None = None,
    given_JND: float | None = None,
    progress: Callable[[str, int, int], None] = lambda _label, _done, _total: None,
) -> StudyPower:
    """Plan a study: the power of its claim for every number of people.

    path : the file of a study, or its folder. given_JND : one difference for all items in place of what the
    proxies feel. The rest as in power_table. InputError on a plan that cannot be read or claims nothing.
    """
    settings = settings or ProxySettings()
    plan, folder = open_plan(path)
    design = power_design(plan, folder, settings.senses)
    design = design if given_JND is None else design.of_size(given_JND)
    return StudyPower(
        plan, power_table(design, people, studies, seed, settings, progress=progress), given_JND
    )


def open_plan(path: Path) -> tuple[StudyPlan, Path]:
    """Read and check the plan of a file, or of a study's folder; gives the folder too. Raises InputError."""
    file = path / STUDY_FILE if path.is_dir() else path
    try:
        text = read_limited(file, LARGEST_bytes, REMEDY).decode()
    except UnicodeDecodeError as error:
        raise InputError(file, "whole file", "not UTF-8 text", REMEDY) from error
    plan = read_plan_text(text, file)
    check_plan(plan, file)
    return plan, file.parent
