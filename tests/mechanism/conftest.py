"""Targets that are made of known mechanisms, and one real one."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.units import FloatArray
from fdvv_switch.coil import Coil
from fdvv_switch.dome import Dome, DomeMechanism, Pin
from fdvv_switch.guide import Guide
from fdvv_switch.making import Making
from fdvv_switch.mechanism import Mechanism, design
from fdvv_switch.spring import SpringMechanism
from fdvv_switch.target import Target, target_of

COIL = Coil(0.25, 3.5, 8.0, 12.5, 9.5)
GUIDE = Guide(2.0, 0.01, 0.03)


def target_like(mechanism: Mechanism, travel_mm: float = 4.0, close_mm: float = 2.0) -> Target:
    """Return the target that a mechanism meets exactly."""
    x: FloatArray = np.asarray(0.01 * np.arange(round(100 * travel_mm) - 6), dtype=np.float64)
    press, release = mechanism.strokes_cN(x)
    return Target("known", x, press, release, travel_mm, close_mm)


@pytest.fixture(scope="session")
def spring() -> SpringMechanism:
    return SpringMechanism(COIL, GUIDE)


@pytest.fixture(scope="session")
def clear() -> Target:
    return target_of(load_builtin("mx-clear"))


@pytest.fixture(scope="session")
def clear_leaf(clear: Target) -> Mechanism:
    return design(clear, "leaf", Making())


@pytest.fixture(scope="session")
def rubber() -> Target:
    return target_of(load_builtin("rubber-dome"))


@pytest.fixture(scope="session")
def rubber_dome() -> DomeMechanism:
    """Return a dome like those of keyboards, with a pin under it."""
    dome = Dome(10.0, 4.0, 2.4, 0.6, 0.4, 55.0, 0.1)
    return DomeMechanism(dome, Guide(2.0, 0.03, 0.02), Pin(1.0, 1.0, 55.0), 3.0, Pin(2.0, 1.0, 30.0))
