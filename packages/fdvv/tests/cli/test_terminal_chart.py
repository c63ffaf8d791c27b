"""Curves in the terminal: where their dots are, and where none are drawn."""

from __future__ import annotations

import os
import pty
import select
import subprocess
import sys

import click
import numpy as np

from fdvv.cli.terminal_chart import ROWS, TerminalCurve, chart_lines
from fdvv.model.model import FDVVModel
from tests.support.buttons import line_model


def cells(model: FDVVModel, columns: int = 60) -> list[str]:
    """Return the rows of the plot without their labels and colours."""
    lines = chart_lines([TerminalCurve(curve, 0) for curve in model.of("press")], columns)
    assert len(lines) == ROWS + 2
    return [click.unstyle(line)[7:] for line in lines[1:-1]]


def test_a_line_from_zero_climbs_from_the_lower_left_to_the_upper_right() -> None:
    rows = cells(line_model("ramp", 0.0, 10.0))
    firsts = [len(row) - len(row.lstrip()) for row in rows]
    assert firsts == sorted(firsts, reverse=True)
    assert rows[-1][0] != " "
    assert rows[0].rstrip() == rows[0]
    dots = sum(bin(ord(sign) - 0x2800).count("1") for row in rows for sign in row if sign != " ")
    assert dots >= 2 * len(rows[0])


def test_a_level_line_lies_in_the_top_row_at_its_force() -> None:
    rows = cells(line_model("level", 40.0, 0.0))
    assert [row.strip() != "" for row in rows] == [True] + [False] * (ROWS - 1)
    top = chart_lines([TerminalCurve(line_model("level", 40.0, 0.0).curves[0], 0)], 60)[1]
    assert top.split()[0] == "40"


def on_a_terminal(*arguments: str, typed: bytes = b"") -> str:
    """Run the command on a terminal of 100 columns and return what it shows."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "100", "PYTHONIOENCODING": "utf-8"}
    command = [sys.executable, "-m", "fdvv", *arguments]
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment) as process:
        os.close(theirs)
        os.write(ours, typed)
        shown = b""
        while select.select([ours], [], [], 30)[0]:
            try:
                shown += os.read(ours, 4096)
            except OSError:
                break  # Linux gives an error, not an end of file, once the other side has closed
    os.close(ours)
    assert process.returncode == 0, shown
    return shown.decode()


def test_show_draws_on_a_terminal_and_not_into_a_pipe() -> None:
    shown = on_a_terminal("show", "mx-clear")
    assert np.count_nonzero([0x2800 < ord(sign) < 0x2900 for sign in shown]) > 100
    piped = subprocess.run(
        [sys.executable, "-m", "fdvv", "show", "mx-clear"], capture_output=True, text=True, check=True
    ).stdout
    assert not any(0x2800 <= ord(sign) < 0x2900 for sign in piped)
    assert "\x1b" not in piped


def test_a_missing_argument_is_asked_for_on_a_terminal() -> None:
    shown = on_a_terminal("compare", typed=b"mx-red mx-clear\n")
    assert "buttons:" in shown
    assert "feels clearly different from mx-red" in shown
