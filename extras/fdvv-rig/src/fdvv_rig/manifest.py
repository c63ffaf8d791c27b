"""The manifest of exported parts: what they were made from, what they measure, their files' fingerprints."""

from __future__ import annotations

import hashlib
from pathlib import Path

import msgspec

from fdvv.errors import InputError
from fdvv.io.documents import Kind, read_document
from fdvv.io.files import read_limited
from fdvv_rig.dimensions import NAMES, Dimensions

FORMAT = "fdvv-hardware"
VERSION = 1
NAME = "manifest.json"
LARGEST_BYTES = 2_000_000
REMEDY = "export the parts again with fdvv hardware export"
KIND = Kind(FORMAT, VERSION, "a manifest of exported parts", REMEDY)


class MadePart(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An exported part: what the CAD kernel measured of its solid, and its files.

    files : SHA-256 of each file, by its name.
    """

    volume_cm3: float
    area_cm2: float
    box_mm: tuple[float, float, float]
    files: dict[str, str]


class Manifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a folder of exported parts holds."""

    format: str = FORMAT
    version: int = VERSION
    digest: str
    dimensions: dict[str, float]
    parts: dict[str, MadePart]

    def made_from(self) -> Dimensions:
        """Return the dimensions that the parts were made from. Raises InputError for unknown ones."""
        if other := sorted(set(self.dimensions) ^ set(NAMES)):
            raise InputError(
                NAME, "$.dimensions", f"{other[0]} is not in both manifest and this fdvv", REMEDY
            )
        return Dimensions(**self.dimensions)


def manifest_bytes(manifest: Manifest) -> bytes:
    """Write a manifest as JSON."""
    return msgspec.json.format(msgspec.json.encode(manifest), indent=1) + b"\n"


def read_manifest(folder: Path | str) -> Manifest:
    """Read the manifest of a folder of exported parts. Raises InputError."""
    path = Path(folder) / NAME
    if not path.is_file():
        remedy = "name a folder that fdvv hardware export wrote, or the source's hardware/"
        raise InputError(folder, "whole folder", f"holds no {NAME} of exported parts", remedy)
    data = read_limited(path, LARGEST_BYTES, REMEDY)
    return read_document(
        data, path, KIND, lambda raw: msgspec.json.decode(raw, type=Manifest), lambda _place: None
    )


def fingerprint(data: bytes) -> str:
    """Return the SHA-256 of a file's bytes."""
    return hashlib.sha256(data).hexdigest()
