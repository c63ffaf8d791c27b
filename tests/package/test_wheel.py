"""What users install: the sdist, and the wheel that is built from it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from fdvv._native.structures import HEADERS
from tests.package.conftest import REPOSITORY, Builder, Packages, clean_environment, new_environment, unpacked
from tests.support.campaign import in_turn

pytestmark = pytest.mark.slow

NEEDED = (
    "_native/libfdvv.so",
    "_native/fdvv-host",
    *(f"_native/{name}" for name in HEADERS),
    "model/builtin/mx-clear.fdvv.json",
    "twin/rigs/voltage.toml",
    "twin/rigs/light.toml",
    "twin/rigs/paper.toml",
    "twin/fingers/paper.toml",
    "py.typed",
)
NEEDED_above = (
    "fdvv_people/study/words.toml",
    "fdvv_people/study/templates/realism.toml",
    "fdvv_people/study/templates/buttons/mx-red.fdvv.json",
    "fdvv_studio/studio/static/index.html",
)
LARGEST_wheel_bytes = 6_000_000
LARGEST_sdist_bytes = 20_000_000


def test_the_wheel_holds_the_package_and_nothing_beside_it(packages: Packages) -> None:
    names = zipfile.ZipFile(packages.wheel).namelist()
    assert [name for name in NEEDED if f"fdvv/{name}" not in names] == []
    above = {name for wheel in packages.others for name in zipfile.ZipFile(wheel).namelist()}
    assert above >= set(NEEDED_above)
    version = packages.wheel.name.split("-")[1]
    assert {name.split("/")[0] for name in names} == {"fdvv", f"fdvv-{version}.dist-info"}
    assert [name for name in names if name.endswith((".c", ".tmp", ".pyc"))] == []
    assert packages.wheel.stat().st_size < LARGEST_wheel_bytes


def test_every_other_wheel_holds_its_modules_and_templates(builder: Builder, tmp_path: Path) -> None:
    for sources in sorted([*REPOSITORY.glob("packages/fdvv-*/src"), *REPOSITORY.glob("extras/*/src")]):
        files = [path.relative_to(sources) for path in sources.rglob("*") if path.is_file()]
        wanted = {path.as_posix() for path in files if path.suffix != ".pyc"}
        wheel = zipfile.ZipFile(builder.build("wheel", sources.parent, tmp_path))
        assert wanted == {name for name in wheel.namelist() if ".dist-info/" not in name}


def test_the_sdist_holds_all_sources_and_nothing_that_was_built(packages: Packages) -> None:
    with tarfile.open(packages.sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    for part in (
        "README.md",
        "LICENSE",
        "tools/make_protocol.py",
        "firmware/core/core.c",
        "src/fdvv/_native/fdvv.h",
    ):
        assert part in names
    built = re.compile(r"\.(so|dylib|dll|pyc|tmp)$|fdvv-host$|^build/|node_modules/|\.venv")
    assert [name for name in names if built.search(name)] == []
    assert packages.sdist.stat().st_size < LARGEST_sdist_bytes


@pytest.mark.skipif(shutil.which("objdump") is None, reason="objdump is not installed")
def test_the_tag_of_the_wheel_is_the_glibc_that_its_symbols_need(packages: Packages, tmp_path: Path) -> None:
    zipfile.ZipFile(packages.wheel).extractall(tmp_path)
    native = tmp_path / "fdvv" / "_native"
    symbols = "".join(
        subprocess.run(
            ["objdump", "-T", str(native / name)], capture_output=True, text=True, check=True
        ).stdout
        for name in ("libfdvv.so", "fdvv-host")
    )
    needed = max((int(a), int(b)) for a, b in re.findall(r"GLIBC_(\d+)\.(\d+)", symbols))
    tag = re.fullmatch(r"fdvv-.*-py3-none-manylinux_(\d+)_(\d+)_\w+\.whl", packages.wheel.name)
    assert tag, packages.wheel.name
    assert (int(tag[1]), int(tag[2])) == needed


def run(folder: Path, *command: str | Path) -> str:
    """Run a command that says nothing of errors, away from the checkout; return what it prints."""
    ran = subprocess.run(
        command, cwd=folder, env=clean_environment(), capture_output=True, text=True, check=False
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    return ran.stdout


def try_wheels(folder: Path, *wheels: Path) -> tuple[Path, str]:
    """Try wheels in an environment of their own; return its Python and what the try prints."""
    python = new_environment(folder / "clean", *map(str, wheels))
    return python, run(folder, python, "-P", shutil.copy(REPOSITORY / "tools" / "try_wheel.py", folder))


def test_the_wheels_work_without_extras_and_without_the_repository(
    packages: Packages, tmp_path: Path
) -> None:
    python, said = try_wheels(tmp_path, packages.wheel, *packages.others)
    # the extras are really away, else nothing was proven of them
    parts = "fdvv[plot], fdvv[study], fdvv[optimize], fdvv[serial]"
    assert f"{parts}, fdvv-rig, fdvv-strip, fdvv-switch, fdvv-m0, fdvv-haptics, fdvv-drives" in said
    where = run(tmp_path, python, "-P", "-c", "import fdvv; print(fdvv.__file__)")
    assert Path(where.strip()).is_relative_to(tmp_path)
    host = next((tmp_path / "clean").rglob("fdvv-host"))
    assert os.access(host, os.X_OK)


def test_two_builds_in_two_folders_give_the_same_bytes(
    builder: Builder, packages: Packages, tmp_path: Path
) -> None:
    made = []
    for place in ("here", "somewhere-else"):
        sources = unpacked(packages.sdist, tmp_path / place)
        wheel = builder.build("wheel", sources, tmp_path / place, SOURCE_DATE_EPOCH="1700000000")
        made.append((wheel.name, wheel.read_bytes()))
    assert made[0] == made[1]


def test_without_a_compiler_a_build_asks_pip_for_one(
    builder: Builder, packages: Packages, tmp_path: Path
) -> None:
    code = "import hatchling.build as build; print(build.get_requires_for_build_wheel())"
    command = [str(builder.python), "-c", code]
    asked = [
        subprocess.run(
            command,
            cwd=packages.sources,
            env=clean_environment(**path),
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        for path in ({}, {"PATH": str(tmp_path)})
    ]
    assert asked == ["[]", "['ziglang']"]
    with pytest.raises(subprocess.CalledProcessError) as stop:
        builder.build("wheel", packages.sources, tmp_path, PATH=str(tmp_path))
    said = stop.value.stderr.strip().splitlines()
    assert len(said) == 2, said
    assert "no C compiler found" in said[0]
    assert "pip install ziglang" in said[0]


def test_without_a_compiler_pip_fetches_one_and_the_wheel_is_whole(
    packages: Packages, zig: list[str], tmp_path: Path
) -> None:
    # where zig-tools are, pip has been able to fetch it once
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q", "wheel", "--no-deps"]
    environment = clean_environment(PATH=str(tmp_path))
    subprocess.run([*pip, "-w", str(tmp_path), str(packages.sdist)], env=environment, check=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    assert [name for name in NEEDED if f"fdvv/{name}" not in names] == []


@in_turn(4)  # installs all that a newcomer gets, for minutes
@pytest.mark.timeout(1800)
def test_a_newcomer_gets_from_the_readme_to_a_button_a_studio_and_a_study(packages: Packages) -> None:
    script = REPOSITORY / "tools" / "newcomer.sh"
    # a newcomer's Python is not the one of this environment
    python = Path(sys.base_prefix) / "bin" / "python3"
    ran = subprocess.run(
        ["bash", str(script), str(packages.sdist)],
        env=clean_environment(PYTHON=str(python)),
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout + ran.stderr
    steps = re.findall(r"^ *[\d.]+ s  (.+?)  ", ran.stdout, flags=re.MULTILINE)
    for step in ("make demo", "fdvv studio", "fdvv study preview realism", "python"):
        assert step in steps


def test_the_core_works_alone_and_names_what_brings_the_rest(packages: Packages, tmp_path: Path) -> None:
    assert "fdvv-studio, fdvv-people, fdvv-campaigns" in try_wheels(tmp_path, packages.wheel)[1]
