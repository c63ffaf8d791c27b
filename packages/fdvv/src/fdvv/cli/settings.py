"""Options of a command made of the settings of its use case."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import click

from fdvv.cli import ui
from fdvv.settings import Setting, Settings, settings_of

Command = Callable[..., Any]


def settings_options(
    kind: type[Settings], *, leave_out: tuple[str, ...] = ()
) -> Callable[[Command], Command]:
    """Return what adds an option for each setting to a command; their values reach it as one ``settings``.

    leave_out : settings that the command takes in another way, or leaves at their defaults.
    """
    shown = [setting for setting in settings_of(kind) if setting.name not in leave_out]

    def add(command: Command) -> Command:
        @functools.wraps(command)
        def call(**values: Any) -> Any:
            settings = kind(**{setting.name: values.pop(setting.name) for setting in shown})
            return command(settings=settings, **values)

        return ui.options(*map(_option, shown))(call)

    return add


def option_name(setting: Setting) -> str:
    return setting.option or f"--{setting.name.replace('_', '-')}"


def _option(setting: Setting) -> Callable[[Command], Command]:
    facts: dict[str, Any] = {"default": setting.default, "help": setting.help}
    if setting.kind == "flag":
        facts["is_flag"] = True
    else:
        facts |= {"type": _type(setting), "multiple": setting.several and not setting.joined}
    return ui.option(option_name(setting), setting.name, **facts)


def setting_type(kind: type[Settings], name: str) -> click.ParamType[Any]:
    """Return what reads the value of one setting."""
    return next(_type(setting) for setting in settings_of(kind) if setting.name == name)


def _type(setting: Setting) -> click.ParamType[Any]:
    if setting.joined:
        return Joined(setting)
    if setting.choices:
        return click.Choice(setting.choices)
    if setting.kind == "text":
        return click.STRING
    if setting.kind == "whole":
        least, most = (None if bound is None else int(bound) for bound in (setting.least, setting.most))
        return click.IntRange(least, most)
    return ui.Finite(setting.least, setting.most)


class Joined(click.ParamType[tuple[float, ...]]):
    """Numbers with commas between them."""

    name = "number,..."

    def __init__(self, setting: Setting) -> None:
        self._setting = setting

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, ...]:
        if isinstance(value, tuple):
            return value
        try:
            numbers = tuple(float(part) for part in str(value).split(","))
        except ValueError:
            self.fail(f"{value!r} must be numbers with commas between them, as 50,100", param, ctx)
        if refusal := self._setting.refusal(numbers):
            self.fail(refusal, param, ctx)
        return numbers
