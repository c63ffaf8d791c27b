"""What makes a design of the paper's space a button: an engine should not look for anything else."""

from __future__ import annotations

from fdvv_people.optimize.space import Constraint, Design

HEAVIEST_cN = 150.0
"""To close the contact: the largest force of a key in ISO 9241-410."""
DEEPEST_SNAP_ratio = 0.61
"""Fall of force at a snap over the force before it: the largest of the 107 buttons of `realistic`."""


def button_constraints() -> tuple[Constraint, Constraint]:
    """Return what a design of `paper_space` must hold to be called a button; slacks as parts of a limit."""
    return (
        Constraint(
            "closing force",
            f"the contact closes with {HEAVIEST_cN:g} cN at most, as keys do (ISO 9241-410)",
            lambda design: 1.0 - closing_cN(design) / HEAVIEST_cN,
        ),
        Constraint(
            "snap",
            f"the force falls by {100 * DEEPEST_SNAP_ratio:g} % at most, the deepest of 107 real buttons",
            lambda design: 1.0 - snap_ratio(design) / DEEPEST_SNAP_ratio,
        ),
    )


def closing_cN(design: Design) -> float:
    """Return the largest force up to the contact: between points it runs monotonically."""
    from scipy.interpolate import PchipInterpolator

    depths = [design[f"x{i}_mm"] for i in (1, 2, 3)]
    forces = [design[f"y{i}_cN"] for i in (1, 2, 3)]
    contact_mm = min(max(design["actuation_mm"], depths[0]), depths[-1])
    passed = [force for depth, force in zip(depths, forces, strict=True) if depth <= contact_mm]
    return max([float(PchipInterpolator(depths, forces)(contact_mm)), *passed])


def snap_ratio(design: Design) -> float:
    """Return the largest fall of force over the force it falls from; between points it runs monotonically."""
    first, second, third = (design[f"y{i}_cN"] for i in (1, 2, 3))
    return max(0.0, 1 - second / first, 1 - third / max(first, second))
