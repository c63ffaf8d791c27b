"""fdvv study: freeze, verify, status, unseal, withdraw."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fdvv.cli import ui
from fdvv.io.files import read_limited

if TYPE_CHECKING:
    from fdvv_people.study.admin.study import Study

folder_argument = click.argument("folder", type=ui.FOLDER)
passphrase_option = ui.option(
    "--passphrase-file",
    type=ui.FILE,
    help="File whose first line is the keeper's passphrase; else a prompt asks.",
)
keeper_option = ui.option(
    "--keeper", type=ui.FILE, help="The keeper's file, if it was moved out of the folder."
)


@click.command()
@folder_argument
@passphrase_option
@ui.json_option
def freeze(folder: Path, passphrase_file: Path | None, as_json: bool) -> None:
    """Freeze the study in FOLDER before the first person: from now on every change is noticed.

    Asks for a passphrase. Whoever has it and keeper.json is the keeper, who alone can tell what the labels
    hide, and who opens the sessions whenever fdvv studio was started; nobody can restore it. The fingerprint
    goes into the preregistration.
    """
    from fdvv_people.study.admin.study import Study

    study = Study.open(folder)
    fingerprint = study.freeze(_passphrase(passphrase_file, new=True))
    if as_json:
        ui.print_json({"folder": str(folder), "name": study.plan.name, "fingerprint": fingerprint})
        return
    click.echo(f"{study.plan.name} is frozen")
    click.echo(f"fingerprint: {fingerprint}")
    click.echo(
        "write it into the preregistration: fdvv study verify --fingerprint holds the study against it"
    )
    keeper = folder / "keeper.json"
    click.echo(f"keeper: {keeper}, opened by your passphrase only; move it to where you keep keys")


@click.command()
@folder_argument
@click.option("--fingerprint", default="", help="That was written down when the study was frozen.")
@click.option("--record", default="", help="An end of the record that was written down since.")
@ui.option("--marks", is_flag=True, help="Hold the marks of people's lines too; takes the passphrase.")
@passphrase_option
@keeper_option
@ui.json_option
def verify(folder: Path, marks: bool, passphrase_file: Path | None, as_json: bool, **held: Any) -> None:
    """Verify that the study in FOLDER is as it was frozen and its logs as written; status 1 if not."""
    from fdvv_people.study.admin.study import Study

    study = Study.open(folder)
    passphrase = _passphrase(passphrase_file) if marks or passphrase_file else ""
    problems = study.verify(passphrase=passphrase, **held)
    if as_json:
        whole = {"whole": not problems, "problems": list(problems), "marks": bool(passphrase)}
        # of people whose record was tampered with nothing is sure
        simulated = study.simulated if not problems else None
        alone = list(study.code_alone) if not problems else None
        ui.print_json({"folder": str(folder), **whole, "simulated": simulated, "code_alone": alone})
    else:
        for problem in problems:
            click.echo(problem)
        if not problems:
            click.echo(f"whole; people: {len(study.people())}{_simulated(study.simulated)}")
            click.echo(f"fingerprint: {study.fingerprint}")
            click.echo(f"the record ends in: {study.record_end}")
            ui.print_wrapped(f"blind: {_scheme(study)}")
    if problems:
        raise ui.failed(f"{folder}: {ui.counted(len(problems), 'problem')}")


@click.command()
@folder_argument
@ui.json_option
def status(folder: Path, as_json: bool) -> None:
    """Show how far the study in FOLDER is and what was done with it, but not what labels hide."""
    from fdvv_people.study.admin.progress import study_progress
    from fdvv_people.study.admin.study import Study

    study = Study.open(folder)
    people = study_progress(study, time.time())
    document = _status(study, [one.document() for one in people])
    if as_json:
        ui.print_json(document)
        return
    click.echo(f"{document['name']} ({document['kind']}), {document['state']}")
    if document["fingerprint"]:
        click.echo(f"fingerprint: {document['fingerprint']}")
        click.echo(f"the record ends in: {document['record']}")
    for act in document["unsealed"]:
        click.echo(f"unsealed {act['when']} by {act['who']}: {act['why']}")
    rows = [one.cells() for one in people]
    if rows:
        ui.print_table(list(rows[0]), [list(row.values()) for row in rows], left=people[0].left)
    for line in filter(None, (one.call for one in people)):
        ui.print_wrapped(line)
    if document["paused"]:
        click.echo(f"paused: {', '.join(document['paused'])}")
    count = f"{len(people)} of {document['planned']} planned"
    click.echo(f"people: {count}{_simulated(document['simulated'])}")
    ui.print_warnings([one.problem for one in people if one.problem])


@click.command()
@folder_argument
@ui.option("--who", required=True, help="Your name; it stays on record.")
@ui.option("--why", required=True, help="The reason; it stays on record.")
@ui.option("--despite", is_flag=True, help="Go on where people's files were changed; theirs do not count.")
@passphrase_option
@keeper_option
@ui.json_option
def unseal(
    folder: Path, who: str, why: str, despite: bool, passphrase_file: Path | None, keeper: Path | None,
    as_json: bool,
) -> None:  # fmt: skip
    """Reveal what the labels hid. This is recorded first, and then nobody can begin any more.

    Writes answers.csv, codebook.json, rendered.csv and pages.csv into unsealed/ of the folder; the rules that
    were frozen with the study say in answers.csv what does not count, and why. Of a timing study it writes
    scores.csv, rounds.csv, training.csv and pages.csv.
    """
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.files.layout import UNSEALED

    study, passphrase = Study.open(folder), _passphrase(passphrase_file)
    found = study.unseal(passphrase, who, why, keeper, despite)
    simulated, reasons = found.simulated, found.reasons
    excluded, counted = Counter(filter(None, reasons)), reasons.count("")
    if as_json:
        kept = {"simulated": simulated, "unsealed": str(folder / UNSEALED)}
        ui.print_json({"rows": len(reasons), "counted": counted, "excluded": dict(excluded), **kept})
        return
    trials = ui.counted(len(reasons), "trial")
    click.echo(f"{trials}{study.kind.unsealed}{ui.simulated(simulated)}, {counted} count")
    for reason, rows in excluded.items():
        click.echo(f"  {rows} left out: {reason}")
    ui.print_written(folder / UNSEALED)


@click.command()
@folder_argument
@click.argument("person")
@ui.option("--keep", is_flag=True, help="Keep what the person gave until now; only end it.")
@ui.option("--yes", is_flag=True, help="Do not ask.")
@ui.json_option
def withdraw(folder: Path, person: str, keep: bool, yes: bool, as_json: bool) -> None:
    """Take a person out and delete all that is kept of them; that they were there stays on record.

    FOLDER is the study's, PERSON what fdvv study status calls them.
    What was unsealed of the study is deleted too, for it holds their answers: unseal it again.
    """
    from fdvv_people.study.admin.study import Study

    study = Study.open(folder)
    person = study.person(person).name
    if not (yes or as_json):
        question = f"End {person}'s part?" if keep else f"Delete all that is kept of {person}, for good?"
        click.confirm(question, abort=True)
    study.withdraw(person, delete=not keep)
    if as_json:
        ui.print_json({"person": person, "deleted": not keep})
    else:
        click.echo(f"{person} has withdrawn; " + ("their answers are kept" if keep else "all is deleted"))


def _passphrase(file: Path | None, new: bool = False) -> str:
    if file is not None:
        text = read_limited(file, 10_000, "name a file with the passphrase in its first line")
        return text.decode(errors="replace").partition("\n")[0].rstrip("\r")
    answer: str = click.prompt("Passphrase of the keeper", hide_input=True, confirmation_prompt=new, err=True)
    return answer


def _scheme(study: Study) -> str:
    alone = ", ".join(study.code_alone)
    if alone:
        return f"the code alone of {alone} opens it, for an earlier fdvv enrolled them; keep their cards away"
    return "no code opens it without the key holder"


def _simulated(simulated: bool) -> str:
    return ", all simulated: a proxy, no evidence" if simulated else ""


def _status(study: Study, people: list[dict[str, Any]]) -> dict[str, Any]:
    acts = [record["unsealed"] for record in study.history() if "unsealed" in record]
    state = "unsealed" if acts else "frozen" if study.frozen else "not frozen"
    return {
        "name": study.plan.name, "kind": study.plan.kind, "state": state, "fingerprint": study.fingerprint,
        "record": study.record_end, "planned": study.plan.people, "simulated": study.simulated,
        "paused": sorted(one or "everybody" for one in study.paused), "unsealed": acts, "people": people,
    }  # fmt: skip
