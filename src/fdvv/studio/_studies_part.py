"""The part of the studio that runs studies of people: the operator's calls, and the participant's screen."""

from __future__ import annotations

import tempfile
from pathlib import Path

from fdvv.errors import FdvvError, InputError
from fdvv.studio import _messages_studies as m
from fdvv.studio import _studies_told as t
from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._studies import Studies, state_of
from fdvv.studio._studio import Studio
from fdvv.studio._study_screen import CHANNEL as SCREEN
from fdvv.studio._told import told
from fdvv.studio._work_choices import device_names
from fdvv.study import (
    STUDY_FILE,
    plan_problems,
    read_plan_text,
    template_names,
    template_text,
    write_template,
)
from fdvv.workflow import (
    Study,
    analyse,
    look_at_study,
    preview_sections,
    read_answers,
    study_html,
)

UNSEALED, ANSWERS = "unsealed", "answers.csv"
TOLD = {
    "realism": "which of two hidden renderings is closer to a named reference; the paper's",
    "abx": "X is A or B: which?",
    "2afc": "which of two has more of something",
    "2ac": "the same, or which has more?",
    "preference": "which of two is liked better",
    "mushra": "several are rated beside a reference, itself and anchors hidden among them",
    "staircase": "how small a difference is just felt",
}


def offers(_studio: Studio, _ask: m.StudiesOffersAsk) -> m.StudiesOffers:
    """Tell what a study can be made from."""
    return m.StudiesOffers([m.StudiesOffer(name, TOLD.get(name, "")) for name in template_names()])


def rows(studio: Studio, _ask: m.StudiesListAsk) -> m.StudiesRows:
    """List all studies."""
    studies = studio.part(Studies)
    return m.StudiesRows([_row(studies, name) for name in studies.names()])


def _row(studies: Studies, name: str) -> m.StudiesRow:
    try:
        return t.row(name, studies.study(name))
    except FdvvError as error:
        return t.broken(name, told(error))


def create(studio: Studio, ask: m.StudiesCreate) -> m.StudiesAsk:
    """Declare a study from a template."""
    studies = studio.part(Studies)
    template_text(ask.template)  # a wrong name leaves no folder
    with tempfile.TemporaryDirectory() as building:
        Study.declare(studies.path(ask.name), write_template(ask.template, Path(building)))
    studies.announce(ask.name)
    return m.StudiesAsk(ask.name)


def plan(studio: Studio, ask: m.StudiesAsk) -> m.StudiesPlan:
    """Tell the declaration of a study."""
    return _kept(ask.study, studio.part(Studies).study(ask.study))


def write(studio: Studio, ask: m.StudiesWrite) -> m.StudiesPlan:
    """Check a declaration, and keep it where that is asked for."""
    studies = studio.part(Studies)
    study = studies.study(ask.study)
    if not ask.keep:
        return m.StudiesPlan(ask.study, ask.text, _problems(ask.text), [])
    study.change_plan(ask.text)
    studies.announce(ask.study)
    return _kept(ask.study, study)


def _problems(text: str) -> list[str]:
    """Tell what is wrong with a declaration by itself."""
    try:
        return list(plan_problems(read_plan_text(text, STUDY_FILE)))
    except InputError as error:
        return [told(error)]


def _kept(name: str, study: Study) -> m.StudiesPlan:
    """Tell what a study comes to, with all the files it names."""
    text = (study.folder / STUDY_FILE).read_text(encoding="utf-8", errors="replace")
    try:
        look = look_at_study(study.folder)
    except InputError as error:
        return m.StudiesPlan(name, text, [told(error)], [])
    sections = [] if look.problems else [t.section(one) for one in preview_sections(look)]
    return m.StudiesPlan(name, text, list(look.problems), sections)


def detail(studio: Studio, ask: m.StudiesAsk) -> m.StudiesDetail:
    """Tell a study and its people."""
    return t.detail(studio.part(Studies), ask.study)


def freeze(studio: Studio, ask: m.StudiesFreeze) -> m.StudiesDetail:
    """Freeze a study."""
    studies = studio.part(Studies)
    studies.study(ask.study).freeze(ask.passphrase)
    studies.announce(ask.study)
    return t.detail(studies, ask.study)


def seat(studio: Studio, ask: m.StudiesAsk) -> m.StudiesSeat:
    """Prepare a seat for the next person."""
    found = studio.part(Studies).free_seat(ask.study)
    return m.StudiesSeat(found.study, found.word)


def use(studio: Studio, ask: m.StudiesUse) -> m.StudiesDetail:
    """Have a study rendered by another device."""
    studies = studio.part(Studies)
    studies.use_device(ask.study, ask.device, device_names())
    return t.detail(studies, ask.study)


def devices(_studio: Studio, _ask: m.StudiesDevicesAsk) -> m.StudiesDevices:
    """Tell what may render a study."""
    return m.StudiesDevices(t.all_devices())


def pause(studio: Studio, ask: m.StudiesPause) -> m.StudiesDetail:
    """Have screens wait, or go on."""
    studies = studio.part(Studies)
    studies.pause(ask.study, ask.person, ask.on)
    return t.detail(studies, ask.study)


def withdraw(studio: Studio, ask: m.StudiesWithdraw) -> m.StudiesDetail:
    """Take a person out."""
    studies = studio.part(Studies)
    studies.withdraw(ask.study, ask.person, ask.delete)
    return t.detail(studies, ask.study)


def verify(studio: Studio, ask: m.StudiesAsk) -> m.StudiesVerified:
    """Look for anything that was changed."""
    return m.StudiesVerified(list(studio.part(Studies).study(ask.study).verify()))


def unseal(studio: Studio, ask: m.StudiesUnseal) -> m.StudiesUnsealed:
    """Open what the labels hid."""
    studies = studio.part(Studies)
    answers = studies.study(ask.study).unseal(ask.passphrase, ask.who, ask.why)
    studies.announce(ask.study)
    return m.StudiesUnsealed(len(answers.person), int((~answers.counts).sum()), UNSEALED)


def report(studio: Studio, ask: m.StudiesAsk) -> m.StudiesReport:
    """Write the report of an unsealed study."""
    study = studio.part(Studies).study(ask.study)
    if state_of(study) != "unsealed":
        raise InputError("study", ask.study, "is sealed", "unseal it when the last person is done")
    found = analyse(read_answers(study.folder / UNSEALED / ANSWERS), study.plan)
    footer = f"Study {ask.study}, frozen as {study.fingerprint}."
    return m.StudiesReport(f"{ask.study}-report.html", study_html(found, study.plan, footer))


class StudiesChannel:
    """One page that follows the studies."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studies, self._tell = studio.part(Studies), tell

    def receive(self, _ask: m.StudiesWatch) -> None:
        """Begin."""
        self._studies.watchers.watch(self._tell)
        self._tell(m.StudiesWatching())

    def close(self) -> None:
        """End."""
        self._studies.watchers.forget(self._tell)


CALLS = (
    Call("studies.offers", m.StudiesOffersAsk, m.StudiesOffers, offers),
    Call("studies.list", m.StudiesListAsk, m.StudiesRows, rows),
    Call("studies.create", m.StudiesCreate, m.StudiesAsk, create),
    Call("studies.plan", m.StudiesAsk, m.StudiesPlan, plan),
    Call("studies.write", m.StudiesWrite, m.StudiesPlan, write),
    Call("studies.freeze", m.StudiesFreeze, m.StudiesDetail, freeze),
    Call("studies.detail", m.StudiesAsk, m.StudiesDetail, detail),
    Call("studies.seat", m.StudiesAsk, m.StudiesSeat, seat),
    Call("studies.devices", m.StudiesDevicesAsk, m.StudiesDevices, devices),
    Call("studies.use", m.StudiesUse, m.StudiesDetail, use),
    Call("studies.pause", m.StudiesPause, m.StudiesDetail, pause),
    Call("studies.withdraw", m.StudiesWithdraw, m.StudiesDetail, withdraw),
    Call("studies.verify", m.StudiesAsk, m.StudiesVerified, verify),
    Call("studies.unseal", m.StudiesUnseal, m.StudiesUnsealed, unseal),
    Call("studies.report", m.StudiesAsk, m.StudiesReport, report),
)
CHANNELS = (
    ChannelKind("studies", (m.StudiesWatch,), (m.StudiesWatching, m.StudiesChanged), StudiesChannel),
    SCREEN,
)
