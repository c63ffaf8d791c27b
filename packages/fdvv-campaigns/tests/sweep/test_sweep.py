"""A sweep on cells: planned, shared out, killed, resumed; the same rows every time. Simulated."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.device.twin import TwinDevice
from fdvv.errors import BuildError, InputError
from fdvv.model.file import load_builtin
from fdvv.parallel.open import open_executor
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger
from fdvv_campaigns.sweep.measure import JUDGE, LEARN
from fdvv_campaigns.sweep.measure import MEASURES as SWEEP_MEASURES
from fdvv_campaigns.sweep.plan import FIRST, LAST, SweepPlan, read_sweep_plan, sweep_schema, sweep_work
from fdvv_campaigns.sweep.sweep import RESULTS, run_sweep, sweep_summary
from fdvv_people.optimize.population.plan import seed_of
from tests.support.deadly_work import DeadlyCells
from tests.support.executors import Here

REFERENCE = Path(__file__).resolve().parents[4] / "docs" / "reference" / "sweep-files.md"
PRESS = SweepPlan(
    format="fdvv-sweep",
    version=1,
    measure="press",
    seed=5,
    factors={"button": ["mx-clear", "mx-red"], "speed_mm_s": [50.0, 150.0], "finger": {"draw": 2}},
    settings={"presses": 1},
)


def plan_with(**changed: Any) -> SweepPlan:
    return msgspec.structs.replace(PRESS, **changed)


@pytest.fixture(scope="module")
def pressed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sweep") / "press"
    run_sweep(PRESS, folder, Here())
    return folder


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str], Path]:
    def written(text: str) -> Path:
        path = tmp_path / "plan.toml"
        path.write_text(f'format = "fdvv-sweep"\nversion = 1\n{text}')
        return path

    return written


def test_every_combination_is_one_row_in_the_order_of_the_factors(pressed: Path) -> None:
    rows = pq.read_table(pressed / RESULTS).to_pylist()
    assert [row["cell"] for row in rows] == list(range(8))
    assert len({(row["button"], row["speed_mm_s"], row["finger"]) for row in rows}) == 8
    assert [row["finger"] for row in rows[:4]] == ["drawn:0", "drawn:1"] * 2
    assert {row["repeat"] for row in rows} == {0}
    assert {row["state"] for row in rows} == {"done"}
    assert all(row["simulated"] for row in rows)


def test_figures_are_those_of_the_measure_itself(pressed: Path) -> None:
    rows = pq.read_table(pressed / RESULTS).to_pylist()
    slow, fast = (
        np.median([row["achieved_mm_s"] for row in rows if row["speed_mm_s"] == speed])
        for speed in (50.0, 150.0)
    )
    assert 35 < slow < 70 < fast
    assert {row["quasi_static_peak_cN"] for row in rows if row["button"] == "mx-red"} != {
        row["quasi_static_peak_cN"] for row in rows if row["button"] == "mx-clear"
    }
    assert all(row["closed_ratio"] in (0.0, 1.0) for row in rows)


@pytest.mark.slow
def test_a_cell_learns_and_is_judged_as_by_hand(tmp_path: Path) -> None:
    settings = {"velocities_mm_s": [100], "presses": 1, "rounds": 1}
    plan = plan_with(measure="probe", factors={"rig": ["ideal"]}, settings=settings)
    (row,) = run_sweep(plan, tmp_path / "run", Here()).table().to_pylist()
    rig, model, seed = load_rig("ideal"), load_builtin("mx-clear"), seed_of(5, 0)
    from fdvv.compensation.rig_aware import RigAware

    learned = compensate(TwinDevice(rig, Finger(), seed_of(seed, LEARN)), model, [100], RigAware(1))
    judge = TwinDevice(rig, Finger(), seed_of(seed, JUDGE))
    found = probe(judge, model, learned.surface, [100], 1, tuning=learned.outcome.tuning)
    errors = [curve.outcome.mean_error_cN for curve in found.curves]
    assert row["mean_error_cN"] == pytest.approx(np.mean(errors), abs=1e-12)
    assert row["worst_mean_error_cN"] == max(errors)
    assert row["learning_presses"] == learned.presses
    assert row["method"] == "rig-aware"  # what the plan leaves out stands in the row all the same


@pytest.mark.slow
def test_the_lighter_rig_is_reported_as_closer_and_an_impossible_one_with_the_reason(tmp_path: Path) -> None:
    factors: dict[str, Any] = {"rig": ["default", "light"], "rig.coil.force_constant_N_A": [3.9, 0.1]}
    plan = plan_with(measure="feasible", factors=factors, settings={"velocities_mm_s": [50]})
    rows = run_sweep(plan, tmp_path / "run", Here()).table().to_pylist()
    assert [row["state"] for row in rows] == ["done", "failed", "done", "failed"]
    assert rows[2]["expected_error_cN"] < 0.5 * rows[0]["expected_error_cN"]
    assert rows[2]["verdict"] in ("can follow", "follows in part")
    # too weak to lift its own cap: nobody can press it
    assert all("presses in a row could not be used" in row["reason"] for row in rows[1::2])


def test_a_failed_cell_is_a_row_with_its_reason_and_costs_no_other(tmp_path: Path) -> None:
    # a settings' speed that no stroke can reach: the cell cannot be pressed at it
    plan = plan_with(factors={"button": ["mx-clear"], "speed_mm_s": [100.0, -1.0]})
    result = run_sweep(plan, tmp_path / "run", Here())
    good, bad = result.table().to_pylist()
    assert (result.failed, good["state"], bad["state"]) == (1, "done", "failed")
    assert "speeds cannot be [-1.0] mm/s" in bad["reason"] == result.first_reason()
    assert bad["closing_ms"] is None


def test_a_sweep_that_is_stopped_goes_on_and_ends_the_same(
    pressed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv_campaigns.sweep.sweep.CHUNK_s", 0.1)  # two cells a chunk
    done_counts: list[int] = []

    def stop(done: int, _whole: int) -> None:
        done_counts.append(done)
        if done == 4 and len(done_counts) < 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_sweep(PRESS, tmp_path / "run", Here(), stop)
    result = run_sweep(PRESS, tmp_path / "run", Here(), stop)
    assert done_counts == [0, 2, 4, 4, 6, 8]
    assert (result.cells, result.worked) == (8, 4)
    assert (tmp_path / "run" / RESULTS).read_bytes() == (pressed / RESULTS).read_bytes()


def test_a_finished_sweep_is_read_without_any_work(pressed: Path) -> None:
    result = run_sweep(PRESS, pressed, Here(), work=DeadlyCells(sweep_work(PRESS, Path()), fatal=0))
    assert result.worked == 0


def test_another_plan_in_the_same_folder_is_refused(pressed: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="other seed"):
        run_sweep(plan_with(seed=6), pressed, Here())
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(InputError, match="is not empty"):
        run_sweep(PRESS, tmp_path, Here())


def test_a_sweep_of_an_earlier_version_goes_on_under_the_present_name_of_its_rig(tmp_path: Path) -> None:
    plan = plan_with(measure="feasible", factors={}, settings={"velocities_mm_s": [50.0]})
    first = run_sweep(plan, tmp_path / "run", Here())
    begun = tmp_path / "run" / "sweep.json"
    text = begun.read_text()
    assert "rig voltage" in text
    begun.write_text(text.replace("rig voltage", "rig default"))
    again = run_sweep(plan, tmp_path / "run", Here())
    assert (first.worked, again.worked) == (1, 0)
    begun.write_text(begun.read_text().replace('"rig default": "', '"rig default": "0'))
    with pytest.raises(InputError, match="other files"):
        run_sweep(plan, tmp_path / "run", Here())


def test_files_of_a_plan_that_changed_are_noticed(tmp_path: Path) -> None:
    from fdvv.twin.files import finger_to_toml

    plan = plan_with(factors={"finger": ["mine.toml"]})
    path = tmp_path / "mine.toml"
    path.write_text(finger_to_toml(Finger()))
    run_sweep(plan, tmp_path / "run", Here(), beside=tmp_path)
    path.write_text(path.read_text().replace("mass_kg = 0.0", "mass_kg = 0.00"))
    with pytest.raises(InputError, match="other files"):
        run_sweep(plan, tmp_path / "run", Here(), beside=tmp_path)


def test_cells_of_one_repeat_share_their_seed_and_repeats_do_not(tmp_path: Path) -> None:
    plan = plan_with(factors={"speed_mm_s": [100.0, 120.0], "repeat": 2})
    rows = run_sweep(plan, tmp_path / "run", Here()).table().to_pylist()
    assert [row["seed"] == rows[0]["seed"] for row in rows] == [True, False, True, False]
    assert rows[0]["largest_cN"] != rows[1]["largest_cN"]


def test_columns_are_those_of_the_document(pressed: Path) -> None:
    assert pq.read_schema(pressed / RESULTS).equals(sweep_schema(PRESS))
    text = REFERENCE.read_text()
    for name, kind, meaning in (*FIRST, *LAST):
        assert f"| `{name}` | {kind} | {meaning} |" in text
    for name, measure in SWEEP_MEASURES.items():
        assert f"`{name}`: {measure.about}" in text
        for figure in measure.figures:
            assert f"| `{figure.name}` | {figure.type} | {figure.meaning} |" in text
        for factor in (*measure.factors, *measure.settings):
            assert f"`{factor}`" in text


def test_a_summary_tells_medians_by_every_factor_that_varies(pressed: Path) -> None:
    result = run_sweep(PRESS, pressed, Here())
    summary = {part["factor"]: part for part in sweep_summary(result)}
    assert set(summary) == {"button", "speed_mm_s", "finger"}
    rows = pq.read_table(pressed / RESULTS).to_pylist()
    times = [row["closing_ms"] for row in rows if row["speed_mm_s"] == 50.0]
    summary_row = summary["speed_mm_s"]["rows"][0]
    assert summary_row["median"] == pytest.approx(np.median([t for t in times if t is not None]))
    assert summary_row["cells"] == len(times)


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.integers(2, 50), st.sampled_from(["even", "ratio"]))
def test_a_range_begins_and_ends_where_it_says(start: float, end: float, count: int, spacing: str) -> None:
    factor: dict[str, Any] = {"start": start, "end": end, "count": count, "spacing": spacing}
    plan = plan_with(factors={"speed_mm_s": factor})
    if spacing == "ratio" and min(start, end) <= 0:
        with pytest.raises(ValueError, match="above 0"):
            plan.levels()
        return
    values = plan.levels()["speed_mm_s"]
    assert len(values) == count
    assert values[0] == pytest.approx(start)
    assert values[-1] == pytest.approx(end)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('measure = "weigh"', "use one of probe, feasible, press"),
        ('measure = "press"\n[factors]\nbuton = ["mx-red"]', "did you mean button"),
        ('measure = "press"\n[factors]\nbutton = []', "no values"),
        ('measure = "press"\n[factors]\nbutton = ["mx-red", "mx-red"]', "a value repeats"),
        ('measure = "press"\n[factors]\nbutton = [3]', "names are needed"),
        ('measure = "press"\n[factors]\nbutton = "mx-red"', "factors"),
        ('measure = "press"\n[factors]\nspeed_mm_s = ["fast"]', "numbers are needed"),
        ('measure = "probe"\n[factors]\n"rig.coil.drive" = ["voltage", 3]', "names are needed"),
        ('measure = "press"\n[factors]\nrepeat = 0', "0 repeats"),
        ('measure = "press"\n[factors]\nbutton = {draw = 3}', "only rigs and fingers"),
        ('measure = "press"\n[factors]\nspeed_mm_s = {start = 1, end = 2, cuont = 3}', "cuont"),
        ('measure = "press"\n[factors]\nmethod = ["none"]', "unknown: method"),
        ('measure = "press"\n[settings]\npreses = 3', "did you mean presses"),
        ('measure = "press"\n[factors]\nrepeat = 100000\nspeed_mm_s = {start = 1, end = 2, count = 1000}',
         "100000000 cells"),
        ("measure = ", "TOML"),
    ],
)  # fmt: skip
def test_a_plan_that_cannot_be_is_refused_with_its_place(
    write: Callable[[str], Path], text: str, said: str
) -> None:
    path = write(text)
    with pytest.raises(InputError, match=said) as refused:
        read_sweep_plan(path)
    assert refused.value.source == str(path)


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        ({"rig": ["nowhere.toml"]}, "nowhere.toml"),
        ({"rig": ["drawn:many"]}, "drawn:many"),
        ({"button": ["mx-pink"]}, "mx-pink"),
        ({"method": ["magic"]}, "use one of none, rig-aware"),
        ({"rig.coil.colour": [1.0]}, "there is no parameter rig.coil.colour"),
        ({"rig.coil.force_constant_N_A": [3.0, -3.0]}, "must be 0.1 to 100 N/A"),
    ],
)
def test_what_a_plan_names_is_opened_before_any_work(
    tmp_path: Path, factors: dict[str, Any], said: str
) -> None:
    plan = plan_with(measure="probe", factors=factors, settings={})
    with pytest.raises(InputError, match=said):
        run_sweep(plan, tmp_path / "run", Here())
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("settings", [{"presses": 0}, {"presses": 1.5}, {"presses": True}])
def test_a_setting_out_of_bounds_is_refused(settings: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"settings\.presses"):
        sweep_work(plan_with(settings=settings), Path())


def test_without_the_extra_one_line_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(BuildError, match=r'pip install "fdvv\[sweep\]"'):
        run_sweep(PRESS, tmp_path / "run", Here())


@pytest.mark.slow
@pytest.mark.parametrize("options", [{"processes": 2}, {"workers": 2}], ids=["processes", "dask"])
def test_whoever_works_on_it_the_rows_are_the_same_to_the_bit(
    pressed: Path, tmp_path: Path, options: dict[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv_campaigns.sweep.sweep.CHUNK_s", 0.1)
    with open_executor(options.get("processes"), options.get("workers")) as executor:
        run_sweep(PRESS, tmp_path / "run", executor)
    assert (tmp_path / "run" / RESULTS).read_bytes() == (pressed / RESULTS).read_bytes()


@pytest.mark.slow
def test_a_cell_that_ends_its_process_is_a_failed_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdvv.parallel.executor.TRIES", 1)
    work = DeadlyCells(sweep_work(PRESS, Path()), fatal=3)
    with open_executor(processes=2) as executor:
        result = run_sweep(PRESS, tmp_path / "run", executor, work=work)
    rows = result.table().to_pylist()
    assert [row["cell"] for row in rows if row["state"] == "failed"] == [3]
    assert "look for a lack of memory" in rows[3]["reason"]


RUN = """
import sys
from pathlib import Path
import fdvv_campaigns.sweep.sweep as sweep
from fdvv.parallel.open import open_executor
from fdvv_campaigns.sweep.plan import read_sweep_plan
if __name__ == "__main__":
    plan, folder = map(Path, sys.argv[1:])
    sweep.CHUNK_s = 0.05
    with open_executor(processes=2) as executor:
        sweep.run_sweep(read_sweep_plan(plan), folder, executor, lambda done, _: print(done, flush=True))
"""


@pytest.mark.slow
def test_a_sweep_killed_at_random_moments_loses_nothing(tmp_path: Path, write: Callable[[str], Path]) -> None:
    plan = write(
        'measure = "press"\n[factors]\nbutton = ["mx-clear", "mx-red"]\nrepeat = 15\n[settings]\npresses = 1'
    )
    script, folder = tmp_path / "run.py", tmp_path / "run"
    script.write_text(RUN)
    random, done, kills = np.random.default_rng(6), 0, 0
    while True:
        command = [sys.executable, str(script), str(plan), str(folder)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True) as process:
            assert process.stdout is not None
            first = int(process.stdout.readline() or done)
            assert first >= done  # what was reported as done is still there
            until = time.monotonic() + random.uniform(0.0, 0.5)
            for line in process.stdout:
                done = int(line)
                if kills < 5 and time.monotonic() > until:
                    os.killpg(process.pid, signal.SIGKILL)
                    kills += 1
                    break
            process.stdout.read()
            if process.wait() == 0:
                break
    assert kills >= 2
    run_sweep(read_sweep_plan(plan), tmp_path / "plain", Here())
    assert (folder / RESULTS).read_bytes() == (tmp_path / "plain" / RESULTS).read_bytes()
