"""The clients that come with the server, and how they are copied into a project of another program."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import write_atomic

CLIENTS = {
    "javascript": ("fdvv.mjs", "target.html"),
    "unity": ("FdvvClient.cs", "FdvvTarget.cs"),
}
"""By language: the client, and its example."""


def copy_client(language: str, folder: Path) -> tuple[Path, ...]:
    """Copy a client and its example; return the files. InputError where one is there already. OSError."""
    paths = tuple(folder / name for name in CLIENTS[language])
    for path in paths:
        if path.exists():
            raise InputError(
                "--client", str(path), "is there already", "move it away, or name another folder"
            )
    folder.mkdir(parents=True, exist_ok=True)
    for path in paths:
        text = resources.files(__name__).joinpath(path.name).read_text(encoding="utf-8")
        write_atomic(path, text)
    return paths
