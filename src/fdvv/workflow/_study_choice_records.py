"""What an analysis found of choices, and of the main claim, as records."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from fdvv.study import Claim, DPrime, Share, SignedRank, SignTest


@dataclass(frozen=True)
class ChoiceResult:
    """What was chosen: more, less or neither; or how often an answer was right and wrong.

    Attributes
    ----------
    button : ALL_BUTTONS for all. missing : trials without an answer. share : of more among all answers, every
        answer counted as independent. people_share : the same, people counted as people; None of one person.
    split : ties counted as halves. dropped : ties left out; None where nothing else is left.
    test : of people's share less one half, ties as halves; None of one person. sign : people on each side.
    p_holm : of test's exact p, for all buttons. d : distance felt, by each rule; the first is reported.
    """

    button: str
    more: str
    less: str
    more_count: int
    equal_count: int
    less_count: int
    missing: int
    share: Share
    people_share: Share | None
    split: float
    dropped: Share | None
    test: SignedRank | None
    sign: SignTest
    p_holm: float | None
    d: tuple[DPrime, ...]

    @property
    def interval(self) -> Share:
        """Get the share with the interval that is reported: that of people where there are some."""
        return self.people_share or self.share

    def to_dict(self) -> dict[str, Any]:
        """Give every figure, the reported share and interval first."""
        told = self.interval
        return {
            "button": self.button,
            "share": told.share,
            "low": told.low,
            "high": told.high,
            "method": told.method,
            "more": {"name": self.more, "count": self.more_count},
            "less": {"name": self.less, "count": self.less_count},
            "equal": self.equal_count,
            "missing": self.missing,
            "answers": self.share.n,
            "as_independent": asdict(self.share),
            "icc": told.icc,
            "ties_split": self.split,
            "ties_dropped": self.dropped and asdict(self.dropped),
            "test": self.test and asdict(self.test),
            "sign": asdict(self.sign),
            "p_holm": self.p_holm,
            "d_prime": [asdict(one) for one in self.d],
        }


@dataclass(frozen=True)
class ClaimResult:
    """The main claim.

    Attributes
    ----------
    registered : it was fixed in a plan; else it is the kind's usual one. measure : what it was tested on.
    test : of people's means. p_exact below claim.alpha and an effect above 0 support it.
    """

    claim: Claim
    registered: bool
    measure: str
    test: SignedRank

    @property
    def supported(self) -> bool:
        """Tell whether the answers support the claim."""
        return self.test.p_exact < self.claim.alpha and self.test.effect > 0

    @property
    def opposed(self) -> bool:
        """Tell whether they say the opposite."""
        return self.test.p_exact < self.claim.alpha and self.test.effect < 0
