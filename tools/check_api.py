"""Compare the public face with an earlier version: ``python -m tools.check_api [REF]``, else the newest tag.

A name of ``fdvv.__all__`` that was removed or changed incompatibly must be named in the changelog under
*Unreleased*; otherwise this prints what broke and exits with 1.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import griffe

ROOT = Path(__file__).resolve().parents[1]


def newest_tag() -> str | None:
    """Return the newest tag of this repository, None before the first."""
    command = ["git", "-C", str(ROOT), "describe", "--tags", "--abbrev=0"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    return found.stdout.strip() or None


def targets(package: griffe.Module) -> dict[str, str]:
    """Return the path of what each public name stands for."""
    exports = [str(name) for name in package.exports or ()]
    return {name: package[name].final_target.path for name in exports if package[name].is_alias}


def broken(old: griffe.Module, new: griffe.Module) -> Iterator[tuple[str, str]]:
    """Yield (public name, what broke) for every promise of old that new does not keep."""
    before, now = targets(old), targets(new)
    yield from ((name, "was removed") for name in before.keys() - now.keys())
    names = {path: name for name, path in before.items() if name in now}
    for breakage in griffe.find_breaking_changes(old, new):
        path = breakage.obj.path
        for promised, name in names.items():
            if path == promised or path.startswith(f"{promised}."):
                yield name, f"{path.rpartition('.')[2]}: {breakage.kind.value.lower()}"


def unannounced(changes: Iterator[tuple[str, str]], changelog: str) -> list[str]:
    """Return the changes whose name the changelog's unreleased section does not mention."""
    section = re.split(r"^## ", changelog, flags=re.MULTILINE)[1]
    return sorted({f"{name}: {what}" for name, what in changes if not re.search(rf"\b{name}\b", section)})


def main() -> int:
    ref = sys.argv[1] if len(sys.argv) > 1 else newest_tag()
    if ref is None:
        print("no tag yet: nothing was promised")
        return 0
    old = griffe.load_git(
        "fdvv", ref=ref, repo=ROOT, search_paths=["packages/fdvv/src", "src"], resolve_aliases=True
    )
    new = griffe.load("fdvv", search_paths=[ROOT / "packages" / "fdvv" / "src"], resolve_aliases=True)
    assert isinstance(old, griffe.Module)
    assert isinstance(new, griffe.Module)
    found = unannounced(broken(old, new), (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    print("\n".join(found) or f"the public face keeps what {ref} promised")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
