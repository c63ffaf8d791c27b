"""Figures and reports from records; needs the optional extra ``plot`` (matplotlib) for figures."""

from fdvv.plot._capture_curves import plot_averages, plot_paces, plot_registration
from fdvv.plot._capture_figures import plot_clocks, plot_displacement, plot_force, plot_take
from fdvv.plot._feasibility_figures import plot_feasibility
from fdvv.plot._fit_figures import plot_fit, plot_scan
from fdvv.plot._model_figures import plot_comparison, plot_model, plot_surface, plot_vibration
from fdvv.plot._records import ErrorHistory, FeasibleCurve, RenderedBand, RenderedCurve
from fdvv.plot._rendering_figures import PAPER_ERROR_cN, plot_convergence, plot_rendering
from fdvv.plot._report import Section, Table, render_html, write_report
from fdvv.plot._style import house_style
from fdvv.plot._svg import figure_of, figure_png, figure_svg
from fdvv.plot._vibration_figures import plot_heard

__all__ = [
    "ErrorHistory",
    "FeasibleCurve",
    "PAPER_ERROR_cN",
    "RenderedBand",
    "RenderedCurve",
    "Section",
    "Table",
    "figure_of",
    "figure_png",
    "figure_svg",
    "house_style",
    "plot_averages",
    "plot_clocks",
    "plot_comparison",
    "plot_convergence",
    "plot_displacement",
    "plot_feasibility",
    "plot_fit",
    "plot_force",
    "plot_heard",
    "plot_model",
    "plot_paces",
    "plot_registration",
    "plot_rendering",
    "plot_scan",
    "plot_surface",
    "plot_take",
    "plot_vibration",
    "render_html",
    "write_report",
]
