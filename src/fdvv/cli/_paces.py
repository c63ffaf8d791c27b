"""Speeds as an option of a command."""

from __future__ import annotations

import math
from typing import Any

import click


class Paces(click.ParamType[tuple[float, ...]]):
    """Speeds with commas between them."""

    name = "mm/s,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, ...]:
        """Read the speeds, or refuse them."""
        if isinstance(value, tuple):
            return value
        try:
            found = tuple(float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r} must be speeds with commas between them, as 50,100", param, ctx)
        if not all(math.isfinite(v) and 20 <= v <= 500 for v in found) or len(set(found)) != len(found):
            self.fail(f"{value!r} must be different speeds of 20 to 500 mm/s", param, ctx)
        return found
