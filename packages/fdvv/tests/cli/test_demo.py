"""The main job, end to end, on the twin."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from fdvv.cli.demo_report import demo_report
from fdvv.cli.demo_run import DemoResult, demo
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError


@pytest.fixture(scope="module")
def result() -> DemoResult:
    return demo(lambda seed: TwinDevice(seed=seed), seed=3)


def mean_cN(result: DemoResult, label: str, stroke: str) -> float:
    rows = [row for row in result.rows() if row["stroke"] == stroke]
    return float(np.mean([row[label]["mean_error_cN"] for row in rows]))


@pytest.mark.slow
def test_compensation_renders_nearer_to_the_button_than_its_own_force(result: DemoResult) -> None:
    # measured over three seeds: 45 to 6 cN on the press; half of the gain is asked for
    for stroke in ("press", "release"):
        assert mean_cN(result, "FDVV", stroke) < 0.5 * mean_cN(result, "uncompensated", stroke)


@pytest.mark.slow
def test_the_release_needs_the_curve_of_its_own_speed(result: DemoResult) -> None:
    assert mean_cN(result, "FDVV", "release") < 0.6 * mean_cN(result, "FD only", "release")


@pytest.mark.slow
def test_learning_and_judging_meet_different_presses(result: DemoResult) -> None:
    judged = [c.error_cN.tolist() for c in result.renderings[-1].judged.curves]
    learned = result.renderings[-1].learned
    assert learned is not None
    assert all(list(c.error_cN)[: len(e)] != e for c, e in zip(learned.outcome.curves, judged, strict=True))
    assert result.to_dict()["simulated"] is True


class Words(HTMLParser):
    """Collect the text of a page, and whatever it would fetch."""

    def __init__(self) -> None:
        super().__init__()
        self.text: list[str] = []
        self.fetched: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.fetched += [v for k, v in attrs if k == "src" and v]

    def handle_data(self, data: str) -> None:
        self.text.append(data)


@pytest.mark.slow
def test_the_report_says_simulated_holds_every_figure_of_the_table_and_fetches_nothing(
    result: DemoResult,
) -> None:
    page = Words()
    page.feed(demo_report(result))
    text = " ".join(page.text)
    assert page.fetched == []
    assert "Simulated:" in text
    for row in result.rows():
        for label in ("uncompensated", "FD only", "FDVV"):
            assert f"{row[label]['mean_error_cN']:.2f} / {row[label]['max_error_cN']:.2f}" in text


def test_a_switch_file_that_cannot_be_fitted_is_refused_by_its_name(tmp_path: Path) -> None:
    path = tmp_path / "short.csv"
    path.write_text("displacement_mm,force_cN\n" + "".join(f"{0.1 * i:.1f},{30 + i}\n" for i in range(8)))
    with pytest.raises(InputError, match=r"short\.csv"):
        demo(lambda seed: TwinDevice(seed=seed), switch=path)
