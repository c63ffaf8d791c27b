"""The optimisation runs of a project that other programs drive: PROJECT/serve/NAME, one session of each."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from threading import Lock, RLock
from typing import Any

from msgspec import to_builtins

from fdvv.errors import InputError
from fdvv.model.file import builtin_names, load_builtin, model_from_json, model_to_json
from fdvv.model.model import FDVVModel
from fdvv.rendering.rig_catalog import SHIPPED_RIGS
from fdvv_campaigns.serve import answers as a
from fdvv_campaigns.serve import messages as m
from fdvv_people.optimize.engines.registry import engine_names, pair_engine_names, reads_choices
from fdvv_people.optimize.model_space import model_space, neutral_design
from fdvv_people.optimize.problem import PREFERENCE, Trial
from fdvv_people.optimize.run.belief import best_design
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import SETUP_FILE, OptimizeSetup, SpaceSetup, model_space_setup
from fdvv_people.optimize.run.verdict import retest_of
from fdvv_people.task.score import Objective, Score
from fdvv_studio.studio.studio import Studio

FOLDER = "serve"
"""Of a project: runs, and the server's token."""
ERROR = "score_error"
"""Of a setup's `about`: the standard error of every score, where it is known."""
SCORED = "external"
"""Task of a run whose scores another program brings."""


def model_of(studio: Studio, button: m.Button) -> FDVVModel:
    """Return a built-in by its name, a button of the project by its id, or a given model. InputError."""
    if isinstance(button, dict):
        return model_from_json(json.dumps(button), "button")
    return load_builtin(button) if button in builtin_names() else studio.catalog.model(button)


class Runs:
    """Runs by name. Any thread may call; calls of one run are done one after the other."""

    def __init__(self, studio: Studio) -> None:
        self._studio, self._folder = studio, studio.project / FOLDER
        self._open: dict[str, tuple[Optimization, RLock]] = {}
        self._lock = Lock()

    def names(self) -> tuple[str, ...]:
        return tuple(sorted(path.parent.name for path in self._folder.glob(f"*/{SETUP_FILE}")))

    def answer(self, ask: m.Request) -> object:
        """Do what a request of RUN_REQUESTS asks. FdvvError, OSError."""
        if isinstance(ask, m.BeginRun):
            return self._begin(ask)
        assert isinstance(ask, m.OfRun)
        with self._session(ask.run) as run:
            return ANSWERS[type(ask)](run, ask)

    def close(self) -> None:
        with self._lock:
            for run, _ in self._open.values():
                run.close()
            self._open.clear()

    def _begin(self, ask: m.BeginRun) -> a.RunStatus:
        setup = setup_of(ask, self._studio)
        folder = self._folder / ask.run
        with self._lock:
            if folder.exists():
                reason, remedy = "there is a run of this name", "resume it, or choose another name"
                raise InputError("optimize.begin", "run", reason, remedy)
            self._open[ask.run] = (Optimization.create(folder, setup), RLock())
        with self._session(ask.run) as run:
            return status_of(run)

    @contextmanager
    def _session(self, name: str) -> Iterator[Optimization]:
        with self._lock:
            if name not in self._open:
                if name not in self.names():
                    reason, remedy = f"there is no run {name!r}", "begin it"
                    raise InputError("optimize", "run", reason, remedy)
                self._open[name] = (Optimization.open(self._folder / name), RLock())
            run, lock = self._open[name]
        with lock:
            yield run


def setup_of(ask: m.BeginRun, studio: Studio) -> OptimizeSetup:
    """Return the setup of a new run. Raises InputError, ModelError."""
    if bool(ask.parameters) == (ask.button is not None):
        reason, remedy = "a run has either own parameters or a button", "give one of the two"
        raise InputError("optimize.begin", "parameters", reason, remedy)
    if ask.within is not None and ask.within not in SHIPPED_RIGS:
        reason, remedy = f"is no rig: {ask.within[:60]!r}", f"use {', '.join(SHIPPED_RIGS)}"
        raise InputError("optimize.begin", "within", reason, remedy)
    known = (*engine_names(), *pair_engine_names())
    if ask.engine not in known:
        reason, remedy = f"no engine is called {ask.engine[:60]!r}", f"use one of {', '.join(known)}"
        raise InputError("optimize.begin", "engine", reason, remedy)
    space, start = _space(ask, studio)
    return OptimizeSetup(
        space=space,
        engine=ask.engine,
        task=PREFERENCE if reads_choices(ask.engine) else SCORED,
        objectives=(Objective(ask.objective, ask.goal == "maximise"),),
        seed=ask.seed,
        budget=ask.budget,
        start=start,
        about={ERROR: ask.error, OptimizeSetup.RETEST: ask.retest},
    )


def _space(ask: m.BeginRun, studio: Studio) -> tuple[SpaceSetup, dict[str, float] | None]:
    if ask.button is None:
        if ask.bounds is not None or ask.within is not None:
            reason, remedy = "belongs to a button", "leave it out, or give a button"
            raise InputError("optimize.begin", "bounds" if ask.bounds else "within", reason, remedy)
        return SpaceSetup("own", parameters=tuple(map(replace, ask.parameters))), ask.start
    base = model_of(studio, ask.button)
    rig = None if ask.within is None else f"shipped:{ask.within}"
    setup = model_space_setup(base, ask.vary, ask.bounds, rig)
    neutral = neutral_design(model_space(base, ask.vary, setup.bounds), base)
    return setup, ask.start or neutral


def status_of(run: Optimization, _ask: object = None) -> a.RunStatus:
    setup, objective = run.setup, run.problem.objectives[0]
    return a.RunStatus(
        run.folder.name,
        setup.engine,
        setup.preference,
        run.space.parameters,
        objective.name,
        "maximise" if objective.larger_is_better else "minimise",
        setup.budget,
        run.left,
        run.answered,
        run.finished,
    )


def _model(run: Optimization, design: dict[str, float] | None) -> dict[str, Any] | None:
    """Return the button of a design as its file says; None of numbers of the client's own."""
    if design is None or run.setup.space.kind == "own":
        return None
    record: dict[str, Any] = json.loads(model_to_json(run.model(design)))
    return record


def _ask(run: Optimization, _ask: m.AskDesign) -> a.Suggestion:
    """Return the trial that is open, else the next one of the search, else of the retest."""
    if run.setup.preference:
        raise InputError("run", "task", "designs of this run are compared", "ask for comparisons instead")
    trial = run.next_trial()
    if trial is None:
        return a.Suggestion(None, {}, None, run.left, run.finished)
    return a.Suggestion(trial.number, trial.design, _model(run, trial.design), run.left, False)


def _tell(run: Optimization, ask: m.TellOutcome) -> a.RunStatus:
    """Record an outcome; the same one again, from a client that missed the answer, changes nothing."""
    scored = ask.outcome == "done"
    if scored != (ask.score is not None):
        reason = "is missing" if scored else f"does not go with {ask.outcome}"
        raise InputError("optimize.tell", "score", reason, "score what is done, and nothing else")
    before = run.trial(ask.trial)
    if before is not None and _is(before, run, ask):
        return status_of(run)
    if ask.score is not None:
        run.answer(ask.trial, {run.problem.objectives[0].name: _score(run, ask)})
    else:
        run.give_up(ask.trial, ask.reason, failed=ask.outcome == "failed")
    return status_of(run)


def _score(run: Optimization, ask: m.TellOutcome) -> Score:
    assert ask.score is not None
    return Score(ask.score, run.setup.about.get(ERROR) if ask.error is None else ask.error)


def _is(trial: Trial, run: Optimization, ask: m.TellOutcome) -> bool:
    if trial.state != ask.outcome:
        return False
    return ask.score is None or trial.scores == {run.problem.objectives[0].name: _score(run, ask)}


def _best(run: Optimization, _ask: m.BestOfRun) -> a.Best:
    best, retest = best_design(run), retest_of(run)
    return a.Best(
        **vars(best),
        model=_model(run, best.design),
        retest=None if retest is None else a.RetestFound(**to_builtins(retest)),
    )


def _compare(run: Optimization, _ask: m.AskPair) -> a.Pair:
    if not run.setup.preference:
        raise InputError("run", "task", "designs of this run are scored", "ask for trials instead")
    trial = run.next_trial()
    if trial is None:
        return a.Pair(None, {}, {}, None, None, run.left, run.finished)
    first, second = trial.designs
    return a.Pair(trial.number, first, second, _model(run, first), _model(run, second), run.left, False)


def _prefer(run: Optimization, ask: m.TellAnswer) -> a.RunStatus:
    trial = run.trial(ask.pair)
    if trial is None or trial.answer is not ask.answer:
        run.answer(ask.pair, ask.answer.best)
    return status_of(run)


ANSWERS: dict[type[m.Request], Callable[[Optimization, Any], object]] = {
    m.ResumeRun: status_of,
    m.AskDesign: _ask,
    m.TellOutcome: _tell,
    m.BestOfRun: _best,
    m.AskPair: _compare,
    m.TellAnswer: _prefer,
}
"""What answers a request about a run."""
