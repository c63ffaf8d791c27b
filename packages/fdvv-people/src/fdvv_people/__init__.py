"""Studies and optimisation of buttons with people, and with simulated ones.

The names below are the public face, imported when first used. Every other module may be imported too, and may
change (docs/explanation/stability.md).
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fdvv_people.optimize.problem import Engine
    from fdvv_people.optimize.run.session import Optimization
    from fdvv_people.optimize.space import DesignSpace
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.analysis.analyse import analyse
    from fdvv_people.study.plan.plan import StudyPlan

__version__ = "0.1.0"

_HOME = {
    "DesignSpace": "fdvv_people.optimize.space",
    "Engine": "fdvv_people.optimize.problem",
    "Optimization": "fdvv_people.optimize.run.session",
    "Study": "fdvv_people.study.admin.study",
    "StudyPlan": "fdvv_people.study.plan.plan",
    "analyse": "fdvv_people.study.analysis.analyse",
}

__all__ = ["DesignSpace", "Engine", "Optimization", "Study", "StudyPlan", "__version__", "analyse"]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used."""
    if name not in _HOME:
        raise AttributeError(f"module 'fdvv_people' has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
