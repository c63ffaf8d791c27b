"""The printed parts as code for a CAD kernel, and their files; needs the extra "cad"."""

from fdvv.hardware.cad._build import build
from fdvv.hardware.cad._export import export_parts

__all__ = ["build", "export_parts"]
