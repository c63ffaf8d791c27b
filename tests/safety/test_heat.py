"""The thermal model is never cooler than the coil that the board was built for, whatever is written to it."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter
from tools.make_board_limits import SHIPPED, header

from fdvv.errors import ModelError
from fdvv.firmware.core import Core, RecordArray
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import BoardLimits, Mode, Settings
from fdvv.twin.files import load_rig
from fdvv.twin.settings import limits_of, settings_of
from fdvv.units import FloatArray
from tests.safety._build import REPOSITORY, SOURCES, compile_c
from tests.safety.test_zero_force import constant_force
from tests.support.campaign import campaign
from tests.support.inputs import inputs_at

SCENE_s = 60.0
RIGS = ("voltage", "recommended", "light")
STRONG = {"force_limit_cN64": 32_000, "duty_gain_q16": 1_048_576, "tick_low_us": 50, "tick_high_us": 4000}
"""A board at any tick whose force only the supervisor's bound of the heat holds back."""


class Result(ctypes.Structure):
    """As heat_result in _heat.c."""

    _fields_ = (
        ("ticks", ctypes.c_int64),
        ("least_margin_K", ctypes.c_double),
        ("hottest_K", ctypes.c_double),
        ("mean_margin_K", ctypes.c_double),
    )


def boards() -> Iterator[BoardLimits]:
    """Yield the boards of rigs(), then those with the quickest and slowest coil."""
    yield from rigs()
    yield replace(limits_of(load_rig("voltage")), heat_time_ms=100, full_duty_rise_K=16_383)
    yield replace(limits_of(load_rig("voltage")), heat_time_ms=600_000, full_duty_rise_K=1)


def rigs() -> Iterator[BoardLimits]:
    """Yield the boards of the shipped rigs, then those with the slowest and quickest thermistor."""
    for name in RIGS:
        yield limits_of(load_rig(name))
    for name, lag_ms, share_q8 in (("voltage", 60_000, 128), ("recommended", 500, 256)):
        yield replace(limits_of(load_rig(name)), thermistor_lag_ms=lag_ms, thermistor_share_q8=share_q8)


def strong_rigs() -> Iterator[BoardLimits]:
    """Yield each as it is, and as STRONG."""
    for limits in rigs():
        yield limits
        yield replace(limits, **STRONG)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    folder = tmp_path_factory.mktemp("heat")
    sources = (Path(__file__).with_name("_heat.c"), *SOURCES)
    flags = ("-O3", "-fPIC", "-shared", "-ffp-contract=off")
    return ctypes.CDLL(str(compile_c(folder / "libheat.so", *flags, sources=sources, after=("-lm",))))


def play(
    library: ctypes.CDLL, seed: int, scenes: int, limits: BoardLimits, is_guarded: bool = False
) -> tuple[int, Result]:
    """Play scenes; return how many went well before one did not, and their margins."""
    result = Result()
    done = library.safety_heat(
        ctypes.c_uint32(seed),
        ctypes.c_int(scenes),
        ctypes.c_double(SCENE_s),
        ctypes.c_int(is_guarded),
        ctypes.create_string_buffer(limits.pack(), BoardLimits.length_bytes()),
        ctypes.byref(result),
    )
    return done, result


@campaign("block", range(1500), part=1)
def test_the_model_is_never_cooler_than_the_coil_in_a_million_random_minutes(
    library: ctypes.CDLL, block: int
) -> None:
    for number, limits in enumerate(boards()):
        done, result = play(library, 1_000_000 * (number + 1) + 100 * block, 100, limits)
        assert done == 100
        assert result.hottest_K > (limits.heat_time_ms <= 60_000) * 0.25 * limits.full_duty_rise_K


@campaign("block", range(2000), part=1)
def test_no_coil_is_beyond_the_limit_in_a_million_random_minutes_with_restarts_and_power_cuts(
    library: ctypes.CDLL, block: int
) -> None:
    hottest_K = 0.0
    for number, limits in enumerate(strong_rigs()):
        done, result = play(library, 1_000_000 * (number + 1) + 50 * block, 50, limits, is_guarded=True)
        assert done == 50
        assert result.hottest_K <= limits.heat_limit_K
        hottest_K = max(hottest_K, result.hottest_K / limits.heat_limit_K)
    assert hottest_K > 0.95


@pytest.mark.parametrize("tick_us", [50, 1000, 4000])
def test_a_board_that_is_late_in_every_tick_keeps_its_coil_below_the_limit(
    library: ctypes.CDLL, tick_us: int
) -> None:
    library.safety_late_K.restype = ctypes.c_double
    for name in RIGS:
        limits = replace(limits_of(load_rig(name)), **STRONG)
        strong = {
            "force_limit_cN64": 32_000,
            "duty_gain_q16": 1_048_576,
            "derate_start_K": limits.heat_limit_K - 1,
        }
        settings = replace(settings_of(load_rig(name)), tick_us=tick_us, **strong)
        hottest_K = library.safety_late_K(settings.pack(), limits.pack())
        assert limits.heat_limit_K - 3 < hottest_K <= limits.heat_limit_K


@pytest.mark.parametrize(("name", "whole_s"), [("voltage", 24.4), ("recommended", 3.5)])
def test_a_cold_coil_has_its_force_back_soon_after_a_power_cut(
    library: ctypes.CDLL, name: str, whole_s: float
) -> None:
    library.safety_recovery_s.restype = ctypes.c_double
    settings, limits = settings_of(load_rig(name)), limits_of(load_rig(name))
    found_s = library.safety_recovery_s(settings.pack(), limits.pack(), ctypes.c_int(2165))  # 22 C
    assert found_s == pytest.approx(whole_s, abs=0.5)


def coil_K(limits: BoardLimits, tick_s: float, outputs: RecordArray, start_K: float = 0.0) -> FloatArray:
    """Return the rise of the board's coil after each tick of these outputs, at the nominal supply."""
    keep = math.exp(-1e3 * tick_s / limits.heat_time_ms)
    end_K = limits.full_duty_rise_K * (outputs["duty_q15"] / 32768.0) ** 2
    warmed, _ = lfilter([1 - keep], [1, -keep], end_K, zi=[keep * start_K])
    return np.asarray(warmed)


def loaded(settings: Settings, force_cN: float, limits: BoardLimits) -> tuple[Core, RecordArray]:
    """Return an armed core with a flat program, and the inputs of a minute, with a little noise."""
    core = Core(settings, constant_force(round(64 * force_cN)), limits)
    inputs = inputs_at(settings, np.full(round(60e6 / settings.tick_us), 2.0))
    inputs["sum"] += np.arange(inputs.size, dtype=np.uint32) % 2
    inputs["supply_mV"] = limits.nominal_supply_mV
    core.arm()
    return core, inputs


@pytest.mark.parametrize("name", SHIPPED)
def test_the_limits_of_a_board_are_those_of_its_rig(name: str) -> None:
    written = (REPOSITORY / "firmware" / "boards" / name / "limits.h").read_text()
    assert written == header(name, SHIPPED[name].rig)


def test_settings_that_hide_the_heat_are_refused() -> None:
    # 1 K at full duty and the largest gain: the coil was at 253 K after a minute, the model at 0
    board = limits_of(load_rig("voltage"))
    wrong = Settings(full_duty_rise_K=1, duty_gain_q16=65_535, force_limit_cN64=32_000)
    with pytest.raises(ModelError, match=r"duty_gain_q16 is 65535, this board was built for at most 27783;"):
        Core(wrong, limits=board)
    for name, value, limit in (
        ("full_duty_rise_K", 1, "at least 596"),
        ("force_limit_cN64", 32_000, "at most 28160"),
    ):
        with pytest.raises(ModelError, match=f"{name} is {value}, this board was built for {limit};"):
            Core(Settings(**{name: value}), limits=board)


def test_the_largest_load_that_a_board_allows_never_takes_its_coil_over_the_limit() -> None:
    for rig in RIGS:
        board = replace(limits_of(load_rig(rig)), thermistor_lag_ms=0)  # by its model alone
        for time_ms in (100, board.heat_time_ms, 600_000):
            settings = replace(
                settings_of(load_rig(rig)),
                heat_time_ms=time_ms,
                duty_gain_q16=board.duty_gain_q16,
                derate_start_K=board.heat_limit_K - 1,
                tick_us=1000,
            )
            core, inputs = loaded(settings, board.force_limit_cN64 / 64, board)
            rise_K = coil_K(board, 1e-3, core.run(inputs))
            assert 5 < rise_K.max() < board.heat_limit_K


def test_a_coil_that_only_the_model_saves_stays_below_the_limit() -> None:
    # a force limit that would end at 600 K
    strong = Settings(duty_gain_q16=65_535, force_limit_cN64=32_000, tick_us=1000, heat_time_ms=5000)
    board = replace(limits_like(strong), duty_gain_q16=65_535)
    for time_ms, rise_K in ((100, 596), (5000, 20_000), (600_000, 596)):
        core, inputs = loaded(replace(strong, heat_time_ms=time_ms, full_duty_rise_K=rise_K), 440, board)
        outputs = core.run(inputs)
        rises_K = coil_K(board, 1e-3, outputs)
        assert rises_K.max() < board.heat_limit_K
        assert set(outputs["mode"]) & {Mode.DERATED, Mode.FAULT}
