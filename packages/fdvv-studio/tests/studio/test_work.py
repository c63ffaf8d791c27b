"""The work of jobs, done in this process: events and results, compared with the workflow's own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin, save_model
from fdvv.model.jnd_file import save_jnds
from fdvv.model.noticeable import LITERATURE
from fdvv.rendering.compensate import start_surface
from fdvv.rendering.probe import probe
from fdvv.rendering.settings import ProbeSettings
from fdvv.twin.files import load_rig, rig_to_toml
from fdvv_studio.project.measured_bands import load_measured_button
from fdvv_studio.studio.jobs.events import CurveIntended, JobEvent, JobOutcome, PressEvent
from fdvv_studio.studio.jobs.file import JobFolder, JobRecord, publish, utc_now
from fdvv_studio.studio.jobs.orders import Order, ProbeOrder
from fdvv_studio.studio.jobs.process import run_work
from fdvv_studio.studio.jobs.work import Work
from fdvv_studio.studio.jobs.work_learn import PROBE_SEED
from tests.studio.jobs import learning, tuning
from tests.support.jnds import as_literature, record_of

AT_100 = (100.0,)
JUDGED_ONCE = ProbeSettings(velocities_mm_s=AT_100, presses=1)


def work_of(order: Order, path: Path, tell: Any) -> Work:
    folder = JobFolder(path)
    path.mkdir(exist_ok=True)
    save_model(load_builtin("mx-clear"), folder.button)
    folder.save(JobRecord("fdvv-job", 2, order, "a job", True, utc_now()))
    return Work(folder, 1, tell, lambda _number: "first")


def test_measured_presses_are_reported_and_stored_as_the_editor_reads_them(tmp_path: Path) -> None:
    events: list[JobEvent] = []
    order = learning(probe_presses=2)
    work = work_of(order, tmp_path / "job", events.append)
    assert run_work(work).state == "done"
    publish(tmp_path, work.folder, order)
    found = load_measured_button(tmp_path, order.name)
    assert found is not None
    assert (found.presses, found.simulated) == (2, True)
    measured = json.loads(work.folder.result("measured").read_text())
    assert (measured["button"], measured["simulated"], measured["presses"]) == ("builtin:mx-clear", True, 2)
    outcome = next(e for e in events if isinstance(e, JobOutcome) and e.stage == "probe")
    for band, standing in zip(found.curves, outcome.curves, strict=True):
        assert standing.mean_error_cN == pytest.approx(band.mean_error_cN, abs=1e-3)
        rows = zip(band.low_cN, band.median_cN, band.high_cN, strict=True)
        assert all(a <= b <= c for a, b, c in rows)
    intended = next(e for e in events if isinstance(e, CurveIntended))
    for press in (e for e in events if isinstance(e, PressEvent)):
        assert press.felt
        assert len(press.felt.press_cN) == len(press.felt.release_cN) == len(intended.displacement_mm)


def test_what_was_learned_is_judged_beside_the_same_presses_without_compensation(tmp_path: Path) -> None:
    events: list[JobEvent] = []
    order = learning({"rounds": 2}, probe_presses=3)
    work = work_of(order, tmp_path / "job", events.append)
    work.folder.rig.write_text(rig_to_toml(load_rig("recommended")))
    assert run_work(work).state == "done"
    stages = [e.stage for e in events if isinstance(e, PressEvent)]
    assert [stages.count(stage) for stage in ("baseline", "probe")] == [3, 3]
    outcome = next(e for e in events if isinstance(e, JobOutcome) and e.stage == "probe")
    device = TwinDevice(load_rig("recommended"), seed=order.settings.seed + PROBE_SEED)
    model = load_builtin("mx-clear")
    alone = probe(device, model, start_surface(device, model, [100.0]), [100.0], 3).curves
    for found, bare in zip(outcome.noticed, alone, strict=True):
        assert found.before_mean_cN == pytest.approx(bare.outcome.mean_error_cN, abs=1e-3)
        assert found.mean_cN is not None
        assert bare.outcome.mean_error_cN > 3 * found.mean_cN
        assert found.before_ratio is not None
        assert found.before_ratio > found.force_ratio
    before = sum(c.outcome.mean_error_cN for c in alone) / len(alone)
    assert outcome.headline.startswith(f"Mean error {before:.0f} → ")
    assert " cN on simulated presses, largest " in outcome.headline


def test_a_job_judges_by_the_jnds_that_lie_in_its_folder_and_says_whose(tmp_path: Path) -> None:
    events: list[JobEvent] = []
    order = ProbeOrder("builtin:mx-clear", "clear", settings=ProbeSettings(velocities_mm_s=AT_100, presses=2))
    work = work_of(order, tmp_path / "job", events.append)
    save_jnds(record_of(as_literature("force", 50.0)), work.folder.jnds)
    assert run_work(work).state == "done"
    origin = "JNDs of force of 12 people of study weights"
    intended = next(e for e in events if isinstance(e, CurveIntended))
    wanted = 50 * LITERATURE.force_cN(intended.press_cN)
    assert intended.press_jnd_cN == pytest.approx(wanted.tolist(), abs=0.2)
    assert intended.jnds == origin
    outcome = next(e for e in events if isinstance(e, JobOutcome))
    assert outcome.headline.endswith(f"a finger would not notice it, by {origin}")
    measured = json.loads(work.folder.result("measured").read_text())
    assert measured["noticeable"]["jnds"]["origin"] == origin


@pytest.mark.parametrize(
    ("order", "stages"),
    [
        (learning({"method": "paper", "presses": 2}), ["baseline", "compensate", "probe"]),
        (ProbeOrder("builtin:mx-clear", "clear", settings=JUDGED_ONCE), ["probe"]),
    ],
    ids=["learning without held-out presses", "a probe of the button's own force"],
)
def test_every_path_says_what_a_finger_feels_without_compensation(
    tmp_path: Path, order: Order, stages: list[str]
) -> None:
    events: list[JobEvent] = []
    assert run_work(work_of(order, tmp_path / "job", events.append)).state == "done"
    pressed = list(dict.fromkeys(e.stage for e in events if isinstance(e, PressEvent)))
    assert pressed == stages
    headline = next(e.headline for e in events if isinstance(e, JobOutcome) and e.stage == "probe")
    compared = "→" in headline, "uncompensated" in headline
    assert compared == ("compensate" in stages, "compensate" not in stages)


def test_a_table_that_is_judged_is_compared_with_none(tmp_path: Path) -> None:
    events: list[JobEvent] = []
    learned = work_of(learning(), tmp_path / "learned", lambda _event: None)
    assert run_work(learned).state == "done"
    order = ProbeOrder("builtin:mx-clear", "clear", settings=JUDGED_ONCE, actuation="clear")
    work = work_of(order, tmp_path / "job", events.append)
    work.folder.actuation.write_bytes(learned.folder.result("actuation").read_bytes())
    assert run_work(work).state == "done"
    pressed = list(dict.fromkeys(e.stage for e in events if isinstance(e, PressEvent)))
    assert pressed == ["baseline", "probe"]


def test_work_that_is_interrupted_ends_as_cancelled_and_goes_on(tmp_path: Path) -> None:
    def stop(event: JobEvent) -> None:
        if isinstance(event, PressEvent):
            raise KeyboardInterrupt

    end = run_work(work_of(learning(probe_presses=2), tmp_path, stop))
    assert (end.state, "kept" in end.line) == ("cancelled", True)
    events: list[JobEvent] = []
    assert run_work(work_of(learning(probe_presses=2), tmp_path, events.append)).state == "done"
    assert next(e.done for e in events if isinstance(e, PressEvent)) == 2


def test_one_mistake_is_one_line_without_a_path(tmp_path: Path) -> None:
    work = work_of(tuning(), tmp_path, lambda _event: None)
    work.folder.button.write_text("{}")
    end = run_work(work)
    assert end.state == "failed"
    assert str(tmp_path) not in end.line
