"""Declarations of studies: templates, checks, preview."""

from __future__ import annotations

import json
import re
import tempfile
from pathlib import Path
from typing import Annotated

from msgspec import Meta

from fdvv.errors import InputError
from fdvv.io.files import write_atomic
from fdvv.model.file import model_to_json
from fdvv.report.report import Section
from fdvv_people.pages.api.studies import Name, StudiesAsk
from fdvv_people.pages.studies import Studies
from fdvv_people.study.admin.study import Study
from fdvv_people.study.kind import Account, all_kinds, kind_of_text
from fdvv_people.study.plan.plan_file import (
    STUDY_FILE,
    called,
    template_text,
    write_template,
)
from fdvv_studio.studio.api.documents import ButtonId
from fdvv_studio.studio.contract import Empty, Message, Offer, call, error_line
from fdvv_studio.studio.studio import Studio

Text = Annotated[str, Meta(max_length=200_000)]
TEMPLATE_DESCRIPTIONS = {
    "realism": "which of two hidden renderings is closer to a named reference; the paper's",
    "abx": "X is A or B: which?",
    "2afc": "which of two has more of something",
    "2ac": "the same, or which has more?",
    "preference": "which of two is liked better",
    "mushra": "several are rated beside a reference, itself and anchors hidden among them",
    "staircase": "how small a difference is just felt",
    "thresholds": "how small a difference of force, snap and vibration is just felt, in few trials",
    "timing": "which button times a press best, after a search for one's own; the paper's",
    "tapping": "how fast one can tap on each",
}


class StudiesOffers(Message):
    """All templates, and what each is for."""

    templates: list[Offer]


class StudiesCreate(Message):
    """Declare a study from a template.

    button : what it is about, where the template compares renderings of one button; None: the template's own.
    """

    name: Name
    template: Name
    button: ButtonId | None = None


class StudiesTable(Message):
    """A table of a preview."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


class StudiesSection(Message):
    """A part of a preview."""

    title: str
    paragraphs: tuple[str, ...]
    tables: list[StudiesTable]


class StudiesPlan(Message):
    """The declaration.

    problems : what is wrong with it. preview : what it comes to; nothing where it has
        problems, or is not kept.
    """

    study: str
    text: str
    problems: tuple[str, ...]
    preview: list[StudiesSection]


class StudiesWrite(StudiesAsk):
    """Check a declaration, and keep it if that is asked for and the study is not frozen."""

    text: Text
    keep: bool


def preview_section(one: Section) -> StudiesSection:
    tables = [StudiesTable(table.columns, table.rows) for table in one.tables]
    return StudiesSection(one.title, one.paragraphs, tables)


@call("studies.offers")
def offers(_studio: Studio, _ask: Empty) -> StudiesOffers:
    names = [name for kind in all_kinds() for name in kind.templates]
    return StudiesOffers([Offer(name, TEMPLATE_DESCRIPTIONS.get(name, "")) for name in names])


@call("studies.create")
def create(studio: Studio, ask: StudiesCreate) -> StudiesAsk:
    studies = studio.part(Studies)
    text = called(template_text(ask.template), ask.name)  # a wrong name leaves no folder
    if ask.button is not None:
        text = with_button(text, studio.catalog.model(ask.button).name, OWN)
    with tempfile.TemporaryDirectory() as building:
        path = write_template(ask.template, Path(building), ask.name)
        if OWN in text and ask.button is not None:
            write_atomic(path, text)
            write_atomic(path.parent / OWN, model_to_json(studio.catalog.model(ask.button)))
        Study.declare(studies.path(ask.name), path)
    studies.announce(ask.name)
    return StudiesAsk(ask.name)


OWN = "buttons/button.fdvv.json"
ITEMS = re.compile(r"^\[\[items\]\]\n(?:(?!\[|# ).*\n|    \{.*\n)*", re.M)


def with_button(text: str, name: str, file: str) -> str:
    """Put one button in the place of a template's, where each is rendered in two ways: realism and abx."""
    plan = kind_of_text(text).read_plan(text, STUDY_FILE)
    if plan.kind not in ("realism", "abx"):
        return text
    first, quoted = plan.items[0], json.dumps(name, ensure_ascii=False)
    rows = (
        f'    {{ name = "{one.name}", button = "{file}", rendered = "{one.rendered}" }},\n'
        for one in first.stimuli
    )
    item = f"[[items]]\nname = {quoted}\nstimuli = [\n{''.join(rows)}]\n\n"
    place = next(ITEMS.finditer(text)).start()
    return text[:place] + item + ITEMS.sub("", text[place:])


@call("studies.plan")
def plan(studies: Studies, ask: StudiesAsk) -> StudiesPlan:
    return _reviewed_plan(ask.study, studies.study(ask.study))


@call("studies.write")
def write(studies: Studies, ask: StudiesWrite) -> StudiesPlan:
    study = studies.study(ask.study)
    if not ask.keep:
        return StudiesPlan(ask.study, ask.text, _problems(study, ask.text), [])
    study.change_plan(ask.text)
    studies.announce(ask.study)
    return _reviewed_plan(ask.study, study)


def _problems(study: Study, text: str) -> tuple[str, ...]:
    try:
        return study.kind.problems(study.kind.read_plan(text, STUDY_FILE))
    except InputError as error:
        return (error_line(error),)


def _reviewed_plan(name: str, study: Study) -> StudiesPlan:
    """Return a declaration with its preview, read with all files it names."""
    text = (study.folder / STUDY_FILE).read_text(encoding="utf-8", errors="replace")
    try:
        account: Account = study.kind.account(study.plan, study.folder)
    except InputError as error:
        return StudiesPlan(name, text, (error_line(error),), [])
    return StudiesPlan(name, text, account.problems, [preview_section(one) for one in account.sections])
