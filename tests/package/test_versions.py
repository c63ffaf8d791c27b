"""One version, and a changelog that knows it."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import pytest

from fdvv._version import __version__
from tests.package.conftest import REPOSITORY

CORE = REPOSITORY / "packages" / "fdvv"
CHANGELOG = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
HEADS = re.findall(r"^## \[(.+?)\](?: - (\S+))?$", CHANGELOG, flags=re.MULTILINE)


@pytest.fixture
def project() -> dict[str, Any]:
    return tomllib.loads((CORE / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_version_stands_in_one_place_and_the_citation_follows_it(project: dict[str, Any]) -> None:
    assert project["project"]["dynamic"] == ["version"]
    assert (CORE / project["tool"]["hatch"]["version"]["path"]).read_text().count(__version__) == 1
    citation = (REPOSITORY / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.+)$", citation, flags=re.MULTILINE) == [__version__]


def test_the_other_packages_have_the_version_of_the_core() -> None:
    packages = [
        *REPOSITORY.glob("packages/fdvv-*/src/*/__init__.py"),
        *REPOSITORY.glob("extras/*/src/*/__init__.py"),
    ]
    assert len(packages) == 3 + 7
    for module in packages:
        assert f'__version__ = "{__version__}"' in module.read_text(encoding="utf-8"), module


def test_the_changelog_has_a_section_of_this_version_and_dates_of_older_ones() -> None:
    versions = [version for version, _ in HEADS]
    assert versions[0] == "Unreleased" or versions[0] == __version__
    assert __version__ in versions
    for version, date in HEADS:
        assert version == "Unreleased" or re.fullmatch(r"\d+\.\d+\.\d+", version)
        assert version in ("Unreleased", __version__) or re.fullmatch(r"\d{4}-\d\d-\d\d", date)
    numbers = [tuple(map(int, version.split("."))) for version in versions if version != "Unreleased"]
    assert numbers == sorted(numbers, reverse=True)
