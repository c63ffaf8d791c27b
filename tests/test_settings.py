"""One record says what a use case can be set to; every door shows it."""

from __future__ import annotations

from typing import Annotated, Any

import click
import msgspec
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from tools.make_record_reference import settings_tables
from tools.make_studio_types import settings_reference

from fdvv.cli.settings import settings_options
from fdvv.errors import ModelError, SettingError
from fdvv.protocol.tables import SURFACE_VELOCITIES
from fdvv.rendering.settings import SPEED_LIMIT, CompensateSettings, ProbeSettings
from fdvv.settings import Settings, about
from fdvv_studio.studio.jobs.orders import SETTINGS


def command_of(kind: type[Settings]) -> click.Command:
    @click.command()
    @settings_options(kind)
    def show(settings: Settings) -> None:
        click.echo(msgspec.json.encode(settings).decode())

    return show


def test_a_parameter_is_one_line_and_reaches_command_message_schema_page_and_document(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Learn(CompensateSettings):
        patience: Annotated[int, about("Rounds without gain before it ends.", ge=1, le=9)] = 3

    ran = CliRunner().invoke(command_of(Learn), ["--patience", "5"])
    assert msgspec.json.decode(ran.output)["patience"] == 5
    assert "Rounds without gain" in CliRunner().invoke(command_of(Learn), ["--help"]).output
    assert CliRunner().invoke(command_of(Learn), ["--patience", "10"]).exit_code == 2
    shown: Any = msgspec.json.schema(Learn)["$defs"]["Learn"]["properties"]["patience"]
    assert (shown["minimum"], shown["maximum"], shown["default"]) == (1, 9, 3)
    with pytest.raises(msgspec.ValidationError, match="patience"):
        msgspec.json.decode(b'{"patience": 10}', type=Learn)
    with pytest.raises(ModelError, match="patience must be 1 to 9, got 10"):
        Learn(patience=10)
    monkeypatch.setitem(SETTINGS, "compensate", Learn)
    assert '"patience": {' in settings_reference()
    assert "Rounds without gain before it ends." in settings_tables()


@given(st.integers(-10, 300))
def test_python_messages_and_options_accept_the_same_numbers(presses: int) -> None:
    def accepted(make: Any) -> bool:
        try:
            make()
        except (ModelError, msgspec.ValidationError):
            return False
        return True

    allowed = 1 <= presses <= 200
    assert accepted(lambda: ProbeSettings(presses=presses)) == allowed
    assert accepted(lambda: msgspec.convert({"presses": presses}, ProbeSettings)) == allowed
    ran = CliRunner().invoke(command_of(ProbeSettings), ["--presses", str(presses)])
    assert (ran.exit_code == 0) == allowed


@pytest.mark.parametrize("speeds", [(), (50.0, 50.0), (4.0,), (float("nan"),), (True,), tuple(range(50, 70))])
def test_speeds_that_no_board_takes_are_refused(speeds: tuple[float, ...]) -> None:
    with pytest.raises(ModelError, match="velocities_mm_s must"):
        ProbeSettings(velocities_mm_s=speeds)


def test_as_many_speeds_are_taken_as_a_board_has_rows() -> None:
    assert SPEED_LIMIT == SURFACE_VELOCITIES
    ProbeSettings(velocities_mm_s=tuple(map(float, range(50, 50 + SPEED_LIMIT))))


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        ({"presses": 3}, "presses"),
        ({"literal": True}, "literal"),
        ({"method": "paper", "rounds": 0}, "rounds"),
    ],
)
def test_a_setting_of_the_other_method_is_refused_by_its_name(wrong: dict[str, Any], name: str) -> None:
    with pytest.raises(SettingError, match=f"^{name} belongs to the method"):
        CompensateSettings(**wrong)
