"""A run in a folder: states, edits, resuming, replaying, and what is remembered of its fits."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.engines.gp import GPEngine
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import TrialState
from fdvv_people.optimize.run.memory import LastResult, RunMemory
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.optimize.space import Design
from fdvv_people.task.score import Objective, Score

TWO = (Objective("asynchrony_ms"), Objective("effort_N_s"))
MIDDLE = paper_space().of_unit([0.5] * 8)[0]


def scored(design: Design) -> dict[str, Score]:
    late_ms = 60.0 + 8.0 * abs(design["actuation_mm"] - 1.0) + design["y1_cN"] / 50.0
    return {"asynchrony_ms": Score(late_ms, 7.0)}


def go_on(session: Optimization, count: int) -> None:
    for _ in range(count):
        (trial,) = session.ask()
        session.show(trial.number)
        session.answer(trial.number, scored(trial.design))


def test_a_run_ends_with_its_budget_and_recommends_a_design(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol", budget=4)) as session:
        with pytest.raises(ModelError):
            session.best()
        go_on(session, 4)
        assert session.finished
        assert session.ask() == ()
        assert session.best() in [trial.design for trial in session.trials]
        assert session.model(session.best(), "mine").name == "mine"


def test_a_trial_is_on_the_disk_before_it_is_given(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="random")) as session:
        (trial,) = session.ask()
        assert repr(trial.design["x1_mm"]) in (tmp_path / "run" / "trials.jsonl").read_text()


@pytest.mark.parametrize("engine", ["sobol", "gp"])
def test_a_run_that_is_closed_and_opened_at_every_step_is_the_same_run(tmp_path: Path, engine: str) -> None:
    setup = OptimizeSetup(engine=engine, budget=14, seed=3)
    with Optimization.create(tmp_path / "whole", setup) as session:
        go_on(session, 14)
        whole = session.trials
    Optimization.create(tmp_path / "pieces", setup).close()
    for _ in range(14):
        with Optimization.open(tmp_path / "pieces") as session:
            session.ask()
        with Optimization.open(tmp_path / "pieces") as session:
            (trial,) = session.ask()
            session.show(trial.number)
        with Optimization.open(tmp_path / "pieces") as session:
            (trial,) = session.ask()
            assert trial.state is TrialState.SHOWN
            session.answer(trial.number, scored(trial.design))
    with Optimization.open(tmp_path / "pieces") as session:
        assert session.trials == whole
    assert replay_differences(tmp_path / "pieces") == ()


def test_a_batch_that_was_half_written_comes_out_as_the_whole_one(tmp_path: Path) -> None:
    setup = OptimizeSetup(engine="gp", seed=1)
    with Optimization.create(tmp_path / "a", setup) as session:
        go_on(session, 11)
        whole = session.ask(3)
    with Optimization.create(tmp_path / "b", setup) as session:
        go_on(session, 11)
        session.ask()
    with Optimization.open(tmp_path / "b") as session:
        assert session.ask(3) == whole
        assert not {trial.number for trial in session.ask()} & {trial.number for trial in whole}


def test_a_suggestion_can_be_edited_until_it_is_shown(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol")) as session:
        (trial,) = session.ask()
        edited = session.edit(trial.number, MIDDLE)
        assert (edited.design, edited.suggested) == (MIDDLE, trial.design)
        with pytest.raises(InputError, match="actuation_mm"):
            session.edit(trial.number, {**MIDDLE, "actuation_mm": 9.0})
        session.show(trial.number)
        with pytest.raises(InputError, match="edited"):
            session.edit(trial.number, MIDDLE)
        session.answer(trial.number, scored(MIDDLE))
    assert replay_differences(tmp_path / "run") == ()


def test_scores_of_every_objective_are_asked_for(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(objectives=TWO)) as session:
        (trial,) = session.ask()
        with pytest.raises(InputError, match="effort_N_s"):
            session.answer(trial.number, scored(trial.design))


def test_a_folder_in_use_or_with_something_in_it_is_refused_in_one_line(tmp_path: Path) -> None:
    setup = OptimizeSetup(engine="sobol")
    with Optimization.create(tmp_path / "run", setup), pytest.raises(InputError, match="another process"):
        Optimization.open(tmp_path / "run")
    with pytest.raises(InputError, match="not empty"):
        Optimization.create(tmp_path / "run", setup)
    with pytest.raises(InputError):
        Optimization.open(tmp_path / "nothing")


def test_a_setup_that_cannot_be_leaves_no_folder(tmp_path: Path) -> None:
    for setup in (OptimizeSetup(engine="annealing"), OptimizeSetup(start={"x1_mm": 0.1})):
        with pytest.raises(InputError):
            Optimization.create(tmp_path / "run", setup)
    assert not (tmp_path / "run").exists()


def test_a_run_states_the_options_whose_defaults_may_change_and_one_that_does_not_has_the_earlier_ones(
    tmp_path: Path,
) -> None:
    with Optimization.create(tmp_path / "new", OptimizeSetup(options={"startup": 2})) as session:
        assert session.setup.options == {"startup": 2, "length": session.space.length}
    with Optimization.create(tmp_path / "other", OptimizeSetup(engine="sobol")) as session:
        assert session.setup.options == {}
    path = tmp_path / "new" / "optimize.json"
    record = json.loads(path.read_text())
    path.write_text(json.dumps({**record, "options": {}}))
    with Optimization.open(tmp_path / "new") as session:
        assert session.engine == GPEngine(startup=5, length=0.2)


def test_comparisons_are_kept_resumed_and_replayed(tmp_path: Path) -> None:
    setup = OptimizeSetup(task="preference", engine="preference", budget=4, seed=2)
    Optimization.create(tmp_path / "run", setup).close()
    for turn in range(4):
        with Optimization.open(tmp_path / "run") as session:
            (pair,) = session.ask()
        with Optimization.open(tmp_path / "run") as session:
            (again,) = session.ask()
            assert again == pair == session.next_trial()
            session.answer(again.number, ((0,), (0, 1), (1,), (0,))[turn])
    with Optimization.open(tmp_path / "run") as session:
        assert session.finished
        assert session.next_trial() is None
        assert session.space.checked(session.best()) == session.best()
        with pytest.raises(InputError, match="say which of its designs is best"):
            session.answer(0, scored(session.trials[0].design))
        with pytest.raises(InputError, match="names no design"):
            session.answer(0, ())
        with pytest.raises(InputError, match="can no longer be edited"):
            session.edit(0, session.trials[0].design)
    assert replay_differences(tmp_path / "run") == ()


def test_lines_are_kept_resumed_and_replayed_and_then_the_result_is_compared(tmp_path: Path) -> None:
    about = {OptimizeSetup.RETEST: 2}
    setup = OptimizeSetup(task="preference", engine="preference-line", budget=3, seed=2, about=about)
    Optimization.create(tmp_path / "run", setup).close()
    for turn in range(3):
        with Optimization.open(tmp_path / "run") as session:
            (line,) = session.ask()
            assert session.left == 2 - turn
        with Optimization.open(tmp_path / "run") as session:
            again = session.next_trial()
            assert again is not None
            assert again == line
            with pytest.raises(InputError, match="has designs 0 to 8, not 9"):
                session.answer(again.number, [9])
            session.answer(again.number, [(8, 0, 3)[turn]])
            assert session.answered == turn + 1
    with Optimization.open(tmp_path / "run") as session:
        assert (session.searched, session.finished) == (True, False)
        assert session.start == session.trials[0].designs[4]
        for _ in range(2):
            (pair,) = session.ask()
            assert sorted(map(str, pair.designs)) == sorted(map(str, (session.start, session.recommended())))
            session.answer(pair.number, [0])
        assert session.ask() == ()
        assert session.finished
        assert session.space.checked(session.best()) == session.best()
    assert replay_differences(tmp_path / "run") == ()


def test_a_recommendation_follows_every_line_that_is_answered(tmp_path: Path) -> None:
    setup = OptimizeSetup(task="preference", engine="preference-line", budget=3, seed=2)
    with Optimization.create(tmp_path / "run", setup) as session:
        assert session.recommended() is None
        for best in (8, 0, 3):
            (line,) = session.ask()
            session.answer(line.number, [best])
            assert session.recommended() == session.best()


def test_a_trial_that_is_scored_has_no_best_design(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol")) as session:
        (trial,) = session.ask()
        with pytest.raises(InputError, match="say its scores"):
            session.answer(trial.number, [0])


@pytest.mark.parametrize(("task", "engine"), [("preference", "gp"), ("temporal-pointing", "preference")])
def test_an_engine_that_reads_other_answers_is_refused(tmp_path: Path, task: str, engine: str) -> None:
    with pytest.raises(InputError, match="reads"):
        Optimization.create(tmp_path / "run", OptimizeSetup(task=task, engine=engine))


def test_several_objectives_have_a_front_and_no_best(tmp_path: Path) -> None:
    setup = OptimizeSetup(engine="gp", objectives=TWO, budget=8)
    with Optimization.create(tmp_path / "run", setup) as session:
        for _ in range(8):
            (trial,) = session.ask()
            effort = Score(trial.design["y2_cN"] / 100)
            session.answer(trial.number, {**scored(trial.design), "effort_N_s": effort})
        with pytest.raises(ModelError, match="front"):
            session.best()
        assert 1 <= len(session.front().trials) <= 8


def test_a_replay_writes_nothing_and_needs_no_lock(tmp_path: Path) -> None:
    with Optimization.create(tmp_path / "run", OptimizeSetup(engine="sobol")) as session:
        session.ask(2)
        before = {path: path.read_bytes() for path in (tmp_path / "run").iterdir()}
        assert replay_differences(tmp_path / "run") == ()
        assert {path: path.read_bytes() for path in (tmp_path / "run").iterdir()} == before


def play(session: Optimization, count: int) -> None:
    for _ in range(count):
        (trial,) = session.ask()
        slow, effort = trial.design["actuation_mm"], trial.design["y1_cN"]
        scores = {"asynchrony_ms": Score(60.0 + 8.0 * slow, 1.0), "effort_N_s": Score(effort / 50.0, 1.0)}
        session.answer(trial.number, scores)


def test_a_result_is_computed_anew_for_other_inputs_and_after_an_error_only() -> None:
    asked: list[int] = []

    def squared(number: int) -> int:
        asked.append(number)
        if number < 0:
            raise ValueError("negative")
        return number**2

    last = LastResult[int]()
    assert [last.of(one, partial(squared, one)) for one in (3, 3, 4, 3)] == [9, 9, 16, 9]
    assert asked == [3, 4, 3]
    for _ in range(2):
        with pytest.raises(ValueError, match="negative"):
            last.of(-1, partial(squared, -1))
    assert asked == [3, 4, 3, -1, -1]


def test_a_run_opened_with_its_memory_has_the_same_front_until_a_trial_is_done(tmp_path: Path) -> None:
    memory, folder = RunMemory(), tmp_path / "run"
    Optimization.create(folder, OptimizeSetup(engine="sobol", objectives=TWO, budget=7)).close()
    with Optimization.open(folder, memory) as session:
        play(session, 6)
        front = session.front()
        session.ask()
    with Optimization.open(folder, memory) as session:
        assert session.front() is front
        play(session, 1)
        longer, found = session.front(), session.recommended()
        assert longer is not front
    with Optimization.open(folder) as session:
        assert (session.front(), session.recommended()) == (longer, found)


def test_a_memory_of_another_run_changes_nothing(tmp_path: Path) -> None:
    memory = RunMemory()
    for seed in (0, 1):
        folder = tmp_path / str(seed)
        Optimization.create(folder, OptimizeSetup(engine="sobol", seed=seed, budget=3)).close()
        with Optimization.open(folder, memory) as session:
            play(session, 3)
            best = session.best()
            assert session.best() is best
        with Optimization.open(folder) as session:
            assert session.best() == best
