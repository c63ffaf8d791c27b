"""From a model to a real switch: springs, leaves on cams and domes that give its curves."""

from fdvv.mechanism._coil import Coil
from fdvv.mechanism._coil_choice import Envelope, choose_coil
from fdvv.mechanism._dome import Dome, DomeMechanism, Pin, cone_force_N
from fdvv.mechanism._guide import Guide
from fdvv.mechanism._leaf import Cam, Leaf, LeafMechanism
from fdvv.mechanism._leaf_choice import choose_leaf
from fdvv.mechanism._making import Making
from fdvv.mechanism._material import STRIPS, WIRES, hardness_shoreA, rubber_MPa
from fdvv.mechanism._mechanism import KINDS, Mechanism, design, varied
from fdvv.mechanism._residual import WANTED_cN, Miss, Residual, miss_of, residual_of
from fdvv.mechanism._spring import SpringMechanism
from fdvv.mechanism._target import SEATED_mm, STOP_mm, Target, target_of
from fdvv.mechanism._tolerance import Band, Share, Tolerance, band_of, bump_of, tolerances_of

__all__ = [
    "KINDS",
    "SEATED_mm",
    "STOP_mm",
    "STRIPS",
    "WANTED_cN",
    "WIRES",
    "Band",
    "Cam",
    "Coil",
    "Dome",
    "DomeMechanism",
    "Envelope",
    "Guide",
    "Leaf",
    "LeafMechanism",
    "Making",
    "Mechanism",
    "Miss",
    "Pin",
    "Residual",
    "Share",
    "SpringMechanism",
    "Target",
    "Tolerance",
    "band_of",
    "bump_of",
    "choose_coil",
    "choose_leaf",
    "cone_force_N",
    "design",
    "hardness_shoreA",
    "miss_of",
    "residual_of",
    "rubber_MPa",
    "target_of",
    "tolerances_of",
    "varied",
]
