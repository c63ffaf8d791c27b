"""From a model to a real switch: springs, leaves on cams and domes that give its curves."""

from fdvv.mechanism._coil import Coil
from fdvv.mechanism._coil_choice import Envelope, choose_coil
from fdvv.mechanism._dome import Dome, DomeMechanism, Pin, cone_force_N
from fdvv.mechanism._dxf import drawing_dxf
from fdvv.mechanism._facts import facts_of, notes_of
from fdvv.mechanism._guide import Guide
from fdvv.mechanism._leaf import Cam, Leaf, LeafMechanism
from fdvv.mechanism._leaf_choice import choose_leaf
from fdvv.mechanism._making import Making
from fdvv.mechanism._material import STRIPS, WIRES, hardness_shoreA, rubber_MPa
from fdvv.mechanism._mechanism import KINDS, Mechanism, design, varied
from fdvv.mechanism._residual import Miss, Residual, WANTED_cN, miss_of, residual_of
from fdvv.mechanism._section import Drawing, Outline, cam_points_mm, drawings_of
from fdvv.mechanism._spring import SpringMechanism
from fdvv.mechanism._target import SEATED_mm, STOP_mm, Target, target_of
from fdvv.mechanism._tolerance import Band, Share, Tolerance, band_of, bump_of, tolerances_of

__all__ = [
    "KINDS",
    "STRIPS",
    "WIRES",
    "Band",
    "Cam",
    "Coil",
    "Dome",
    "DomeMechanism",
    "Drawing",
    "Envelope",
    "Guide",
    "Leaf",
    "LeafMechanism",
    "Making",
    "Mechanism",
    "Miss",
    "Outline",
    "Pin",
    "Residual",
    "SEATED_mm",
    "STOP_mm",
    "Share",
    "SpringMechanism",
    "Target",
    "Tolerance",
    "WANTED_cN",
    "band_of",
    "bump_of",
    "cam_points_mm",
    "choose_coil",
    "choose_leaf",
    "cone_force_N",
    "design",
    "drawing_dxf",
    "drawings_of",
    "facts_of",
    "hardness_shoreA",
    "miss_of",
    "notes_of",
    "residual_of",
    "rubber_MPa",
    "target_of",
    "tolerances_of",
    "varied",
]
