"""hatch_build.py: compilers, names and tags on every system."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from types import ModuleType

import pytest

from tests.package.conftest import REPOSITORY, module_of
from tests.test_native import ON_LIBRARY

TARGETS = {
    "x86_64-windows-gnu": ("win32", b"MZ"),
    "aarch64-windows-gnu": ("win32", b"MZ"),
    "x86_64-macos.11.0": ("darwin", bytes.fromhex("cffaedfe07000001")),
    "aarch64-macos.11.0": ("darwin", bytes.fromhex("cffaedfe0c000001")),
    "x86_64-linux-gnu.2.17": ("linux", b"\x7fELF"),
    "aarch64-linux-gnu.2.17": ("linux", b"\x7fELF"),
    "x86_64-linux-musl": ("linux", b"\x7fELF"),
}
"""Beside each its system and the first bytes of its libraries."""
EXERCISE = (
    ON_LIBRARY
    + """
import hashlib
found = hashlib.sha256()
for count in (40, 400):
    curve = MeasuredCurve(np.cumsum(rng.uniform(1e-6, 0.02, count)), rng.normal(50, 30, count), Stroke.PRESS)
    found.update(fit_curve(curve).curve.control_points_cN.tobytes())
button, device = load_builtin("mx-clear"), TwinDevice(seed=1)
device.upload(ForceSurface.of_model(button, [50.0, 200.0]), button.travel_mm)
for velocity in (5.0, 100.0, 500.0):
    press = device.press(velocity)
    found.update(press.force_cN.tobytes() + press.displacement_mm.tobytes())
print(found.hexdigest())
"""
)


@pytest.fixture
def build() -> ModuleType:
    return module_of(REPOSITORY / "packages" / "fdvv" / "hatch_build.py")


def nothing_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)


@pytest.mark.parametrize(
    ("system", "remedy"), [("linux", "gcc"), ("darwin", "xcode-select"), ("win32", "MinGW")]
)
def test_without_any_compiler_two_lines_tell_what_to_do(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, system: str, remedy: str
) -> None:
    nothing_installed(monkeypatch)
    with pytest.raises(SystemExit) as stop:
        build.compile_native(tmp_path, system)
    said = str(stop.value).splitlines()
    assert len(said) == 2
    assert remedy in said[0]
    assert "pip install ziglang" in said[0]
    assert list(tmp_path.iterdir()) == []


def test_cc_is_taken_first_then_the_systems_compiler_then_pips(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    nothing_installed(monkeypatch)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: name)
    linux = build.system_of("linux")
    assert build.compiler(linux) == [sys.executable, "-m", "ziglang", "cc", "-mcpu=baseline"]
    monkeypatch.setattr(shutil, "which", {"gcc": "/bin/gcc", "clang": "/bin/clang"}.get)
    assert build.compiler(linux) == ["/bin/gcc"]
    monkeypatch.setenv("CC", "ccache 'my gcc' -m64")
    assert build.compiler(linux) == ["ccache", "my gcc", "-m64"]


def test_a_compiler_that_fails_leaves_the_old_library_and_says_so_in_one_line(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "libfdvv.so").write_bytes(b"old")
    for broken in ("false", "no-such-compiler"):
        monkeypatch.setenv("CC", broken)
        with pytest.raises(SystemExit, match=r"^fdvv: libfdvv\.so cannot be built: [^\n]*$"):
            build.compile_native(tmp_path, "linux")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"old"]


@pytest.mark.parametrize(
    ("flags", "target", "tag"),
    [
        ("-arch arm64", None, "macosx_11_0_arm64"),
        ("-arch arm64 -arch x86_64", None, "macosx_11_0_universal2"),
        ("-arch x86_64", "10.13", "macosx_10_13_x86_64"),
    ],
)
def test_a_wheel_of_macos_is_tagged_for_what_was_compiled(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, flags: str, target: str | None, tag: str
) -> None:
    monkeypatch.setenv("ARCHFLAGS", flags)
    monkeypatch.delenv("MACOSX_DEPLOYMENT_TARGET", raising=False)
    if target:
        monkeypatch.setenv("MACOSX_DEPLOYMENT_TARGET", target)
    assert build.platform_tag([], "darwin") == tag
    assert build._architectures("darwin")[:2] == flags.split()[:2]


@pytest.mark.parametrize(
    ("platform", "text", "tag"),
    [
        ("linux-x86_64", b"\0GLIBC_2.2.5\0GLIBC_2.29\0GLIBC_2.4\0", "manylinux_2_29_x86_64"),
        ("linux-aarch64", b"\0GLIBC_2.17\0", "manylinux_2_17_aarch64"),
        ("linux-x86_64", b"musl", "linux_x86_64"),
        ("win-amd64", b"MZ", "win_amd64"),
    ],
)
def test_a_wheel_is_tagged_for_the_newest_symbol_it_needs(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, platform: str, text: bytes, tag: str
) -> None:
    (tmp_path / "library").write_bytes(text)
    monkeypatch.setattr(sysconfig, "get_platform", lambda: platform)
    assert build.platform_tag([tmp_path / "library"], "linux") == tag


def test_python_looks_for_the_library_that_is_built(build: ModuleType) -> None:
    from fdvv import _native

    assert build.system_of().library == _native.LIBRARY
    source = Path(_native.__file__).read_text(encoding="utf-8")
    assert [system.library for system in build.SYSTEMS.values() if f'"{system.library}"' not in source] == []


@pytest.mark.slow
@pytest.mark.parametrize("target", TARGETS)
def test_the_c_compiles_without_a_warning_for_every_system(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, zig: list[str], target: str
) -> None:
    system, first = TARGETS[target]
    # the target names the other system's version
    monkeypatch.setattr(build, "_architectures", lambda _: [])
    monkeypatch.setattr(build, "STRICT", ["-Werror"])
    monkeypatch.setenv("CC", " ".join([*zig, "-target", target, "-mcpu=baseline"]))
    library, *_ = build.compile_native(tmp_path, system)
    content = library.read_bytes()
    assert content.startswith(first)
    for name in (b"fdvv_spline_free_knots", b"fdvv_rig_step", b"fdvv_host_tick"):
        assert name in content
    # nothing of where it was built
    assert str(tmp_path).encode() not in content
    assert str(REPOSITORY).encode() not in content


@pytest.mark.slow
def test_fits_and_presses_of_pips_compiler_are_those_of_the_systems(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, zig: list[str]
) -> None:
    from fdvv import _native

    monkeypatch.setenv("CC", " ".join([*zig, "-mcpu=baseline"]))
    library, _ = build.compile_native(tmp_path, "linux")
    ours = Path(_native.__file__).with_name(_native.LIBRARY)
    printed = {
        subprocess.run(
            [sys.executable, "-c", EXERCISE, str(path)], capture_output=True, text=True, check=True
        ).stdout
        for path in (library, ours)
    }
    assert len(printed) == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("target", "emulator"),
    [
        ("x86_64-linux-musl", ""),
        ("aarch64-linux-musl", "qemu-aarch64-static"),
        ("x86_64-windows-gnu", "wine64"),
    ],
)
def test_fits_and_ticks_are_the_same_to_the_bit_on_other_systems(
    build: ModuleType, tmp_path: Path, zig: list[str], target: str, emulator: str
) -> None:
    runner = [shutil.which(emulator) or f"/usr/lib/wine/{emulator}"] if emulator else []
    if runner and not Path(runner[0]).exists():
        pytest.skip(f"{emulator} is not installed")
    sources = [Path(__file__).with_name("portable.c"), *sorted(build.NATIVE.glob("*.c"))]
    sources += [*sorted(build.CORE.glob("*.c")), build.HOST / "board.c"]
    printed = []
    for compiler, prefix in ((["cc"], []), ([*zig, "-target", target, "-mcpu=baseline"], runner)):
        program = tmp_path / f"{len(prefix)}-{len(compiler)}.exe"
        command = [*compiler, *build.FLAGS, "-o", str(program), *map(str, sources), "-lm"]
        subprocess.run(command, check=True)
        environment = {"WINEPREFIX": str(tmp_path / "wine"), "WINEDEBUG": "-all", "PATH": "/usr/bin:/bin"}
        ran = subprocess.run(
            [*prefix, str(program)], env=environment, capture_output=True, text=True, check=True
        )
        printed.append(ran.stdout.split())
    assert printed[0] == printed[1]
    assert len(printed[0]) == 4
