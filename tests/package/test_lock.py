"""Every package that the development environment installs is pinned, and pinned by its hash."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.package.conftest import REPOSITORY

LOCK = (REPOSITORY / "requirements.lock").read_text(encoding="utf-8")
CONSTRAINTS = (REPOSITORY / "constraints.txt").read_text(encoding="utf-8")
HEAVY = ("torch", "botorch", "gpytorch")
"""What setup.sh leaves out."""


def pins(text: str) -> set[tuple[str, str]]:
    found = re.findall(r"^([A-Za-z0-9._-]+)==([^ \\;\n]+)", text, flags=re.MULTILINE)
    return {(str(canonicalize_name(name)), version) for name, version in found}


def wanted() -> Iterator[Requirement]:
    """Yield what the packages and the tools of this repository ask for, and what builds them."""
    for path in sorted(
        [*REPOSITORY.glob("packages/*/pyproject.toml"), *REPOSITORY.glob("extras/*/pyproject.toml")]
    ):
        if path.parent.name != "fdvv-botorch":
            document = tomllib.loads(path.read_text(encoding="utf-8"))
            yield from map(Requirement, document["build-system"]["requires"])
            yield from map(Requirement, document["project"].get("dependencies", []))
            if path.is_relative_to(REPOSITORY / "packages"):
                for optional in document["project"].get("optional-dependencies", {}).values():
                    yield from map(Requirement, optional)
    document = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    groups = [*document["dependency-groups"]["docs"], *document["dependency-groups"]["dev"]]
    yield from (Requirement(entry) for entry in groups if isinstance(entry, str))


def test_the_lock_has_the_pins_of_the_constraints_and_no_others() -> None:
    assert pins(LOCK) == pins(CONSTRAINTS), "run make lock"


def test_every_pin_has_a_hash_and_none_an_address() -> None:
    entries = re.split(r"^(?=\S)", LOCK, flags=re.MULTILINE)[1:]
    assert len(entries) > 100
    for entry in entries:
        assert re.search(r"^    --hash=sha256:[0-9a-f]{64}", entry, flags=re.MULTILINE), entry
        assert "==" in entry.splitlines()[0], entry
    assert "://" not in LOCK
    assert "index-url" not in LOCK


def test_what_the_packages_ask_for_is_locked_in_a_version_that_they_take() -> None:
    locked: dict[str, list[str]] = {}
    for name, version in pins(LOCK):
        locked.setdefault(name, []).append(version)
    for asked in wanted():
        name = str(canonicalize_name(asked.name))
        if not name.startswith("fdvv") and name not in HEAVY:
            versions = locked.get(name, [])
            assert any(asked.specifier.contains(version) for version in versions), str(asked)


def test_setup_installs_nothing_without_its_hash() -> None:
    script = Path(REPOSITORY / "tools" / "setup.sh").read_text(encoding="utf-8")
    installs = [line for line in script.splitlines() if re.search(r'^ *(if )?"\$\{pip\[@\]\}"', line)]
    assert installs
    for line in installs:
        assert "--require-hashes" in line or "--no-deps --no-build-isolation" in line, line
