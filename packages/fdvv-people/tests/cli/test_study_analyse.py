"""fdvv study analyse and export."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest

from fdvv_people.study.analysis.code_book import write_answers
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.plan.plan_file import write_template
from tests.support.command_line import Run
from tests.support.study_answers import BUTTONS, paper_like, right_or_wrong


@pytest.fixture
def paper(tmp_path: Path) -> Path:
    """Return the folder of answers like the paper's."""
    write_answers(tmp_path / "paper", paper_like())
    return tmp_path / "paper"


def test_the_papers_statistics_are_printed_as_json(fdvv: Run, paper: Path) -> None:
    analysis = fdvv("study", "analyse", paper, "--json").json
    assert [one["button"] for one in analysis["tests"]][:2] == ["Clear", "Brown"]
    for one in analysis["tests"]:
        assert round(one["z"], 2) == -3.06
        assert round(one["p_asymptotic"], 3) == 0.002
        assert round(one["p_exact"], 4) == 0.0005
        assert one["effect"] == 1.0
    assert round(100 * analysis["preference"]["share"], 2) == 77.31
    assert analysis["preference"]["low"] < analysis["preference"]["share"] < analysis["preference"]["high"]
    assert not analysis["simulated"]


def test_people_read_the_claim_the_share_and_a_table(fdvv: Run, paper: Path) -> None:
    ran = fdvv("study", "analyse", paper / "answers.csv")
    assert ran.status == 0
    assert "Of 432 answers, 334 (77.31" in ran.out
    assert "MacBook Pro keyboard  realism      12  -3.06  0.0022   0.0005" in ran.out


def test_a_foreign_table_is_analysed_as_its_columns_are_mapped(fdvv: Run, tmp_path: Path) -> None:
    rows = [f"s{p};Clear;{1 + p % 2};{3 + p / 10:.1f};{5 + p / 5:.1f}" for p in range(8)]
    text = "subject;switch;answer;fd;fdvv\n" + "\n".join(row.replace(".", ",") for row in rows) + "\n"
    Path("foreign.csv").write_text(text)
    mapped = ["person=subject", "item=switch", "choice=answer", "realism:FD=fd", "realism:FDVV=fdvv"]
    options = [word for one in mapped for word in ("--map", one)]
    codes = ["--code", "1=FDVV", "--code", "2=FD"]
    analysis = fdvv("study", "analyse", "foreign.csv", "--kind", "realism", *options, *codes, "--json").json
    (test,) = analysis["tests"]
    assert (test["n"], test["w_minus"], test["p_exact"]) == (8, 0.0, 2 / 2**8)
    assert analysis["preference"]["share"] == 0.5


LONG = "participant,button,trial,model,rating,preferred\n" + "".join(
    f"p{p},Clear,{t},{m},{3 + t + (m == 'FDVV')},FDVV\n"
    for p in range(6)
    for t in (1, 2)
    for m in ("FD", "FDVV")
)


def test_a_table_of_a_row_a_rating_is_analysed_without_a_flag_and_its_mapping_shown(fdvv: Run) -> None:
    Path("long.csv").write_text(LONG)
    ran = fdvv("study", "analyse", "long.csv")
    assert ran.status == 0
    assert ran.out.startswith("columns: person=participant, item=button, stimulus=model, choice=preferred,")
    analysis = fdvv("study", "analyse", "long.csv", "--json").json
    assert analysis["columns"]["round"] == "trial"
    assert (analysis["tests"][0]["n"], analysis["tests"][0]["p_exact"]) == (6, 2 / 2**6)
    other = fdvv(
        "study", "analyse", "long.csv", "--map", "person=button", "--map", "item=participant", "--json"
    )
    assert (other.json["columns"]["person"], other.json["screening"]["people"]) == ("button", 1)


def test_what_a_table_lacks_is_named_at_once_and_with_json_as_a_document(fdvv: Run) -> None:
    Path("bad.csv").write_text("a,b\n1,2\n")
    ran = fdvv("study", "analyse", "bad.csv", "--json")
    assert ran.status == ran.json["error"]["status"] == 2
    assert ran.json["error"]["missing"] == ["person", "answer"]
    assert ran.json["error"]["columns"] == ["a", "b"]
    assert ran.err.strip() == f"fdvv: {ran.json['error']['message']}"
    usage = fdvv("study", "analyse", "nowhere.csv", "--json")
    assert "does not exist" in usage.json["error"]["message"]


def test_a_plan_beside_a_table_says_what_was_registered(fdvv: Run, paper: Path, tmp_path: Path) -> None:
    write_template("realism", tmp_path / "plan")
    analysis = fdvv("study", "analyse", paper, "--plan", tmp_path / "plan" / "study.toml", "--json").json
    assert analysis["claim"]["registered"]
    assert analysis["claim"]["supported"]


@pytest.mark.slow
def test_a_report_of_simulated_answers_says_so(fdvv: Run, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    write_answers(tmp_path / "tried", replace(right_or_wrong(), simulated=True))
    ran = fdvv("study", "analyse", "tried", "--report", "out.html")
    assert ran.out.endswith("report: out.html\n")
    assert "Simulated participants: a proxy, no evidence." in ran.out
    assert "simulated participants: a proxy, no evidence" in Path("out.html").read_text()


def test_exported_tables_are_read_back_and_have_a_row_a_person(fdvv: Run, paper: Path) -> None:
    ran = fdvv("study", "export", paper, "--folder", "out", "--json")
    assert len(ran.json["files"]) == 4
    assert read_answers(Path("out")).choice.tolist() == paper_like().choice.tolist()
    with Path("out/people.csv").open(newline="") as stream:
        people = list(csv.DictReader(stream))
    assert len(people) == 12
    assert float(people[0]["realism_Clear_FDVV"]) == 3.5
    parts = [float(people[0][f"choice_Clear_{name}"]) for name in ("FD", "FDVV", "equal")]
    assert sum(parts) == pytest.approx(1.0)
    found = json.loads(Path("out/analysis.json").read_text())
    assert [one["button"] for one in found["tests"]] == list(BUTTONS)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--map", "person"], "--map: 'person': is no NAME=VALUE"),
        (["--map", "person=who"], "there is no column 'who'"),
        (["--kind", "triangle"], "no such kind of study"),
        (["--stimuli", "FD,other"], "is none of FD, other"),
        (["--report", "out.pdf"], "end it in .html"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(fdvv: Run, paper: Path, options: list[str], said: str) -> None:
    (paper / "codebook.json").unlink()
    ran = fdvv("study", "analyse", paper, *options)
    assert ran.status == 2
    assert said in ran.err
    assert ran.err.count("\n") == 1


def test_a_folder_without_answers_says_what_to_do(fdvv: Run, tmp_path: Path) -> None:
    write_template("realism", tmp_path / "plan")
    ran = fdvv("study", "analyse", "plan")
    assert ran.status == 2
    assert "unseal the study first" in ran.err
