"""fdvv study new, check and preview."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from fdvv.cli.main import cli
from fdvv_people.cli.study.declare import KINDS
from fdvv_people.study.plan.plan_file import template_names
from fdvv_people.study.timing.kind import KIND


@pytest.fixture(autouse=True)
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["study", *arguments])


def change(before: str, after: str) -> None:
    path = Path("pilot/study.toml")
    assert before in path.read_text()
    path.write_text(path.read_text().replace(before, after))


def test_every_kind_can_be_begun_checked_and_previewed() -> None:
    assert set(KINDS) == {*template_names(), *KIND.templates}
    for kind in KINDS:
        assert invoke("new", kind, "--kind", kind).exit_code == 0
        checked = invoke("check", kind)
        assert checked.exit_code == 0
        assert checked.stdout.startswith(f"{kind}: can be run")


def test_the_papers_study_is_the_default_and_described_in_words() -> None:
    created = invoke("new", "pilot")
    assert "written to pilot/study.toml" in created.stdout
    preview = invoke("preview", "pilot")
    assert preview.exit_code == 0
    for words in ("36 trials (6 buttons, 6 rounds)", "2 fall due", "Kumpi on lähempänä X:ää?", "HP PR1101U",
                  "stands 12 times", "FDVV is chosen above FD"):  # fmt: skip
        assert words in preview.stdout


def test_a_folder_that_is_called_as_a_kind_is_of_that_kind() -> None:
    for kind in KINDS:
        assert f"its kind is {kind};" in invoke("new", f"in/{kind}").stdout
    assert "its kind is realism;" in invoke("new", "pilot").stdout
    assert 'format = "fdvv-timing"' in Path("in/timing/study.toml").read_text()


def test_no_preview_is_wider_than_a_terminal() -> None:
    for kind in template_names():
        invoke("new", kind, "--kind", kind)
        assert max(map(len, invoke("preview", kind).stdout.splitlines())) <= 100


def test_a_preview_as_a_page_and_as_json() -> None:
    invoke("new", "pilot")
    found = invoke("preview", "pilot/study.toml", "--html", "account.html", "--json")
    account = json.loads(found.stdout)
    assert (account["trials"], account["breaks"], account["places"]) == (36, 2, [12, 12])
    assert account["plan"]["exclusion"]["error_cN"] == 20
    assert Path("account.html").read_text().startswith("<!DOCTYPE html>")
    assert "written to account.html" in invoke("preview", "pilot", "--html", "account.html").stdout


def test_all_that_is_wrong_is_listed_at_once() -> None:
    invoke("new", "pilot")
    change('more = "FDVV"', 'more = "best"')
    change("buttons/mx-red", "buttons/mx-pink")
    checked = invoke("check", "pilot")
    assert checked.exit_code == 1
    assert checked.stdout.count("problem: ") == 2
    assert "cannot be run, 2 problems" in checked.stdout
    assert invoke("preview", "pilot").exit_code == 1
    report = json.loads(invoke("check", "pilot", "--json").stdout)
    assert report["ok"] is False
    assert len(report["problems"]) == 2


def test_warnings_are_printed_and_do_not_stop() -> None:
    invoke("new", "pilot")
    change("people = 12", "people = 7")
    change("rounds = 6", "rounds = 5")
    checked = invoke("check", "pilot")
    assert checked.exit_code == 0
    assert "note: orders are not balanced exactly" in checked.stdout
    assert json.loads(invoke("check", "pilot", "--json").stdout)["notes"]


def test_nothing_is_written_over_and_a_broken_file_is_one_line() -> None:
    invoke("new", "pilot")
    again = invoke("new", "pilot")
    assert again.exit_code != 0
    assert "is there already" in str(again.exception)
    change("people = 12", "people = twelve")
    assert "not valid TOML" in str(invoke("check", "pilot").exception)
    assert "line" in str(invoke("preview", "pilot").exception)
    assert invoke("new", "pilot2", "--kind", "taste").exit_code == 2
    assert not Path("pilot2").exists()
