"""One button for several people, asked of the studio."""

from __future__ import annotations

from pathlib import Path

import pytest
from starlette.testclient import TestClient

from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.score import Score
from fdvv_studio.studio.studio import Studio


def scored_run(folder: Path, title: str, low_mm: float) -> None:
    """Write a run of a person who plays best where the contact closes at a depth."""
    setup = OptimizeSetup(engine="sobol", budget=10, level="easy", about={"title": title})
    with Optimization.create(folder, setup) as session:
        while trials := session.ask():
            session.show(trials[0].number)
            value = 40.0 + 5.0 * (trials[0].design["actuation_mm"] - low_mm) ** 2
            session.answer(trials[0].number, {"asynchrony_ms": Score(value, 2.0)})


@pytest.fixture
def people(own_studio: Studio) -> Studio:
    for number, (name, low_mm) in enumerate({"Anna": 1.0, "Ben": 5.0}.items(), start=1):
        scored_run(own_studio.project / "optimize" / str(number), name, low_mm)
    return own_studio


def test_two_people_get_one_button_between_theirs_and_a_sentence(people: Studio, client: TestClient) -> None:
    found = client.post("/api/optimize.group", json={"runs": [1, 2, 1]}).json()
    assert [one["name"] for one in found["people"]] == ["Anna", "Ben"]
    assert found["sentence"].startswith("Personalise: ")
    assert "expected from the runs, not yet played" in found["sentence"]
    assert 1.5 < found["design"]["actuation_mm"] < 4.5
    assert all(one["error"] > 0 for one in found["people"])
    made = client.post("/api/optimize.model", json={"run": 1, "design": found["design"], "name": "Group"})
    assert made.json()["model"]["name"] == "Group"


def test_runs_that_cannot_be_compared_are_refused_by_their_names(people: Studio, client: TestClient) -> None:
    with Optimization.create(people.project / "optimize" / "3", OptimizeSetup(about={"title": "Carl"})):
        pass
    for runs, said in (([1], "fewer than two"), ([1, 3], "Carl"), ([1, 9], "9")):
        refused = client.post("/api/optimize.group", json={"runs": runs})
        assert refused.status_code in (400, 422)
        assert said in refused.json()["error"]
