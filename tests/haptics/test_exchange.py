"""The entries of the package: what the core tells of a format is what the format tells of itself."""

from dataclasses import asdict

import pytest

from fdvv import extras
from fdvv.button.export_file import EXPORT_FORMATS
from fdvv.errors import InputError
from fdvv.formats.exchange.exchange_format import ExportFormat
from fdvv_haptics.exchange import AHAP

KNOWN = [form for form in EXPORT_FORMATS if form.name in extras.installed("exchange_formats")]


@pytest.mark.parametrize("form", KNOWN, ids=lambda form: form.name)
def test_the_core_describes_a_format_as_the_format_does(form: ExportFormat) -> None:
    found = asdict(extras.load("exchange_formats", form.name))
    assert {name: found[name] for name in asdict(form)} == asdict(form)


def test_every_format_of_the_package_is_known_to_the_core() -> None:
    assert sorted(form.name for form in KNOWN) == ["ahap", "haptic", "hjif", "mjcf", "smartknob"]


def test_a_silent_file_is_refused_in_a_line() -> None:
    quiet = b'{"EventParameters": [{"ParameterID": "HapticIntensity", "ParameterValue": 0.0}]'
    event = quiet + b', "Time": 0.0, "EventType": "HapticContinuous", "EventDuration": 0.1}'
    with pytest.raises(InputError, match="the pulse is silent") as found:
        AHAP.read(b'{"Pattern": [{"Event": ' + event + b"}]}", 1.0)
    assert "\n" not in str(found.value)
