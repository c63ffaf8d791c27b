"""The exciter of a rig, known through its own board and position sensor."""

from dataclasses import replace

import pytest

from fdvv.device.boards import HostBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson
from fdvv.errors import FitError
from fdvv.protocol.tables import Settings
from fdvv.rendering.exciter import identify_exciter, with_lead
from fdvv.twin.finger import Finger
from fdvv.twin.rig import PositionSensor, Rig
from fdvv.twin.rig_moves import Exciter
from fdvv.vibration.exciter import KnownExciter
from tests.support.scripted_person import ScriptedPerson

RIG = Rig(exciter=Exciter(latency_s=2e-4))
RESONANCE_Hz, QUALITY, GAIN_m_s2_V = 669.3, 1.96, 19.6
"""Of cap against magnet by the rig's numbers: 6 g on 14 g, 560 Hz held, Q 2.5, 2 N/A, 7.3 ohm."""


def host(rig: Rig, seed: int = 0) -> LinkedDevice:
    return LinkedDevice(HostBoard(), SimulatedPerson(rig, Finger(), seed))


def test_a_quiet_position_sensor_tells_the_exciter_in_short_tones_and_no_force_is_left() -> None:
    quiet = replace(RIG, position_sensor=PositionSensor(noise_m=1e-6, converter_bits=14, bandwidth_Hz=500.0))
    with host(quiet) as device:
        found = identify_exciter(device, tone_s=0.4)
        assert not device.port.outputs.enable
    assert found.resonance_Hz == pytest.approx(RESONANCE_Hz, rel=0.05)
    assert found.quality == pytest.approx(QUALITY, rel=0.25)
    assert found.simulated
    assert found.latency_s == pytest.approx(2e-4)
    assert found.tones == 14


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_default_sensor_tells_it_within_three_standard_errors(seed: int) -> None:
    with host(RIG, seed) as device:
        found = identify_exciter(device, tone_s=3.0)
    assert found.resonance_Hz == pytest.approx(RESONANCE_Hz, rel=3 * found.error["resonance_Hz"])
    assert found.gain_m_s2_V == pytest.approx(GAIN_m_s2_V, rel=3 * found.error["gain_m_s2_V"])
    assert found.error["resonance_Hz"] < 0.05


def test_a_rig_without_an_exciter_is_refused() -> None:
    silent = LinkedDevice(HostBoard(), ScriptedPerson())
    with silent as device, pytest.raises(FitError, match="check that the exciter plays and nobody touches"):
        identify_exciter(device, tone_s=0.3)


def test_the_board_is_configured_once_to_begin_as_early_as_latency_and_drive_require() -> None:
    known = KnownExciter(20.0, 600.0, 2.0, latency_s=0.007)
    settings = with_lead(Settings(), known, 0.001)
    assert settings.vibration_latency_us == 8000
    assert with_lead(settings, known, 0.001) == settings
    assert with_lead(Settings(), replace(known, latency_s=None)) == Settings()
