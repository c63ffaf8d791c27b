"""fdvv study: analyse, export, jnds."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import msgspec

from fdvv.cli import ui
from fdvv.errors import InputError
from fdvv.io.files import read_limited

if TYPE_CHECKING:
    from fdvv_people.study.analysis.read_answers import AnswersTable
    from fdvv_people.study.analysis.records import StudyAnalysis
    from fdvv_people.study.plan.answers import Answers
    from fdvv_people.study.plan.plan import StudyPlan

DOORS = {"fdvv-timing": "fdvv_people.cli.study.timing"}
"""Modules with `analyse` and `export`, by the format of plans whose studies have no table of answers."""

table_options = ui.options(
    click.option(
        "--kind", default="",
        help="Of the study: realism, abx, 2afc, 2ac, preference, mushra, staircase, thresholds or timing; "
             "by default that of the folder.",
    ),
    click.option(
        "--stimuli", default="", metavar="A,B",
        help="Names of the compared stimuli; of two, the second is compared with the first.",
    ),
    ui.option(
        "--map", "columns", multiple=True, metavar="ROLE=COLUMN",
        help="Which column is what: person, item, round, choice, is_chosen, correct, ratio, time_s, "
             "excluded, stimulus, RATING:STIMULUS, or RATING; the rest is inferred. Repeatable.",
    ),
    ui.option(
        "--code", "codes", multiple=True, metavar="WORD=STIMULUS",
        help="What a word in the columns choice and stimulus means; STIMULUS may be equal.",
    ),
    ui.option("--missing", multiple=True, metavar="WORD", help="A further word for a missing value."),
    ui.option("--simulated", is_flag=True, help="These are answers of simulated participants."),
)  # fmt: skip
"""How to read a foreign table."""

source_argument = click.argument("source", type=ui.EXISTING)
plan_option = ui.option(
    "--plan", type=ui.FILE, help="The study's file, for its claim and its rules; of a study's folder its own."
)


@click.command()
@source_argument
@plan_option
@table_options
@ui.option("--report", type=ui.PATH, help="Write an HTML report here.")
@ui.json_option
def analyse(source: Path, plan: Path | None, report: Path | None, as_json: bool, **table: Any) -> None:
    """Analyse answers: shares, tests, distances felt, thresholds, and the main claim.

    SOURCE is the folder of an unsealed study, an answers.csv, or any CSV whose columns are mapped.
    Shares with intervals that count people, signed-rank tests by button with their exact p, distances felt,
    thresholds, and the test of the main claim; with --report as a page with figures. Of a timing study: the
    paper's analysis of variance and pairs, a mixed model with intervals, and the claim.
    """
    from fdvv_people.study.analysis.export import analysis_dict
    from fdvv_people.study.analysis.report import write_study_report

    ui.check_output(report, ".html")
    if door := other_door(source):
        door.analyse(source, report, as_json)
        return
    read, declared, origin = _opened(source, plan, table)
    found = _analysed(read.answers, declared, source)
    if report is not None:
        write_study_report(report, found, declared, origin)
    if as_json:
        ui.print_json({**analysis_dict(found), **_columns(read)})
        return
    _print_columns(read)
    _print(found)
    if report is not None:
        click.echo(f"report: {report}")


@click.command()
@source_argument
@plan_option
@table_options
@ui.option("--folder", required=True, type=ui.PATH, help="Where to write.")
@ui.json_option
def export(source: Path, plan: Path | None, folder: Path, as_json: bool, **table: Any) -> None:
    """Write answers as plain tables for R, JASP or pandas, and everything the analysis found as JSON.

    SOURCE is as for fdvv study analyse.
    answers.csv has a row a trial, people.csv a row a person, codebook.json tells what the columns mean,
    analysis.json holds every figure.
    """
    from fdvv_people.study.analysis.code_book import write_answers
    from fdvv_people.study.analysis.export import write_analysis

    ui.check_folder(folder)
    read = None
    if door := other_door(source):
        rows, simulated, files = door.export(source, folder)
    else:
        read, declared, _ = _opened(source, plan, table)
        found = _analysed(read.answers, declared, source)
        rows, simulated = len(read.answers.person), read.answers.simulated
        files = [*write_answers(folder, found.screening.answers, declared), *write_analysis(folder, found)]
    if as_json:
        columns = _columns(read) if read else {}
        ui.print_json({"rows": rows, "files": [str(path) for path in files], **columns})
        return
    if read:
        _print_columns(read)
    click.echo(f"{ui.counted(rows, 'trial')}{' of simulated participants: a proxy, no evidence' * simulated}")
    for path in files:
        click.echo(str(path))


@click.command()
@click.argument("folder", metavar="STUDY", type=ui.FOLDER)
@ui.option(
    "--into", "project", type=ui.FOLDER, metavar="PROJECT", help="Project that judges by them from then on."
)
@ui.option("-o", "--output", type=ui.PATH, help="The .json to write, for --jnds of other commands.")
@ui.json_option
def jnds(folder: Path, project: Path | None, output: Path | None, as_json: bool) -> None:
    """Let a project judge by what the people of a study notice.

    STUDY is the folder of an unsealed study of thresholds or staircases. Their JNDs are written into the
    project's jnds.json. Its studio's distances between buttons, verdicts on renderings and findings count in
    them from then on and say so. Without the file they count in JNDs from the literature.
    """
    from fdvv.model.jnd_file import FILE_NAME, jnds_of, save_jnds
    from fdvv.model.noticeable import LITERATURE
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.analysis.jnd_record import jnd_record
    from fdvv_people.study.kind import kind_of

    ui.check_output(output, ".json")
    kind_of(folder).require("jnds", folder)
    record = jnd_record(Study.open(folder))
    paths = [path for path in (output, project and project / FILE_NAME) if path]
    for path in paths:
        save_jnds(record, path)
    if as_json:
        ui.print_json({**msgspec.to_builtins(record), "files": [str(path) for path in paths]})
        return
    found = jnds_of(record)
    click.echo(found.origin)
    for source in found.sources:
        if source not in LITERATURE.sources:
            ui.print_wrapped(f"{source.of}: {source.value}; {source.source}")
    ui.print_written(*paths)
    ui.print_warnings(record.doubts())


def other_door(source: Path) -> Any:
    """Return what analyses the study in a folder otherwise than as a table of answers; None: nothing does."""
    from fdvv_people.study.kind import kind_of

    module = DOORS.get(kind_of(source).format) if source.is_dir() else None
    return module and importlib.import_module(module)


def _analysed(answers: Answers, declared: StudyPlan | None, source: Path) -> StudyAnalysis:
    from fdvv_people.study.analysis.analyse import analyse as analysed
    from fdvv_people.study.analysis.jnds import standards_of

    standards = standards_of(declared, source) if declared and source.is_dir() else {}
    return analysed(answers, declared, "" if declared else source.name, standards)


def _columns(read: AnswersTable) -> dict[str, Any]:
    """Return how the columns of a foreign table were understood."""
    if not read.columns:
        return {}
    return {"columns": dict(read.columns), "inferred": sorted(read.guessed), "unused": list(read.unused)}


def _print_columns(read: AnswersTable) -> None:
    """Print which column was taken for what, where names and contents had to say it."""
    if read.guessed:
        pairs = [f"{role}={head}" for role, head in read.columns.items()]
        unused = f"; not used: {', '.join(read.unused)}" if read.unused else ""
        ui.print_wrapped(f"columns: {', '.join(pairs)}{unused}; --map ROLE=COLUMN corrects it")


def _opened(
    source: Path, plan: Path | None, table: dict[str, Any]
) -> tuple[AnswersTable, StudyPlan | None, str]:
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.analysis.columns import ColumnMap
    from fdvv_people.study.analysis.read_answers import read_table
    from fdvv_people.study.plan.plan_file import STUDY_FILE, read_plan_text

    column_map = ColumnMap(
        kind=table["kind"],
        stimuli=tuple(name.strip() for name in table["stimuli"].split(",") if name.strip()),
        columns=_pairs("--map", table["columns"]),
        codes=_pairs("--code", table["codes"]),
        missing=frozenset(table["missing"]),
        simulated=table["simulated"],
    )
    answers = read_table(source, column_map)
    if plan is not None:
        data = read_limited(plan, 4_000_000, "name the study's file")
        return answers, read_plan_text(data.decode(errors="replace"), plan), f"answers of {source.name}"
    if (source / STUDY_FILE).is_file():
        study = Study.open(source)
        frozen = f", fingerprint {study.fingerprint}" if study.frozen else ", not frozen"
        return answers, study.plan, f"study {study.plan.name}{frozen}"
    return answers, None, f"answers of {source.name}"


def _pairs(option: str, texts: tuple[str, ...]) -> dict[str, str]:
    """Read NAME=VALUE options; a name may hold no =, a value may. InputError."""
    found = {}
    for text in texts:
        name, sign, value = text.partition("=")
        if not (name.strip() and sign and value.strip()):
            raise InputError(option, repr(text), "is no NAME=VALUE", f"write {option} NAME=VALUE")
        found[name.strip()] = value.strip()
    return found


def _print(found: StudyAnalysis) -> None:
    from fdvv_people.study.analysis.report import study_summary

    screening = found.screening
    counts = f"{screening.counted} of {screening.planned} trials count, {screening.people_counted} people"
    click.echo(f"{found.title} ({found.kind}): {counts}")
    ui.print_wrapped(study_summary(found))
    if found.tests:
        rows = [
            [
                one.button, one.rating, one.test.n, one.test.z,
                *(_p(p) for p in (one.test.p_asymptotic, one.test.p_exact, one.p_holm)),
                one.test.effect,
            ]
            for one in found.tests
        ]  # fmt: skip
        ui.print_table(["button", "rating", "people", "Z", "p", "exact p", "Holm", "r"], rows, left=2)
    ui.print_warnings(found.notes)


def _p(p: float) -> str:
    return "< .0001" if p < 0.0001 else f"{p:.4f}"
