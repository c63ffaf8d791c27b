"""Trials of one person: what hides behind each label, and what was answered."""

from __future__ import annotations

from msgspec import Struct

EQUAL = "equal"
"""The answer that no rendering is closer, stronger or better."""


class StudyTrial(Struct, frozen=True, forbid_unknown_fields=True):
    """A trial before it is shown. **Secret** but for number, item, round and practice.

    Attributes
    ----------
    number : 0, 1, ... of the person, practice included. item : name of the item. round : 0, 1, ...
    labels : what each label hides, by stimulus name; with "X" where X is rendered and hidden.
    correct : the label that is right where there is one ("A" or "B"), else "".
    ratio : of force added to the comparison of a staircase; 0 elsewhere. Filled in when its turn comes.
    change : of force, snap and vibration added to the comparison where thresholds are measured, likewise.
    """

    number: int
    item: str
    round: int
    labels: dict[str, str]
    practice: bool = False
    correct: str = ""
    ratio: float = 0.0
    change: tuple[float, ...] = ()


class TrialAnswer(Struct, frozen=True, forbid_unknown_fields=True):
    """What a person answered.

    Attributes
    ----------
    choice : a label, `EQUAL`, or "" where only ratings are asked. ratings : by rating's name, then by label.
    switches : seconds since the trial was shown and the label that was gone to, in order.
    presses : of each label, X included. time_s : from shown to answered.
    """

    choice: str = ""
    ratings: dict[str, dict[str, float]] = {}
    switches: tuple[tuple[float, str], ...] = ()
    presses: dict[str, int] = {}
    time_s: float = 0.0


class Rendered(Struct, frozen=True, forbid_unknown_fields=True):
    """What was physically rendered in a trial, from telemetry. **Secret**: it reveals what a label hid.

    Attributes
    ----------
    label, stimulus : what was asked for. presses : reported by the device.
    error_cN : rms of rendered against intended force, by press; nan: could not be judged.
    velocity_mm_s : mean speed, by press. vibrations : that were played. faults : names.
    """

    label: str
    stimulus: str
    presses: int = 0
    error_cN: tuple[float | None, ...] = ()
    velocity_mm_s: tuple[float | None, ...] = ()
    vibrations: int = 0
    faults: tuple[str, ...] = ()
