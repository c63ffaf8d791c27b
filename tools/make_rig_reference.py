"""Write the parameters of rig, finger and real buttons, for the site."""

from __future__ import annotations

import re

from fdvv.twin.files import button_names, button_to_toml, finger_to_toml, load_button, rig_to_toml
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig

SHOWN = "mx-red"


def rig_parameters() -> str:
    """Return the parameters of rig and finger."""
    return f"""## Rig

```toml
{rig_to_toml(Rig())}```

## Finger

```toml
{finger_to_toml(Finger())}```
"""


def button_parameters() -> str:
    """Return the list of the shipped buttons and the parameters of one."""
    shipped = [load_button(name) for name in button_names()]
    rows = "\n".join(f"| `{b.name}` | {b.source} | {b.licence} |" for b in shipped)
    return f"""## Shipped

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
