"""How a run ends beside its verdict: its result against the best switch and the best fixed design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.blocks import Block
from fdvv_people.optimize.run.rivals import FIXED
from fdvv_people.optimize.run.state import RunState
from fdvv_people.optimize.run.verdict import Kind, Phrase, Retest, gains, kind_of, paired, phrase_of, scored
from fdvv_people.stats.best_of import against_best
from fdvv_people.task.score import Objective


@dataclass(frozen=True)
class AgainstSwitches:
    """How much better the recommended design is than the best of the switches, all played blind in blocks.

    Attributes
    ----------
    switches : compared. left_out : those that could never be scored. best : had the best mean.
    blocks : in which all were scored. difference : to that best one, positive where the design is better.
    low, high, chance : to the true best, whichever it is, see `against_best`.
    """

    switches: tuple[str, ...]
    left_out: tuple[str, ...]
    best: str
    blocks: int
    difference: float
    low: float
    high: float
    chance: float

    @property
    def kind(self) -> Kind:
        return kind_of(self.low, self.high)


@dataclass(frozen=True)
class FinalMean:
    """What was played at the end, by name, and its mean score; None where no trial of it was scored.

    means : by objective, the first one's is mean.
    """

    name: str
    trials: int
    mean: float | None
    means: dict[str, float | None]


def against_switches(session: RunState, objective: Objective | None = None) -> AgainstSwitches | None:
    """Return what the end of a run says of the best switch; None without two whole blocks with one.

    objective : in which; None: the first. The best switch of another may be another one.
    """
    blocks, objective = session.blocks, objective or session.problem.objectives[0]
    columns = {name: [_switch(session, block, name) for block in blocks] for name in _switches(session)}
    played = [name for name, trials in columns.items() if any(map(scored, trials))]
    rows = list(zip([block.found for block in blocks], *(columns[name] for name in played), strict=True))
    values = [[objective.sign * -t.scores[objective.name].value for t in row] for row in rows if scored(*row)]
    found = against_best(np.array(values)) if played and values else None
    if found is None:
        return None
    left_out = tuple(name for name in columns if name not in played)
    return AgainstSwitches(
        tuple(played),
        left_out,
        played[found.best],
        found.blocks,
        found.difference,
        found.low,
        found.high,
        found.chance,
    )


def _switches(session: RunState) -> Iterator[str]:
    """List the switches but one that is itself recommended."""
    for rival in session.setup.rivals:
        if rival.kind == "switch" and not (
            rival.design is not None and rival.design == session.start == session.recommended()
        ):
            yield rival.name


def _switch(session: RunState, block: Block, name: str) -> Trial:
    # the one that a run starts from has no trial of its own
    return block.rivals.get(name, block.start)


def against_fixed(session: RunState, objective: Objective | None = None) -> Retest | None:
    """Return how much better the result is than the best fixed design; None without two pairs of them."""
    name = next((one.name for one in session.setup.rivals if one.kind == "fixed"), "")
    pairs = [(block.found, block.rivals[name]) for block in session.blocks if name in block.rivals]
    return paired(gains(session, pairs, objective))


def final_means(session: RunState) -> tuple[FinalMean, ...]:
    """Return the mean of everything that was played at the end, the recommended design first."""
    blocks, name = session.blocks, session.setup.start_name
    if not blocks:
        return ()
    columns: dict[str, list[Trial]] = {"recommended": [block.found for block in blocks]}
    if blocks[0].start is not blocks[0].found:
        columns[name] = [block.start for block in blocks]
    for rival in session.setup.rivals:
        if rival.name in blocks[0].rivals:
            columns[rival.name] = [block.rivals[rival.name] for block in blocks]
    return tuple(_mean(session, name, trials) for name, trials in columns.items())


def _mean(session: RunState, name: str, trials: Sequence[Trial]) -> FinalMean:
    objectives = [one.name for one in session.problem.objectives]
    done = [trial.scores for trial in trials if scored(trial)]
    means = {
        objective: float(np.mean([scores[objective].value for scores in done])) if done else None
        for objective in objectives
    }
    return FinalMean(name, len(done), means[objectives[0]], means)


def ending_sentences(session: RunState) -> tuple[str, ...]:
    """Return what a finished run says beside its verdict: of the best switch, then of the fixed design.

    Of several objectives every one is said by itself, and what to take is left to the reader.
    """
    if not session.finished:
        return ()
    return tuple(said for one in session.problem.objectives for said in _sentences(session, one))


def _sentences(session: RunState, objective: Objective) -> Iterator[str]:
    phrase, several = phrase_of(session, objective), session.setup.several
    before = f"{phrase.what.capitalize()}: " if several else ""
    if switches := against_switches(session, objective):
        yield before + _of_switches(switches, phrase, _played(session), advise=not several)
    if fixed := against_fixed(session, objective):
        yield before + _of_fixed(fixed, phrase, _played(session), advise=not several)


def beaten_by(session: RunState) -> str | None:
    """Return the switch that is better than the result, else the fixed design if that is; None of neither.

    None where there are several objectives: what is better in one may be worse in another.
    """
    if session.setup.several:
        return None
    switches, fixed = against_switches(session), against_fixed(session)
    if switches and switches.kind == "worse":
        return switches.best
    return FIXED if fixed and fixed.kind == "worse" else None


def _of_switches(found: AgainstSwitches, phrase: Phrase, played: str, advise: bool) -> str:
    doubt = phrase.doubt(found.low, found.high, found.chance)
    count = len(found.switches)
    which = f"the best of {count} switches, {found.best}" if count > 1 else f"the switch {found.best}"
    gone = f" Never scored: {', '.join(found.left_out)}." if found.left_out else ""
    by = "no difference found" if found.kind == "same" else phrase.difference(found.difference)
    end = f"; take {found.best}" if found.kind == "worse" and advise else ""
    return f"Against {which}: {by} {doubt}{played}{end}.{gone}"


def _of_fixed(found: Retest, phrase: Phrase, played: str, advise: bool) -> str:
    doubt, by = phrase.doubt(found.low, found.high, found.chance), phrase.difference(found.difference)
    if found.kind == "better":
        return f"The fixed design would not have done: this one is {by} {doubt}{played}."
    if found.kind == "same":
        return f"The fixed design would have done: no difference found {doubt}{played}."
    end = "; take the fixed one" if advise else ""
    return f"The fixed design would have done: this one is {by} {doubt}{played}{end}."


def _played(session: RunState) -> str:
    return ", simulated" if session.setup.simulated else ""


def final_report(session: RunState) -> Mapping[str, object]:
    """Return the end of a run by name, as ``--json`` prints it."""
    switches, fixed = against_switches(session), against_fixed(session)
    return {
        "against_switches": asdict(switches) if switches else None,
        "against_fixed": asdict(fixed) if fixed else None,
        "final_means": [asdict(one) for one in final_means(session)],
        "ending": list(ending_sentences(session)),
    }
