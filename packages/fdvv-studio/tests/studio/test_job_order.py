"""Orders are checked before anything begins; what they name is looked up, never joined to a path."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest

from fdvv.errors import InputError
from fdvv.model.file import model_from_json
from fdvv.model.jnd_file import FILE_NAME as JNDS_FILE
from fdvv.model.jnd_file import save_jnds
from fdvv.twin.files import load_rig, rig_to_toml
from fdvv_studio.library.catalog import Catalog
from fdvv_studio.studio.jobs.check import lock_name, simulates
from fdvv_studio.studio.jobs.file import RESULT_FOLDERS, result_file, result_names, rig_name
from fdvv_studio.studio.jobs.inputs import inputs_of
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, nest_settings
from tests.studio.jobs import DEVICES, learning, tuning
from tests.support.jnds import as_literature, record_of

OLD_JOB = Path(__file__).parents[4] / "tests" / "files" / "old" / "project" / "jobs" / "0001" / "job.json"


def checked(order: Order, project: Path) -> Any:
    return inputs_of(order, Catalog(project), project, DEVICES)


WRONG: list[tuple[Order, str]] = [
    (learning(name="../up"), "name"),
    (learning(name=".hidden"), "name"),
    (learning(name=""), "name"),
    (learning(name="a/b"), "name"),
    (learning(name="a" * 81), "name"),
    (learning(button="builtin:none"), "none"),
    (learning(button="own:../../etc/passwd"), "passwd"),
    (learning(device="serial:/dev/none"), "there is no"),
    (learning(device="replay:/etc/passwd"), "there is no"),
    (learning(rig="../default"), "rig"),
    (learning(known_rig="../../x"), "none of this name"),
    (learning(known_rig="x"), "none of this name"),
    (learning({"method": "paper"}, known_rig="x"), "belongs to the method rig-aware"),
    (tuning(actuation="../x"), "none of this name"),
    (CaptureOrder("x", switch="../mx-clear"), "switch"),
    (CaptureOrder("x", participant="nobody"), "participant"),
    (CaptureOrder("x", device="host"), "no capture bench"),
]


def test_an_order_names_no_rig_and_gets_the_recommended_one(tmp_path: Path) -> None:
    for order in (learning(), tuning()):
        assert checked(order, tmp_path).files["rig.toml"] == rig_to_toml(load_rig("recommended"))


def test_an_order_of_an_earlier_version_gets_its_rig_by_the_old_name(tmp_path: Path) -> None:
    order = msgspec.convert(nest_settings(json.loads(OLD_JOB.read_text())["order"]), CompensateOrder)
    assert order.rig == "default"
    assert checked(order, tmp_path).files["rig.toml"] == rig_to_toml(load_rig("voltage"))
    assert rig_name(order) == "twin-voltage"


@pytest.mark.parametrize(("order", "message"), WRONG, ids=lambda value: str(value)[:60])
def test_an_order_that_cannot_be_done_is_refused_in_one_line(
    order: Order, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=message) as refused:
        checked(order, tmp_path)
    assert "\n" not in str(refused.value)
    assert list(tmp_path.iterdir()) == []


def test_an_order_takes_copies_of_all_that_it_works_on(tmp_path: Path) -> None:
    known = RESULT_FOLDERS["rig"].file(tmp_path, "twin-paper")
    known.parent.mkdir()
    known.write_text("{}")
    found = checked(learning(rig="paper", known_rig="twin-paper"), tmp_path)
    assert set(found.files) == {"button.fdvv.json", "rig.toml", "known.rig.json"}
    assert model_from_json(found.files["button.fdvv.json"]).name == "mx-clear"
    assert found.title == "Compensate mx-clear on twin"


def test_a_bench_is_another_device_than_the_rig_of_the_same_name() -> None:
    bench, rig = CaptureOrder("x"), learning()
    assert (lock_name(bench), lock_name(rig)) == ("the capture bench twin", "twin")
    assert simulates(bench)
    assert simulates(rig)


def test_what_is_kept_is_found_by_name_among_what_is_there(tmp_path: Path) -> None:
    for name in ("a", "b 2"):
        file = RESULT_FOLDERS["actuation"].file(tmp_path, name)
        file.parent.mkdir(exist_ok=True)
        file.write_text("{}")
    assert result_names(tmp_path, "actuation") == ("a", "b 2")
    assert result_file(tmp_path, "actuation", "b 2").is_file()
    with pytest.raises(InputError, match="none of this name"):
        result_file(tmp_path, "actuation", "../actuations/a")


def test_a_job_keeps_what_people_noticed_when_it_was_ordered(tmp_path: Path) -> None:
    assert JNDS_FILE not in checked(learning(), tmp_path).files
    save_jnds(record_of(as_literature("force", 2.0)), tmp_path / JNDS_FILE)
    copied = checked(learning(), tmp_path).files[JNDS_FILE]
    assert copied == (tmp_path / JNDS_FILE).read_bytes()
    (tmp_path / JNDS_FILE).write_text("{}")
    with pytest.raises(InputError, match="not a file of JNDs"):
        checked(learning(), tmp_path)
