"""Streams as benches record them: their types, their files, readers of foreign logs."""

from fdvv.recording._types import UNITS, Bench, Mark, Quantity, Recording, Source, Stage, Stream, Take

__all__ = ["UNITS", "Bench", "Mark", "Quantity", "Recording", "Source", "Stage", "Stream", "Take"]
