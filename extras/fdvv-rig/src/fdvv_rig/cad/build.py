"""Make a printed part by its name."""

from __future__ import annotations

from collections.abc import Callable

from fdvv_rig.cad.carrying import base, coil_mount, lvdt_mount
from fdvv_rig.cad.moving import (
    cell_holder,
    cell_plate,
    keycap_adapter,
    limiter_arm,
    limiter_bracket,
    slider_yoke,
)
from fdvv_rig.cad.shapes import Solid, kernel
from fdvv_rig.cad.standing import black_box, capture_jig, marker_post, sensor_cone
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.placement import Pose, on_bed

BUILDERS: dict[str, Callable[[Dimensions], Solid]] = {
    "base": base,
    "coil-mount": coil_mount,
    "lvdt-mount": lvdt_mount,
    "slider-yoke": slider_yoke,
    "keycap-adapter": keycap_adapter,
    "cell-holder": cell_holder,
    "cell-plate": cell_plate,
    "limiter-arm": limiter_arm,
    "limiter-bracket": limiter_bracket,
    "sensor-cone": sensor_cone,
    "capture-jig": capture_jig,
    "marker-post": marker_post,
    "black-box": black_box,
}


def build(name: str, d: Dimensions) -> Solid:
    """Make a printed part as it lies on the bed, its lowest face at z = 0.

    Raises BuildError without the kernel; KeyError for a name that no part has.
    """
    made = BUILDERS[name](d)
    return _posed(made, on_bed(name, d))


def _posed(solid: Solid, pose: Pose) -> Solid:
    k = kernel()
    right, _, up = zip(*pose.turn, strict=True)
    plane = k.Plane(origin=pose.shift_mm, x_dir=right, z_dir=up)
    return plane.location * solid
