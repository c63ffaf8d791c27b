"""A rig's numbers are found again in presses of a plant in closed form, and of the twin."""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from pathlib import Path
