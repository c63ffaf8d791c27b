"""What a probe's file in a project gives the editor to draw. Simulated."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import start_surface
from fdvv.rendering.probe import ProbeResult, probe
from fdvv_studio.project.measured_bands import load_measured_button


@pytest.fixture(scope="module")
def probed() -> ProbeResult:
    device, model = TwinDevice(seed=3), load_builtin("mx-clear")
    return probe(device, model, start_surface(device, model, [50.0, 100.0]), [50.0, 100.0], presses=3)


def kept(project: Path, text: str) -> Path:
    path = project / "measured" / "my-button.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def test_the_bands_are_the_quartiles_of_the_presses(tmp_path: Path, probed: ProbeResult) -> None:
    kept(tmp_path, json.dumps(probed.to_dict()))
    found = load_measured_button(tmp_path, "my-button")
    assert found is not None
    assert (found.device_name, found.presses, found.simulated) == (probed.device_name, 6, True)
    assert len(found.curves) == 4
    for band, curve in zip(found.curves, probed.curves, strict=True):
        assert (band.stroke, band.velocity_mm_s) == (curve.stroke, curve.velocity_mm_s)
        expected = np.quantile(curve.rendered_cN, [0.25, 0.5, 0.75], axis=0)
        np.testing.assert_allclose([band.low_cN, band.median_cN, band.high_cN], expected)
        np.testing.assert_array_equal(band.displacement_mm, curve.displacement_mm)


@pytest.mark.parametrize("name", ["other", "../measured/my-button", "my-button.json", ""])
def test_a_button_without_a_file_has_no_bands(tmp_path: Path, probed: ProbeResult, name: str) -> None:
    kept(tmp_path, json.dumps(probed.to_dict()))
    assert load_measured_button(tmp_path, name) is None


def test_a_broken_file_is_named_with_its_remedy(tmp_path: Path, probed: ProbeResult) -> None:
    kept(tmp_path, "{}")
    with pytest.raises(InputError, match=r"my-button\.json.*probe the button again"):
        load_measured_button(tmp_path, "my-button")
    document = probed.to_dict()
    document["curves"][1]["displacement_mm"].pop()
    kept(tmp_path, json.dumps(document))
    with pytest.raises(InputError, match=r"\$\.curves\[1\].*different length"):
        load_measured_button(tmp_path, "my-button")
