"""Write docs/reference/rig.md from the twin's own parameters."""

from __future__ import annotations

from pathlib import Path

from fdvv.twin import Finger, Rig, finger_to_toml, rig_to_toml

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "rig.md"


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


if __name__ == "__main__":
    PAGE.write_text(reference())
