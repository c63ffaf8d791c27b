"""Somebody who notes what was acknowledged to people of a study, and holds it against what is kept."""

from __future__ import annotations

from fdvv.workflow import Study, read_session
from fdvv.workflow._study_verify import study_problems


class Witness:
    """What was acknowledged in all lives, held against what is kept."""

    def __init__(self, study: Study) -> None:
        self.study, self.person, self.code = study, "", ""
        self.answers: dict[tuple[str, str], str] = {}
        self.labels: dict[tuple[str, str], list[str]] = {}
        self.done: set[str] = set()

    def hear(self, words: list[str]) -> None:
        kind, person, *rest = words
        if kind == "enrolled":
            self.person, self.code = person, rest[0]
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
        """See that everything acknowledged of the person who is there now is kept as it was.

        under_way : answers that may be kept though nobody was told so: one of every life since the last look.
        """
        assert study_problems(self.study.folder, people=(self.person,)) == ()
        state = read_session(self.study.person_folder(self.person) / "session.jsonl", self.study.plan)
        kept = {} if state is None else {str(n): one.answer.choice for n, one in state.answers.items()}
        said = {n: choice for (person, n), choice in self.answers.items() if person == self.person}
        assert said.items() <= kept.items()
        # in the order that was drawn
        assert list(kept) == sorted(kept, key=int)
        assert len(kept) <= len(said) + under_way
        self.answers |= {(self.person, n): choice for n, choice in kept.items()}


def check_labels(study: Study, witness: Witness, passphrase: str) -> None:
    """See that what was prepared in any life is what was drawn, and that the answers are unsealed by it."""
    keeper = study.keeper(passphrase)
    drawn = {
        (one.name, str(trial.number)): trial
        for one in study.people()
        for trial in study.schedule_by_keeper(one.name, keeper).trials
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
