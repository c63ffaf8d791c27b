"""Figures and reports from records; needs the optional extra ``plot`` (matplotlib) for figures."""

from fdvv.plot._answer_figures import (
    ChoiceRow,
    ForestRow,
    RatingBars,
    plot_choices,
    plot_forest,
    plot_rating_bars,
)
from fdvv.plot._capture_curves import plot_averages, plot_paces, plot_registration
from fdvv.plot._capture_figures import plot_clocks, plot_displacement, plot_force, plot_take
from fdvv.plot._design_figures import DesignPanel, plot_designs
from fdvv.plot._feasibility_figures import plot_feasibility
from fdvv.plot._fit_figures import plot_fit, plot_scan
from fdvv.plot._mechanism_figures import (
    DesignedStroke,
    DrawnLine,
    DrawnPart,
    plot_mechanism,
    plot_parts,
)
from fdvv.plot._model_figures import plot_comparison, plot_model, plot_surface, plot_vibration
from fdvv.plot._records import ErrorHistory, FeasibleCurve, RenderedBand, RenderedCurve
from fdvv.plot._rendering_figures import PAPER_ERROR_cN, plot_convergence, plot_rendering
from fdvv.plot._report import Section, Table, render_html, write_report
from fdvv.plot._specification_figure import SpecificationCurve, plot_specifications
from fdvv.plot._staircase_figure import StaircaseTrack, plot_tracks
from fdvv.plot._study_figures import ScoreBars, TrainingScores, plot_score_bars, plot_training
from fdvv.plot._style import house_style
from fdvv.plot._svg import figure_of, figure_png, figure_svg
from fdvv.plot._vibration_figures import plot_heard

__all__ = [
    "ChoiceRow",
    "DesignPanel",
    "DesignedStroke",
    "DrawnLine",
    "DrawnPart",
    "ErrorHistory",
    "FeasibleCurve",
    "ForestRow",
    "PAPER_ERROR_cN",
    "RatingBars",
    "RenderedBand",
    "RenderedCurve",
    "ScoreBars",
    "Section",
    "SpecificationCurve",
    "StaircaseTrack",
    "Table",
    "TrainingScores",
    "figure_of",
    "figure_png",
    "figure_svg",
    "house_style",
    "plot_averages",
    "plot_choices",
    "plot_clocks",
    "plot_comparison",
    "plot_convergence",
    "plot_designs",
    "plot_displacement",
    "plot_feasibility",
    "plot_fit",
    "plot_force",
    "plot_forest",
    "plot_heard",
    "plot_mechanism",
    "plot_model",
    "plot_paces",
    "plot_parts",
    "plot_rating_bars",
    "plot_registration",
    "plot_rendering",
    "plot_scan",
    "plot_score_bars",
    "plot_specifications",
    "plot_surface",
    "plot_take",
    "plot_tracks",
    "plot_training",
    "plot_vibration",
    "render_html",
    "write_report",
]
