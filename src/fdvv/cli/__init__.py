"""The fdvv command: thin doors to the workflows."""

from fdvv.cli._main import cli, main

__all__ = ["cli", "main"]
