"""What the maker can do: space, materials, smallest radii, steepest cam."""

from __future__ import annotations

from dataclasses import dataclass, field

from fdvv.errors import ModelError
from fdvv_switch.coil import Envelope
from fdvv_switch.material import STRIPS, WIRES


@dataclass(frozen=True)
class Making:
    """Limits and materials of a design.

    Attributes
    ----------
    envelope : space of the coil.
    wire, strip : names of WIRES and STRIPS.
    friction_ratio : between leaf and cam; metal on dry acetal 0.15 to 0.25, assumed.
    nose_mm : radius of the leaf's nose; edge_mm : smallest radius of the moulded cam, outward; assumed.
    hollow_mm : smallest radius of the nose's path in a hollow of the cam.
    slope_ratio : steepest cam, across over along the travel; 1.2 is a pressure angle of 50 degrees; assumed.
    leaf_mm : shortest and longest leaf.
    gap_mm : how far the open leaf stands off its contact, at least.
    contact_ratio : stiffness of the fixed contact over that of the leaf.
    widest_mm : largest base of a dome; keys stand 19 mm apart.
    """

    envelope: Envelope = field(default_factory=Envelope)
    wire: str = "steel"
    strip: str = "beryllium-copper"
    friction_ratio: float = 0.2
    nose_mm: float = 0.15
    edge_mm: float = 0.1
    hollow_mm: float = 0.1
    slope_ratio: float = 1.2
    leaf_mm: tuple[float, float] = (4.0, 12.0)
    gap_mm: float = 0.03
    contact_ratio: float = 3.0
    widest_mm: float = 15.0

    def __post_init__(self) -> None:
        if self.wire not in WIRES:
            raise ModelError(f"wire is one of {', '.join(WIRES)}, got {self.wire!r}")
        if self.strip not in STRIPS:
            raise ModelError(f"strip is one of {', '.join(STRIPS)}, got {self.strip!r}")
        if not 0.02 <= self.friction_ratio <= 0.6:
            raise ModelError(f"friction_ratio must lie between 0.02 and 0.6, got {self.friction_ratio}")
        if min(self.nose_mm, self.edge_mm, self.hollow_mm, self.slope_ratio) <= 0:
            raise ModelError("radii and the steepest slope must be above 0")
