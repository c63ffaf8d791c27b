"""What a group came to: a sentence, figures by name, and a page."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from fdvv._version import __version__
from fdvv.report.report import Section, Table, render_html
from fdvv.report.svg import figure_svg
from fdvv_people.optimize.group.group import Group
from fdvv_people.optimize.group.playoff import Playoff
from fdvv_people.optimize.run.front import score_label
from fdvv_people.optimize.run.report import DesignPanel, control_points, plot_designs
from fdvv_people.optimize.run.verdict import phrase_for

SIMULATED = "simulated people pressed the twin; no human and no hardware took part"
PLAYED = "A person's gain is that of the blocks; the mean counts for people like these."
EXPECTED = (
    "Expected from the scores of all runs, for just these people. It is often too small, because few runs "
    "tried what their person does not like. Only presses on both buttons settle it."
)


def gain_sentence(group: Group, playoff: Playoff | None) -> str:
    """Return what personalising gains, in one sentence, and what to do."""
    found, phrase = playoff.gain if playoff else group.gain, phrase_for(group.runs[0].setup.objectives[0])
    people = f"{len(group.runs)} people{', simulated' if group.simulated else ''}"
    how = people if playoff else f"{people}; expected from the runs, not yet played"
    doubt = phrase.doubt(found.low, found.high, found.chance)
    each = f"; {playoff.gaining} of them gain, each by their own interval" if playoff else ""
    if found.kind == "same":
        return f"No gain found of a button of one's own {doubt}, {how}{each}."
    by = phrase.difference(found.difference)
    if found.kind == "worse":
        return f"Take the group's button: one's own is {by} {doubt}, {how}{each}."
    return f"Personalise: a button of one's own is {by} {doubt}, {how}{each}."


def group_report(group: Group, playoff: Playoff | None) -> dict[str, Any]:
    """Return the figures by name; gains are positive where a person's own button is better.

    expected : from the scores of the runs. played : of presses afterwards; None where nobody pressed.
    """
    first = group.runs[0].setup
    return {
        "space": group.runs[0].space.name,
        "task": first.task,
        "level": first.level,
        "objective": first.objectives[0].name,
        "design": group.design,
        "people": [
            {"name": run.name, "own": run.own, "expected_gain": gain, "expected_sd": sd}
            for run, gain, sd in zip(group.runs, group.expected, group.sd, strict=True)
        ],
        "expected": asdict(group.gain),
        "played": asdict(playoff) if playoff else None,
        "verdict": gain_sentence(group, playoff),
        "simulated": group.simulated,
    }


def group_html(group: Group, playoff: Playoff | None) -> str:
    """Write the page. Needs matplotlib (BuildError without it)."""
    first = group.runs[0].setup
    text = [gain_sentence(group, playoff), PLAYED if playoff else EXPECTED]
    sections = [
        Section("Verdict", tuple(text), (), (_people(group, playoff),)),
        Section("Designs", (), (_designs(group),) if first.space.kind != "own" else (), (_values(group),)),
    ]
    summary = f"{len(group.runs)} people, one run each, in the space {group.runs[0].space.name}."
    footer = f"fdvv {__version__}"
    return render_html(
        f"A group's button: {first.title}", summary, sections, footer, SIMULATED if group.simulated else None
    )


def _people(group: Group, playoff: Playoff | None) -> Table:
    phrase = phrase_for(group.runs[0].setup.objectives[0])
    unit = f", {phrase.unit}" if phrase.unit else ""
    if playoff is None:
        rows = [
            (run.name, phrase.number(gain), f"± {phrase.number(1.96 * sd)}")
            for run, gain, sd in zip(group.runs, group.expected, group.sd, strict=True)
        ]
        return Table(("person", f"gain of their own{unit}", "95 %"), tuple(rows))
    label = score_label(group.runs[0].setup.objectives[0].name)
    found = [
        (
            one.name,
            f"{one.own:.1f}",
            f"{one.group:.1f}",
            phrase.number(one.gain.difference if one.gain else 0.0),
            f"{phrase.number(one.gain.low)} to {phrase.number(one.gain.high)}"
            if one.gain
            else "the same button",
        )
        for one in playoff.people
    ]
    head = ("person", f"own: {label}", f"the group's: {label}", f"gain{unit}", "95 %")
    return Table(head, tuple(found))


def _designs(group: Group) -> str:
    panels = [DesignPanel("the group's", group.model(group.design), control_points(group.design))]
    panels += [DesignPanel(run.name, group.model(run.own), control_points(run.own)) for run in group.runs]
    return figure_svg(plot_designs(panels, 3, group.simulated), "The group's button and everybody's own")


def _values(group: Group) -> Table:
    names = group.runs[0].space.names
    designs = [("the group's", group.design), *((run.name, run.own) for run in group.runs)]
    rows = tuple((name, *(f"{design[one]:.2f}" for one in names)) for name, design in designs)
    return Table(("button", *map(score_label, names)), rows)
