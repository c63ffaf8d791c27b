"""fdvv study new, check and preview."""

from __future__ import annotations

from pathlib import Path

from fdvv_people.cli.study.declare import KINDS
from fdvv_people.study.plan.plan_file import template_names
from fdvv_people.study.timing.kind import KIND
from tests.support.command_line import Run


def change(before: str, after: str) -> None:
    path = Path("pilot/study.toml")
    assert before in path.read_text()
    path.write_text(path.read_text().replace(before, after))


def test_every_kind_can_be_begun_checked_and_previewed(fdvv: Run) -> None:
    assert set(KINDS) == {*template_names(), *KIND.templates}
    for kind in KINDS:
        assert fdvv("study", "new", kind, "--kind", kind).status == 0
        checked = fdvv("study", "check", kind)
        assert checked.status == 0
        assert checked.out.startswith(f"{kind}: can be run")


def test_the_papers_study_is_the_default_and_described_in_words(fdvv: Run) -> None:
    created = fdvv("study", "new", "pilot")
    assert "written to pilot/study.toml" in created.out
    preview = fdvv("study", "preview", "pilot")
    assert preview.status == 0
    for words in ("36 trials (6 buttons, 6 rounds)", "2 fall due", "Kumpi on lähempänä X:ää?", "HP PR1101U",
                  "stands 12 times", "FDVV is chosen above FD"):  # fmt: skip
        assert words in preview.out


def test_a_folder_that_is_called_as_a_kind_is_of_that_kind(fdvv: Run) -> None:
    for kind in KINDS:
        assert f"its kind is {kind};" in fdvv("study", "new", f"in/{kind}").out
    assert "its kind is realism;" in fdvv("study", "new", "pilot").out
    assert 'format = "fdvv-timing"' in Path("in/timing/study.toml").read_text()


def test_no_preview_is_wider_than_a_terminal(fdvv: Run) -> None:
    for kind in template_names():
        fdvv("study", "new", kind, "--kind", kind)
        assert max(map(len, fdvv("study", "preview", kind).out.splitlines())) <= 100


def test_a_preview_as_a_page_and_as_json(fdvv: Run) -> None:
    fdvv("study", "new", "pilot")
    account = fdvv("study", "preview", "pilot/study.toml", "--html", "account.html", "--json").json
    assert (account["trials"], account["breaks"], account["places"]) == (36, 2, [12, 12])
    assert account["plan"]["exclusion"]["error_cN"] == 20
    assert Path("account.html").read_text().startswith("<!DOCTYPE html>")
    assert "written to account.html" in fdvv("study", "preview", "pilot", "--html", "account.html").out


def test_all_that_is_wrong_is_listed_at_once(fdvv: Run) -> None:
    fdvv("study", "new", "pilot")
    change('more = "FDVV"', 'more = "best"')
    change("buttons/mx-red", "buttons/mx-pink")
    checked = fdvv("study", "check", "pilot")
    assert checked.status == 1
    assert checked.out.count("problem: ") == 2
    assert "cannot be run, 2 problems" in checked.out
    assert fdvv("study", "preview", "pilot").status == 1
    report = fdvv("study", "check", "pilot", "--json").json
    assert report["ok"] is False
    assert len(report["problems"]) == 2


def test_warnings_are_printed_and_do_not_stop(fdvv: Run) -> None:
    fdvv("study", "new", "pilot")
    change("people = 12", "people = 7")
    change("rounds = 6", "rounds = 5")
    checked = fdvv("study", "check", "pilot")
    assert checked.status == 0
    assert "note: orders are not balanced exactly" in checked.out
    assert fdvv("study", "check", "pilot", "--json").json["notes"]


def test_nothing_is_written_over_and_a_broken_file_is_one_line(fdvv: Run) -> None:
    fdvv("study", "new", "pilot")
    again = fdvv("study", "new", "pilot")
    assert again.status != 0
    assert "is there already" in again.err
    change("people = 12", "people = twelve")
    assert "not valid TOML" in fdvv("study", "check", "pilot").err
    assert "line" in fdvv("study", "preview", "pilot").err
    assert fdvv("study", "new", "pilot2", "--kind", "taste").status == 2
    assert not Path("pilot2").exists()
