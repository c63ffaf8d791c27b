"""The kinds of files that fdvv writes: title, names, purpose and records."""

from __future__ import annotations

import typing
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from fdvv.compensation.identification import rig_file
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.model import file as model_file
from fdvv.model.jnd_file import JndRecord, MeasuredJnd
from fdvv.model.model import FDVVModel
from fdvv.program import file as program_file
from fdvv.program.program import Program
from fdvv.recording import file as recording_file
from fdvv.recording.types import Recording, Take
from fdvv.rendering.actuation_file import ActuationRecord
from fdvv.rendering.run_summary import RunSummary
from fdvv.rendering.session import Manifest
from fdvv.rendering.session_log import AnswerRecord, PressEntry, SessionRun
from fdvv.vibration.exciter import KnownExciter
from fdvv_campaigns.sweep.plan import SweepPlan
from fdvv_people.optimize.experiment.setup import ExperimentSetup
from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import ChunkRecord
from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.compromise import Chosen
from fdvv_people.optimize.run.ledger import Edited, Line, LineChoice, Pair, PairAnswer, TrialOutcome
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.study.analysis.code_book import CodeBook
from fdvv_people.study.files.counts import Counts
from fdvv_people.study.files.layout import Frozen
from fdvv_people.study.files.log_head import LogHead
from fdvv_people.study.files.people import LockedSchedule, Schedule, SealedTrial
from fdvv_people.study.files.seal import KeyHolderFile
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.state import TimingState
from fdvv_people.task.rounds import TaskRound, TrialRated
from fdvv_rig.selftest.receipt import SelftestReceipt
from fdvv_studio.library.build import LibraryManifest
from fdvv_studio.project.history import DocumentBase, HistoryChange
from fdvv_studio.studio.jobs.file import JobRecord
from fdvv_studio.studio.seats import SeatsFile


@dataclass(frozen=True)
class FileKind:
    """A kind of file.

    Attributes
    ----------
    title : its name in the reference.
    names : names of such files, in Markdown.
    purpose : what it is for, in Markdown.
    records : the records in it, by the place where they are: a file, or the key of a line.
    needed : fields that must be there, although their record has a default.
    """

    title: str
    names: str
    purpose: str
    records: dict[str, Any]
    needed: Collection[str] = ()

    @property
    def classes(self) -> tuple[type[Any], ...]:
        """Return the records; a union is replaced by its members."""
        return tuple(cls for record in self.records.values() for cls in members(record))


def members(record: Any) -> tuple[type[Any], ...]:
    """Return the records of a tuple, the members of a union, or the record itself."""
    return record if isinstance(record, tuple) else typing.get_args(record) or (record,)


FILES = (
    FileKind(
        "Model",
        "`*.fdvv.json`",
        "A button. [More](model-file.md).",
        {"file": FDVVModel},
        model_file.LAYOUT.needed,
    ),
    FileKind(
        "Program",
        "`*.fdvv-program.json`",
        "A button of several states. [More](program-file.md).",
        {"file": Program},
        program_file.LAYOUT.needed,
    ),
    FileKind(
        "Recording",
        "`*.recording.jsonl`",
        "An [event log](#journals). A `head` has no `takes`: each is a line. [More](recording-file.md).",
        {"head": Recording, "take": Take, "mend": recording_file.Correction},
        recording_file.LAYOUT.needed,
    ),
    FileKind(
        "Actuation",
        "`*.actuation.json`",
        "The command table that makes a rig feel like a button, as `fdvv compensate` learned it.",
        {"file": ActuationRecord},
        rig_file.LAYOUT.needed,
    ),
    FileKind(
        "Known rig",
        "`*.rig.json`",
        "The identified rig ([how](../explanation/identification.md)) and what was learned on it.",
        {"file": RigModel, "learned": rig_file.LearnedRecord},
        rig_file.LAYOUT.needed,
    ),
    FileKind(
        "Known exciter",
        "`*.exciter.json`",
        "The identified exciter of a rig ([how](../explanation/vibration-rendering.md)).",
        {"file": KnownExciter},
    ),
    FileKind(
        "JNDs",
        "`jnds.json`",
        "What the people of a study notice, for a project to judge by ([how](../explanation/noticeable.md)). "
        "`fdvv study jnds` writes it.",
        {"file": JndRecord, "jnd": MeasuredJnd},
    ),
    FileKind(
        "Session",
        "`session.json`, `presses.jsonl`, `answers.jsonl`",
        "The folder of a compensation, a probe or a tuning. The two logs hold `run`, `press` and `answer` "
        "records. A `press` also has the columns of its press (`columns`) and of the command (`surface`), "
        "and the controller's `tuning` where the controller is active.",
        {"session.json": Manifest, "run": SessionRun, "press": PressEntry, "answer": AnswerRecord},
    ),
    FileKind(
        "Receipt",
        "`receipt.json`",
        "How a result was obtained; written when a session ends.",
        {"file": RunSummary},
    ),
    FileKind(
        "Optimisation",
        "`optimize.json`, `trials.jsonl`, `rounds.jsonl`, `compromise.json`",
        "The folder of a run. `trials.jsonl` is an event log of trials, edits and outcomes; an earlier fdvv "
        "wrote pairs with answers and lines with choices. `rounds.jsonl` is an event log of the rounds that "
        "a person played and of how they rated; `compromise.json` is there once a person took another design "
        "of the front.",
        {
            "optimize.json": OptimizeSetup,
            "compromise.json": Chosen,
            "trial": Trial,
            "edit": Edited,
            "state": TrialOutcome,
            "pair": Pair,
            "answer": PairAnswer,
            "line": Line,
            "choice": LineChoice,
            "rounds.jsonl": TaskRound,
            "rated": TrialRated,
        },
    ),
    FileKind(
        "Experiment",
        "`experiment.json`",
        "Training, a week's break, and validation, with simulated people.",
        {"file": ExperimentSetup},
    ),
    FileKind(
        "Population",
        "`population.json`, `chunks.jsonl`",
        "Many simulated people; `chunks.jsonl` is an event log of the finished chunks. Results: "
        "`population.npz`, `summary.json`.",
        {"population.json": PopulationPlan, "chunks.jsonl": ChunkRecord},
    ),
    FileKind(
        "Study", "`study.toml`", "The plan of a blind study. [More](study-file.md).", {"file": StudyPlan}
    ),
    FileKind(
        "Timing study",
        "`study.toml`",
        "The plan of a study that times presses. [More](timing-file.md).",
        {"file": TimingPlan},
    ),
    FileKind(
        "Frozen study",
        "`frozen.json`, `keeper.json`, `counts.json`, `*.head`",
        "What was frozen, the key holder's half of the key, how much was written for everybody, and the "
        "length of a log ([how](../explanation/blinding.md)).",
        {
            "frozen.json": Frozen,
            "keeper.json": KeyHolderFile,
            "counts.json": Counts,
            "*.head": LogHead,
        },
    ),
    FileKind(
        "Seats",
        "`studies/NAME.seats`",
        "The invitations of a study in a project of the studio, as digests of their words.",
        {"file": SeatsFile},
    ),
    FileKind(
        "Participant",
        "`schedule.json`, `session.jsonl`, `sealed.jsonl`",
        "One participant's folder. `schedule.json` holds the encrypted schedule, with a sealed trial for "
        "each of its trials; `session.jsonl` is a chained event log "
        "([when what is written](../explanation/running-a-study.md)).",
        {
            "schedule.json": LockedSchedule,
            "decrypted": Schedule,
            "sealed.jsonl": SealedTrial,
            "session.jsonl": SessionState.kinds(),
        },
    ),
    FileKind(
        "Timing participant",
        "`session.jsonl`",
        "The chained event log of a participant in a timing study; its other files are those of every study "
        "([when what is written](../explanation/timing-studies.md)).",
        {"session.jsonl": TimingState.kinds()},
    ),
    FileKind(
        "Code book",
        "`codebook.json`",
        "Describes the columns of `answers.csv` beside it. [More](answers-file.md).",
        {"file": CodeBook},
    ),
    FileKind(
        "Draft",
        "`*.draft.jsonl`",
        "An [event log](#journals): first `base`, then every `change`. [More](project-folder.md#drafts).",
        {"base": DocumentBase, "change": HistoryChange},
    ),
    FileKind(
        "Job",
        "`job.json`, `events.jsonl`",
        "A folder of the studio's long work. `events.jsonl` is an event log of what was sent to the page "
        "([messages](studio-messages.md)).",
        {"job.json": JobRecord},
    ),
    FileKind(
        "Library",
        "`library.json`",
        "The sources of a library of measured buttons. [More](library-files.md).",
        {"file": LibraryManifest},
    ),
    FileKind("Sweep", "`*.toml`", "A plan of a sweep. [More](sweep-files.md).", {"file": SweepPlan}),
    FileKind(
        "Self-test",
        "`*.json`",
        "The receipt of `fdvv hardware selftest` of a rig whose parts all passed.",
        {"file": SelftestReceipt},
    ),
)
