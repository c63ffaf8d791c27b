"""What is seen of a trial while it is shown: when a label was gone to, and how long it all took."""

from __future__ import annotations

from collections.abc import Callable

from fdvv.study import TrialAnswer
from fdvv.workflow._study_people import SealedTrial


class TrialWatch:
    """Watches one trial after the other. clock : wall time in seconds."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._shown_s = clock()
        self._switches: list[tuple[float, str]] = []

    @property
    def felt(self) -> bool:
        """Tell whether any label was felt since the trial was shown."""
        return bool(self._switches)

    def begin(self) -> None:
        """A trial is shown now."""
        self._shown_s, self._switches = self._clock(), []

    def gone_to(self, label: str) -> None:
        """Note that a label is asked for."""
        self._switches.append((self._since_s(), label))

    def whole(self, answer: TrialAnswer, evidence: SealedTrial) -> TrialAnswer:
        """Fill in what an answer does not tell: switches, presses, time."""
        return TrialAnswer(
            choice=answer.choice,
            ratings=answer.ratings,
            switches=answer.switches or tuple(self._switches),
            presses=answer.presses or {one.label: one.presses for one in evidence.rendered},
            time_s=round(answer.time_s or self._since_s(), 2),
        )

    def _since_s(self) -> float:
        return round(self._clock() - self._shown_s, 2)
