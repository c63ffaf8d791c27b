"""What a session is about: written before its first press, and what one that goes on is held against."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import platform
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import msgspec
import numpy as np

import fdvv
from fdvv.device import Device, Remote
from fdvv.documents import Kind, pretty, read_document
from fdvv.files import read_limited
from fdvv.model import FDVVModel, ForceSurface, model_to_json
from fdvv.workflow._tuning import TUNED

MANIFEST = "session.json"
KIND = Kind("fdvv-session", 1, "a session", "name the folder of a session, or one that is new or empty")
LARGEST_bytes = 4_000_000
MUST_AGREE = ("task", "model", "device", "method", "settings", "velocities_mm_s", "seed")


class ModelName(msgspec.Struct, forbid_unknown_fields=True):
    """A model and a digest of all that it says."""

    name: str
    sha256: str


class Manifest(msgspec.Struct, forbid_unknown_fields=True):
    """What a session is about.

    Attributes
    ----------
    device : limits, and what tells this rig from another: serial number, firmware and settings of a board,
        digests of the files of a simulated one.
    settings : of the method, or of the probe.
    seed : of a simulated device; None of a real one.
    """

    format: Literal["fdvv-session"]
    version: Literal[1]
    task: Literal["compensate", "probe", "tune"]
    model: ModelName
    device: dict[str, Any]
    method: str
    settings: dict[str, Any]
    velocities_mm_s: list[float]
    seed: int | None
    simulated: bool
    versions: dict[str, str]
    created: str


def make_manifest(
    task: Literal["compensate", "probe", "tune"],
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    method: tuple[str, Any],
    origin: tuple[int | None, dict[str, str]],
) -> Manifest:
    """Say what a session is about.

    method : its name and its settings, a dataclass or a mapping; origin : seed of a simulated device, and
    digests of what else it was made from.
    """
    info = device.info()
    name, settings = method
    seed, parts = origin
    return Manifest(
        "fdvv-session",
        1,
        task,
        ModelName(model.name, digest(model_to_json(model).encode())),
        {**identity(device), **parts},
        name,
        plain(settings),
        list(velocities_mm_s),
        seed if info.simulated else None,
        info.simulated,
        versions(),
        now(),
    )


def identity(device: Device) -> dict[str, Any]:
    """Tell what distinguishes a device from others; what a session itself configures does not."""
    found: dict[str, Any] = dataclasses.asdict(device.info())
    if isinstance(device, Remote):
        hello = device.client.hello
        found |= {"serial": hello.serial, "firmware": hello.firmware, "protocol": hello.hash}
        settings = dataclasses.asdict(device.settings())
        found["settings"] = {name: value for name, value in settings.items() if name not in TUNED}
    return found


def plain(settings: Any) -> dict[str, Any]:
    """Write settings as JSON would give them back."""
    known = dataclasses.is_dataclass(settings) and not isinstance(settings, type)
    named = dataclasses.asdict(settings) if known else settings
    found = json.loads(json.dumps(named, default=_plainer))
    assert isinstance(found, dict)
    return found


def _plainer(value: Any) -> Any:
    """Write what JSON does not know: an array as its numbers, anything else as its text."""
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else str(value)


def digest(data: bytes) -> str:
    """Give the SHA-256 of bytes."""
    return hashlib.sha256(data).hexdigest()


def table_digest(surface: ForceSurface) -> str:
    """Give the SHA-256 of a table's columns."""
    columns = (surface.displacement_mm, surface.velocity_mm_s, surface.press_cN, surface.release_cN)
    return digest(b"".join(np.ascontiguousarray(column, dtype="<f8").tobytes() for column in columns))


def versions() -> dict[str, str]:
    """Tell what this runs on."""
    return {"fdvv": fdvv.__version__, "python": platform.python_version(), "numpy": np.__version__}


def now() -> str:
    """Give the time, UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def read_manifest(path: Path) -> Manifest:
    """Read a manifest. InputError."""
    text = read_limited(path, LARGEST_bytes, KIND.remedy)
    return read_document(
        text, path, KIND, lambda data: msgspec.json.decode(data, type=Manifest), lambda _: None
    )


def manifest_text(manifest: Manifest) -> str:
    """Write a manifest."""
    return pretty(msgspec.to_builtins(manifest)) + "\n"


def differences(there: Manifest, now: Manifest) -> list[str]:
    """Tell in what a session differs from what is asked now, a phrase each; nothing if it is the same."""
    old, new = msgspec.to_builtins(there), msgspec.to_builtins(now)
    return [text for key in MUST_AGREE for text in _unequal(old[key], new[key], key)]


def _unequal(old: Any, new: Any, place: str) -> Iterator[str]:
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(set(old) | set(new)):
            yield from _unequal(old.get(key), new.get(key), f"{place}.{key}")
    elif old != new:
        yield f"{place} is {_short(old)} there and {_short(new)} now"


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:12] + "…"
