"""Write docs/reference/rig.md and button.md from the twin's own parameters."""

from __future__ import annotations

import re
from pathlib import Path

from fdvv.twin import Finger, Rig, button_names, button_to_toml, finger_to_toml, load_button, rig_to_toml

PAGES = Path(__file__).parents[1] / "docs" / "reference"
SHOWN = "mx-red"


def reference() -> str:
    """Give the page's text."""
    return f"""# Rig and finger files

Made from the twin's own parameters by `tools/make_rig_reference.py`; do not edit.

`--rig FILE` and `--finger FILE` give the twin another plant. A file names what it changes; everything else
keeps its default. After each parameter: its meaning, its plausible range, and where the value comes from
(paper: the CHI 2020 paper; class: data of parts of the same class; rule: follows from how the part works;
assumed: nobody measured it, sweep it). An unknown name or a value out of range is refused with the bound.

## Rig

```toml
{rig_to_toml(Rig())}```

## Finger

```toml
{finger_to_toml(Finger())}```
"""


def button_reference() -> str:
    """Give the page's text on buttons."""
    shipped = [load_button(name) for name in button_names()]
    rows = "\n".join(f"| `{b.name}` | {b.source} | {b.licence} |" for b in shipped)
    return f"""# Button files

Made from the twin's own parameters by `tools/make_rig_reference.py`; do not edit.

A button file is a real button for the twin: its slow press and release curves and what its physics needs.
`fdvv.twin.load_button` takes the name of a shipped button or the path of a file, `button_of_model` makes a
button of any model that has both strokes. A parameter left out keeps its default; the two curves and the
three words at the top are needed. After each parameter: its meaning, its plausible range, and where the value
comes from (curves: the button's own slow curves say it, or were drawn to say it; literature: cited in
[real buttons](../explanation/real-buttons.md); paper, class, rule, assumed: as for
[rig and finger](rig.md)). An unknown name or a value out of range is refused with the bound.

A leaf switch that was designed and not measured (`fdvv mechanism`) has a last section `[cam]`: `preload_N`
of the leaf where it just reaches the fixed contact, and as many values as `press_N` of `elastic_N` (the
coil, less what the top stop bears), `height_m` (the cam, 0 where the leaf just reaches the contact),
`rail_N` (friction of the guide) and `friction_ratio` (cam on leaf). The twin then takes the switch as it is
built; the two curves tell it nothing.

## Shipped

`tools/make_buttons.py` makes them.

| button | source of its curves | licence of the curves |
|---|---|---|
{rows}

## A file

`{SHOWN}`, its curves shortened here.

```toml
{_shortened(button_to_toml(load_button(SHOWN)))}```
"""


def _shortened(text: str) -> str:
    """Keep the first line of every list."""
    return re.sub(r"(= \[\n.*?\n).*?\n\]", r"\1    ...\n]", text, flags=re.DOTALL)


if __name__ == "__main__":
    (PAGES / "rig.md").write_text(reference())
    (PAGES / "button.md").write_text(button_reference())
