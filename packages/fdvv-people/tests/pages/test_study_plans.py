"""Declarations in the studio: from a template with a button of one's own, tried before they are frozen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from fdvv_people.pages.api.study_plans import OWN, with_button
from fdvv_people.pages.studies import TRIED, Studies
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.plan_file import read_plan_text, template_names, template_text
from fdvv_studio.studio.seats import Seats
from fdvv_studio.studio.studio import Studio
from tests.browser.study_screens import NAME, plan_text


def asked(client: TestClient, name: str, **question: Any) -> dict[str, Any]:
    found: dict[str, Any] = client.post(f"/api/studies.{name}", json={"study": NAME, **question}).json()
    return found


@pytest.mark.parametrize("template", template_names())
def test_a_button_takes_the_place_of_those_that_are_rendered_in_two_ways(template: str) -> None:
    text = template_text(template)
    changed = with_button(text, 'my "button"', OWN)
    before, after = read_plan_text(text, template), read_plan_text(changed, template)
    if template not in ("realism", "abx"):
        assert changed == text
        return
    (item,) = after.items
    assert item.name == 'my "button"'
    assert {one.button for one in item.stimuli} == {OWN}
    assert [one.rendered for one in item.stimuli] == [one.rendered for one in before.items[0].stimuli]
    assert (after.claim, after.pages, after.exclusion) == (before.claim, before.pages, before.exclusion)


def test_a_study_of_a_chosen_button_is_declared_and_ready(client: TestClient) -> None:
    made = client.post(
        "/api/studies.create", json={"name": NAME, "template": "abx", "button": "builtin:mx-clear"}
    )
    assert made.json() == {"study": NAME}
    plan = asked(client, "plan")
    assert plan["problems"] == []
    assert all(part in plan["text"] for part in (OWN, f'\nname = "{NAME}"'))
    assert asked(client, "standing")["sentence"].startswith("Ready to freeze: ")


def test_a_study_is_tried_in_a_copy_and_nothing_of_it_is_kept(client: TestClient, own_studio: Studio) -> None:
    folder = own_studio.project / "studies"
    study = Study.declare_text(folder / NAME, plan_text(), folder)
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    found = asked(client, "rehearse")
    assert found["study"] == f"{TRIED}{NAME}"
    studies = own_studio.part(Studies)
    assert own_studio.part(Seats).find(found["seat"]) is not None
    copy = studies.study(found["study"])
    assert copy.frozen is not None
    assert copy.sessions_open
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before
    assert study.frozen is None
    assert studies.names() == [NAME]
    again = asked(client, "rehearse")
    assert not copy.folder.exists()
    studies.close()
    assert not Path(studies.path(again["study"])).exists()


def test_a_plan_with_problems_is_not_tried(client: TestClient) -> None:
    """A model of one speed without vibration is the same in both ways."""
    client.post("/api/studies.create", json={"name": NAME, "template": "abx", "button": "builtin:mx-red"})
    assert "feel the same" in asked(client, "rehearse")["error"]
    standing = asked(client, "standing")
    assert standing["sentence"].startswith("Not ready to freeze: items ('mx-red')")
    assert standing["kind"] == "warning"
