"""A server killed at any moment: every edit that it acknowledged is there, and the model file is whole."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from fdvv.model.file import load_builtin, load_model
from fdvv_studio.project.documents import DocumentStore
from fdvv_studio.project.patch import model_of
from tests.support.campaign import campaign

EDITOR = """
import itertools, sys
from pathlib import Path
from fdvv_studio.project.documents import DocumentStore
from fdvv_studio.project.history import EditMade, RedoMade, UndoMade
from fdvv_studio.project.patch import patch_between
drafts = DocumentStore(Path(sys.argv[1]))
start = drafts.open("a").revision
print("ready", start, flush=True)
for i in itertools.count(start):
    state = drafts.open("a")
    if i % 7 == 5:
        change = UndoMade(f"c{i}", 2)
    elif i % 7 == 6:
        change = RedoMade(f"c{i}", 1)
    else:
        record = {**state.history.record, "travel_mm": 3.0 + (i % 90) / 100}
        change = EditMade(f"c{i}", str(i), patch_between(state.history.record, record), i % 5 == 4, float(i))
    kept = drafts.change("a", state.revision, change)
    print(kept.revision, drafts.open("a").history.record["travel_mm"], flush=True)
"""


@campaign("seed", range(42), part=2)
def test_every_acknowledged_edit_survives_a_kill(tmp_path: Path, seed: int) -> None:
    project, rng = tmp_path / "project", random.Random(seed)
    drafts = DocumentStore(project)
    drafts.create("a", load_builtin("mx-clear"))
    drafts.close()
    for _ in range(2):
        start, acknowledged = killed(project, rng.uniform(0.0, 0.25))
        drafts = DocumentStore(project)
        state = drafts.open("a")
        newest = max(acknowledged, default=start)
        # at most the edit that was under way when the signal came is there beyond the last acknowledged one
        assert newest <= state.revision <= newest + 1
        if acknowledged and state.revision == newest:
            assert state.history.record["travel_mm"] == acknowledged[newest]
        found = load_model(project / "buttons" / "a.fdvv.json")
        assert found == model_of(state.history.record, "a")
        assert [p.name for p in (project / "buttons").glob("[!.]*")] == ["a.fdvv.json"]
        assert "changed outside" not in [step.label for step in state.history.steps]
        drafts.close()


def killed(project: Path, after_s: float) -> tuple[int, dict[int, float]]:
    """Run an editor and kill it: the revision it began with, and the travel of each it acknowledged."""
    command = [sys.executable, "-c", EDITOR, str(project)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        word, start = process.stdout.readline().split()
        assert word == "ready"
        time.sleep(after_s)
        process.send_signal(signal.SIGKILL)
        rest = process.stdout.read()
    assert process.returncode == -signal.SIGKILL
    lines = [line.split() for line in rest.split("\n")[:-1]]
    return int(start), {int(revision): float(travel_mm) for revision, travel_mm in lines}
