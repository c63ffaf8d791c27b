"""What the paper measured with people, cited beside a study's own figures.

Liao, Kim, Lee, Oulasvirta, "Button Simulation and Design via FDVV Models" (CHI 2020), "Human-in-the-loop
button optimization": 10 participants, mean asynchrony in ms with "STD", which the paper does not define.
"""

from __future__ import annotations

from fdvv_people.study.timing.plan import Condition

SOURCE = "Liao, Kim, Lee, Oulasvirta, CHI 2020: 10 people, 240 observations; its STD is not defined there"
PEOPLE = 10
MEANS_ms: dict[str, dict[str, tuple[float, float]]] = {
    "easy": {
        "optimised": (65.8, 6.15),
        "mx-clear": (83.6, 7.65),
        "mx-brown": (88.04, 7.82),
        "mx-black": (81.65, 6.19),
        "mx-red": (84.28, 6.75),
        "random": (100.78, 6.89),
    },
    "hard": {
        "optimised": (77.3, 6.89),
        "mx-clear": (93.43, 7.56),
        "mx-brown": (97.48, 7.69),
        "mx-black": (96.9, 7.61),
        "mx-red": (96.65, 6.36),
        "random": (108.22, 8.77),
    },
}
"""Mean and STD by level and button."""
BUTTON_EFFECT = "F(5, 95) = 10.724, p < .001"
"""The main effect of button; 95 degrees of freedom count every round as another person."""
CLAIMED_TAPS_Hz = 8.0
"""Of its fast-tapping button."""


def cited(condition: Condition, level: str) -> tuple[float, float] | None:
    """Return the paper's mean and STD of a condition; None of one that it did not have."""
    name = condition.kind if condition.kind in ("optimised", "random") else condition.button
    return MEANS_ms.get(level, {}).get(name)
