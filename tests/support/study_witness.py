"""Somebody who notes what was acknowledged to people of a study, and holds it against what is kept."""

from __future__ import annotations

from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.folder import study_problems
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.session.log import read_session


class Witness:
    """What was acknowledged in all lives, held against what is kept."""

    def __init__(self, study: Study) -> None:
        self.study, self.person, self.code = study, "", ""
        self.answers: dict[tuple[str, str], str] = {}
        self.labels: dict[tuple[str, str], list[str]] = {}
        self.people: list[str] = []
        self.done: set[str] = set()

    def hear(self, words: list[str]) -> None:
        kind, person, *rest = words
        if kind == "enrolled":
            self.person, self.code = person, rest[0]
            self.people.append(person)
        elif kind == "met":
            assert (person, rest[1]) not in self.answers, f"{words} was answered before"
            assert person not in self.done
        elif kind == "prepared":
            assert self.labels.setdefault((person, rest[0]), rest[1:]) == rest[1:]
        elif kind == "answered":
            assert (person, rest[0]) not in self.answers
            self.answers[person, rest[0]] = rest[1]
        elif kind == "done":
            self.done.add(person)
            self.code = ""

    def check(self, under_way: int = 1) -> None:
        """See that everything acknowledged is kept as it was.

        under_way : answers that may be kept unacknowledged: one of every life since the last look.
        """
        unheard = sum(self._unheard(person) for person in self.people)
        assert unheard <= under_way

    def _unheard(self, person: str) -> int:
        """Look at one person; count, and note, what is kept of them that was not acknowledged."""
        assert study_problems(self.study.folder, people=(person,)) == ()
        state = read_session(
            self.study.person_folder(person) / "session.jsonl", self.study.plan, SessionState
        )
        kept = {} if state is None else {str(n): one.answer.choice for n, one in state.answers.items()}
        said = {n: choice for (who, n), choice in self.answers.items() if who == person}
        assert said.items() <= kept.items()
        # in the order that was drawn
        assert list(kept) == sorted(kept, key=int)
        self.answers |= {(person, n): choice for n, choice in kept.items()}
        return len(kept) - len(said)


def check_labels(study: Study, witness: Witness, passphrase: str) -> None:
    """See that what was prepared in any life is what was drawn, and that the answers are unsealed by it."""
    keeper = study.key_holder(passphrase)
    drawn = {
        (one.name, str(trial.number)): trial
        for one in study.people()
        for trial in study.schedule(one.name, keeper).trials
    }
    for key, labels in witness.labels.items():
        assert labels == [f"{label}={name}" for label, name in sorted(drawn[key].labels.items())]
    wanted = [
        (key[0], drawn[key].item, drawn[key].labels.get(choice, choice))
        for key, choice in witness.answers.items()
        if not drawn[key].practice
    ]
    found = study.unseal(passphrase, "a test", "to see whether all is there")
    rows = zip(found.person.tolist(), found.item.tolist(), found.choice.tolist(), strict=True)
    assert sorted(row for row in rows if row[2]) == sorted(wanted)
