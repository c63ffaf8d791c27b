"""The small program of a force that grows in time, wherever the cap is."""

from __future__ import annotations

from dataclasses import replace

from fdvv.program.compile import compile_program
from fdvv.program.program import Program, State
from fdvv.program.surface import Limits, Surface
from fdvv.protocol.tables import Settings


def force_ramp_image(
    settings: Settings, travel_mm: float, start_cN: float, end_cN: float, span_s: float
) -> bytes:
    """Return a program whose force goes from one to the other in that time, wherever the cap is."""
    flat = Surface("flat", (0.0, travel_mm), ((0.0, 0.0),))
    span_ms = round(1e3 * span_s)
    state = State(
        "push", "flat", "flat", bias_cN=start_cN, bias_end_cN=end_cN if span_ms else 0.0, bias_ms=span_ms
    )
    limits = replace(Limits(), settings=settings, weight_cN=0.0, counts_per_m_s2=1.0)
    return compile_program(Program("force", travel_mm, "push", (state,), (flat,)), limits).image
