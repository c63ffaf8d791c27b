"""Settings of press sessions: learning, judging and tuning on a rig."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from msgspec import Meta

from fdvv import extras
from fdvv.errors import SettingError
from fdvv.settings import Settings, about

if TYPE_CHECKING:
    from fdvv.compensation.identification.rig_file import LearnedRig
    from fdvv.compensation.method import Method
    from fdvv.compensation.paper import PaperLaw
    from fdvv.vibration.templates import TemplateGrid
    from fdvv.vibration.tune import Method as Question

Speed = Annotated[float, Meta(ge=5, le=500)]
"""Mean speed of a stroke, mm/s."""
Count = Annotated[int, Meta(ge=1, le=200)]
"""Of presses at one velocity."""
PaceRatio = Annotated[float, Meta(ge=0.05, le=1)]
SPEED_LIMIT = 16
"""Most rows of the table that a board holds (FDVV_SURFACE_VELOCITIES in firmware/core/protocol.h)."""
SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)  # the paper's speeds; MX Clear is measured at them
ROUNDS = {"rig-aware": 3, "paper": 4}
PRESSES = 12  # in 4 rounds at 4 speeds 192 (docs/explanation/paper-law.md); 15 would be the paper's 240
A_FEW = {"min_length": 1, "max_length": 5}


class PressSettings(Settings):
    """What every press session is set to: how fast is pressed, and what a press may miss."""

    seed: Annotated[int, about("Repeats the twin.", ge=0, le=2**31, label="Seed of the simulation")] = 0
    velocities_mm_s: Annotated[
        tuple[Speed, ...],
        about("mm/s; repeatable.", min_length=1, max_length=SPEED_LIMIT, option="--velocity", label="Speeds"),
    ] = SPEEDS_mm_s
    pace_ratio: Annotated[
        PaceRatio,
        about(
            "Part by which a press may miss its speed and still be used.",
            option="--pace-tolerance",
            label="Speed tolerance",
        ),
    ] = 0.35


class CompensateSettings(PressSettings):
    """How a rig learns to feel like a button."""

    method: Annotated[str, about("How to learn.", choices=("rig-aware", "paper"), more="methods")] = (
        "rig-aware"
    )
    rounds: Annotated[
        Annotated[int, Meta(ge=0, le=20)] | None,
        about(
            f"Presses per velocity once the rig is known, {ROUNDS['rig-aware']} by default; with the paper's "
            f"law runs averaged, {ROUNDS['paper']}."
        ),
    ] = None
    presses: Annotated[
        Count | None,
        about(
            f"With the paper's law, per round and velocity; {PRESSES} by default.", label="Presses per round"
        ),
    ] = None
    literal: Annotated[bool, about("The paper's law exactly as printed.")] = False

    def check(self) -> None:
        if self.method == "paper":
            self._refuse("rig-aware", rounds=self.rounds == 0)
        else:
            self._refuse("paper", presses=self.presses, literal=self.literal)

    @property
    def round_count(self) -> int:
        return ROUNDS.get(self.method, ROUNDS["rig-aware"]) if self.rounds is None else self.rounds

    @property
    def press_count(self) -> int:
        """Presses per round and velocity with the paper's law."""
        return PRESSES if self.presses is None else self.presses

    def check_known(self, **files: object) -> None:
        """Check what is known of the rig, by the names of the files. SettingError."""
        if self.method != "rig-aware":
            self._refuse("rig-aware", **files)

    def law(self, known: LearnedRig | None = None) -> PaperLaw | Method[Any]:
        """Return the method. known : what the rig has taught before, which only rig-aware uses.

        Raises BuildError if it comes with a package that is not installed.
        """
        if self.method == "rig-aware":
            from fdvv.compensation.rig_aware import RigAware

            return RigAware(self.round_count, known)
        if self.method == "paper":
            from fdvv.compensation.paper import PaperLaw

            make = PaperLaw.literal if self.literal else PaperLaw
            return make(rounds=self.round_count, presses_per_round=self.press_count)
        method: Method[Any] = extras.load("methods", self.method)(self)
        return method

    def _refuse(self, other: str, **values: object) -> None:
        for name, value in values.items():
            if value:
                remedy = f"choose the method {other}, or leave {name} out"
                raise SettingError(name, f"belongs to the method {other}", remedy)


class ProbeSettings(PressSettings):
    """How a rendering is judged on fresh presses."""

    presses: Annotated[Count, about("Per velocity.", label="Held-out presses")] = 10
    vibration_presses: Annotated[
        Annotated[int, Meta(ge=0, le=200)] | None,
        about("Per velocity with the model's vibrations, where there is an exciter; by default as many."),
    ] = None

    @property
    def vibrating(self) -> int:
        """How many presses per velocity play the vibrations."""
        return self.presses if self.vibration_presses is None else self.vibration_presses


class FeasibleSettings(PressSettings):
    """How the force that a rig can reach is compared with what it renders."""

    presses: Annotated[Count, about("Per velocity, to measure.")] = 5


class TuneSettings(PressSettings):
    """How the vibration of a press is tuned with a person."""

    asking: Annotated[
        Literal["compare", "rate"],
        about("Which of two is closer to the real button, or each by itself, 1 to 7."),
    ] = "compare"
    comparisons: Annotated[
        Annotated[int, Meta(ge=1, le=1000)] | None,
        about("Per velocity at most; 3 each by default.", label="Maximum questions"),
    ] = None
    repeats: Annotated[int, about("Of each rating.", label="Ratings of each", ge=2, le=20)] = 3
    frequency_ratios: Annotated[
        tuple[Annotated[float, Meta(ge=0.1, le=10)], ...],
        about(
            "Of the measured frequency; repeatable.", min_length=1, max_length=5, option="--frequency-ratio"
        ),
    ] = (1.0,)
    gain_ratios: Annotated[
        tuple[Annotated[float, Meta(ge=0.05, le=20)], ...],
        about("Of the measured strength; repeatable.", option="--gain-ratio", **A_FEW),
    ] = (1.0, 2.0)

    def grid(self) -> TemplateGrid:
        """Return the templates that are tried."""
        from fdvv.vibration.templates import TemplateGrid

        return TemplateGrid(self.frequency_ratios, self.gain_ratios)

    def question(self) -> Question:
        """Return how they are asked about."""
        from fdvv.vibration.tune import Rating
        from fdvv.vibration.tune_compare import Comparing

        if self.asking == "compare":
            return Comparing(self.comparisons, seed=self.seed)
        return Rating(self.repeats, self.seed)
