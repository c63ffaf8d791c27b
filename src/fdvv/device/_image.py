"""The smallest program: one state that follows a surface."""

from __future__ import annotations

from fdvv.errors import DeviceError, ModelError
from fdvv.model import ForceSurface
from fdvv.twin import image_of


def surface_image(surface: ForceSurface, travel_mm: float, paced: bool = False) -> bytes:
    """Make a program of one state that follows the surface.

    Its row is that of the decided velocity, or of the announced one if paced.
    As `fdvv.twin.image_of` packs it; DeviceError if a device cannot hold it.
    """
    try:
        return image_of(surface, travel_mm, paced=paced).image
    except ModelError as error:
        raise DeviceError(str(error)) from error
