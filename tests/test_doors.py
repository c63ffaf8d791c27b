"""What a use case can be set to is the same in every door: command, page, socket, Python and files."""

from __future__ import annotations

from typing import Any, get_args

import msgspec
import pytest
from msgspec import inspect
from tools.make_studio_types import shown_settings

from fdvv.cli.main import cli
from fdvv.settings import Setting, settings_of
from fdvv_campaigns.serve.messages import BeginRun
from fdvv_people.optimize.run.settings import RunSettings
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.pages.api.optimize_setup import OptimizeCreate
from fdvv_studio.studio.jobs.orders import Order

COMMANDS = {"optimize": ("optimize", "run")}
"""Of use cases that are no command of their own."""


def parameters_of(name: str) -> dict[str, Any]:
    """Return the parameters of the command of a use case, by the names of settings."""
    command: Any = cli
    for word in COMMANDS.get(name, (name,)):
        command = command.get_command(None, word)
    return {parameter.name: parameter for parameter in command.params}


def bounds_of(kind: inspect.Type) -> tuple[float | None, float | None]:
    """Return least and most of a number in a message; None is allowed beside it or not."""
    if isinstance(kind, inspect.Metadata):
        return bounds_of(kind.type)
    if isinstance(kind, inspect.UnionType):
        return next(bounds_of(one) for one in kind.types if not isinstance(one, inspect.NoneType))
    assert isinstance(kind, inspect.IntType)
    return kind.ge, kind.le


@pytest.mark.parametrize("name", shown_settings())
def test_the_options_of_a_command_have_the_bounds_and_defaults_of_the_settings(name: str) -> None:
    parameters = parameters_of(name)
    for setting in settings_of(shown_settings()[name]):
        option = parameters.get(setting.name)
        if option is None:  # --compare/--rate are one word of the settings
            assert (name, setting.name) == ("tune", "asking")
            continue
        assert option.default == setting.default
        if setting.kind in ("whole", "number") and not setting.joined:
            assert (option.type.min, option.type.max) == (setting.least, setting.most)


@pytest.mark.parametrize("kind", get_args(Order))
def test_an_order_of_the_page_is_read_and_stored_with_the_same_settings(kind: type[msgspec.Struct]) -> None:
    (settings,) = (field for field in msgspec.structs.fields(kind) if field.name == "settings")
    assert settings.type is shown_settings()[str(kind.__struct_config__.tag)]


@pytest.mark.parametrize(
    ("message", "name", "setting"),
    [
        (OptimizeSetup, "budget", "budget"),
        (OptimizeCreate, "budget", "budget"),
        (OptimizeCreate, "task_presses", "presses"),
        (OptimizeCreate, "retest", "retest"),
        (BeginRun, "budget", "budget"),
        (BeginRun, "retest", "retest"),
    ],
)
def test_a_run_has_one_budget_one_retest_and_one_number_of_presses(
    message: type[msgspec.Struct], name: str, setting: str
) -> None:
    (wanted,) = (one for one in settings_of(RunSettings) if one.name == setting)
    (field,) = (one for one in msgspec.structs.fields(message) if one.name == name)
    assert isinstance(wanted, Setting)
    assert bounds_of(inspect.type_info(field.type)) == (wanted.least, wanted.most)
