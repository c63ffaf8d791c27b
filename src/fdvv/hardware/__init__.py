"""The rig as things to make and buy: parts, circuit, bill of materials, and which part is wrong."""

from fdvv.hardware._diagnosis import Bounds, Diagnosis, Finding, Verdict, diagnose
from fdvv.hardware._evidence import GAUGES_mm, WEIGHT_g, Evidence, Latched, Lift

__all__ = ["GAUGES_mm", "WEIGHT_g", "Bounds", "Diagnosis", "Evidence", "Finding", "Latched", "Lift", "Verdict", "diagnose"]
