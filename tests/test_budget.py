"""The brake: what grows fails by name, what shrinks gives back, and only a commit of its own may raise."""

from __future__ import annotations

import shutil
import subprocess
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest
from tools import check_budget
from tools.budget_file import Row, parse_limits, write_limits
from tools.budget_house import begins_with_participle
from tools.budget_measures import list_files, to_pattern

CHECKOUT = Path(__file__).resolve().parents[1]

BUDGET = """# a comment
sources = ["src"]

[parts]
ground = { paths = ["src/fdvv/*.py"], lines = 0, files = 0 }
study = { paths = ["src/fdvv/study/**/*.py"], lines = 0, files = 0 }
task = { paths = ["src/fdvv/task/**/*.py"], lines = 0, files = 0 }
tests = { paths = ["tests/**/*.py"], lines = 0, files = 0 }
C = { paths = ["**/*.c", "**/*.h"], lines = 0, files = 0 }
page = { paths = ["web/src/**/*.ts", "web/src/**/*.svelte", "web/src/**/*.css"], lines = 0, files = 0 }
Markdown = { paths = ["**/*.md"], lines = 0, files = 0 }

[generated]
"tools/make.sh" = ["firmware/made.h"]

[loaded]
"--help" = 0

[cpu]
"--help" = 90

[counts]
[force_text]
[arrows]
[records]
[protocols]
"""
TREE = {
    ".gitignore": "build/\n*.tmp\nsrc/fdvv/made.py\n",
    "src/fdvv/__init__.py": '__all__ = ["run"]\n',
    "src/fdvv/__main__.py": "import fdvv.study.plan\n",
    "src/fdvv/force_text.py": "def text(force_cN: float) -> str:\n    return str(force_cN)\n",
    "src/fdvv/study/__init__.py": "",
    "src/fdvv/study/plan.py": "import fdvv.task.task\n" + "LENGTH = 1\n" * 49,
    "src/fdvv/task/__init__.py": "",
    "src/fdvv/task/task.py": "class Plan:\n    a: int\n    b: int\n    c: int\n    d: int\n" + "\n" * 95,
    "tests/test_plan.py": "def test() -> None: ...\n",
    "firmware/tick.c": "int tick;\n",
    "firmware/made.h": "int made;\n",
    "web/src/page.ts": "export {};\n",
    "README.md": "# Buttons\n",
}


def write(root: Path, files: Mapping[str, str]) -> None:
    """Write files, or append to them where a text begins with `+`."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        before = path.read_text(encoding="utf-8") if text.startswith("+") and path.exists() else ""
        path.write_text(before + text.removeprefix("+"), encoding="utf-8")


def replace(root: Path, old: str, new: str) -> None:
    """Change the budget."""
    path = root / "budget.toml"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def git(root: Path, *arguments: str) -> str:
    identity = ("-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
    done = subprocess.run(
        ["git", *identity, *arguments], cwd=root, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def commit(root: Path, *names: str) -> str:
    """Commit these files, or all; return the commit's short hash."""
    git(root, "add", *(names or ["."]))
    git(root, "commit", "--quiet", "--message", "area: what")
    return git(root, "rev-parse", "--short", "HEAD")


def check(root: Path, capsys: pytest.CaptureFixture[str], *options: str) -> tuple[int, list[str]]:
    """Run the check; return its exit status and its lines."""
    status = check_budget.main(options, root)
    return status, capsys.readouterr().out.splitlines()


@pytest.fixture(autouse=True)
def outside_ci(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small house with a budget of its figures, in a repository of one commit where there is git."""
    root = tmp_path_factory.mktemp("template") / "house"
    write(root, {**TREE, "budget.toml": BUDGET})
    assert check_budget.check(root, raise_too=True) == []
    if shutil.which("git"):
        git(root, "init", "--quiet", "--initial-branch", "main")
        commit(root)
    return root


@pytest.fixture
def house(template: Path, tmp_path: Path) -> Path:
    """The house, without git."""
    return shutil.copytree(template, tmp_path / "house", ignore=shutil.ignore_patterns(".git"))


@pytest.fixture
def repository(template: Path, tmp_path: Path) -> Path:
    """The house in its repository."""
    if shutil.which("git") is None:
        pytest.skip("needs git")
    return shutil.copytree(template, tmp_path / "house")


def test_a_house_as_large_as_its_budget_passes(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (repository / "budget.toml").read_text()
    assert check(repository, capsys) == (0, [])
    assert (repository / "budget.toml").read_text() == before
    assert before.startswith("# a comment\n")


PLAN = "src/fdvv/study/plan.py"
GROWTH = {
    "lines": (
        PLAN,
        "+# more\n",
        "study: 51 of 50 lines; make room in study, or raise the budget in a commit that names what came in "
        "and what went out",
    ),
    "files": ("src/fdvv/study/more.py", "", "study: 3 of 2 files; make room in study, or raise the budget"),
    "tests": ("tests/deep/test_more.py", "\n", "tests: 2 of 1 lines; make room in tests"),
    "C": ("firmware/tick.c", "+int tock;\n", "C: 2 of 1 lines; make room in C"),
    "page": ("web/src/ui/more.svelte", "<p>\n", "page: 2 of 1 lines; make room in page"),
    "Markdown": ("docs/more.md", "\n", "Markdown: 2 of 1 lines; make room in Markdown"),
    "loaded": (
        "src/fdvv/__main__.py",
        "+import fdvv.force_text\n",
        "fdvv --help: 6 of 5 modules of ours loaded; import where it is used",
    ),
    "public names": (
        "src/fdvv/__init__.py",
        '__all__ = ["run", "stop"]\n',
        "public names of fdvv: 2 of 1; a name is public for good",
    ),
    "force_text": (
        PLAN,
        "+from fdvv.force_text import text\n",
        "study: 1 of 0 modules that import force_text; return the number",
    ),
    "arrows": (
        "src/fdvv/task/task.py",
        "def go() -> None:\n    from fdvv.study import plan\n",
        "task -> study: a new arrow between packages; move the shared record down, or pass a callable",
    ),
    "records": (
        PLAN,
        "class File:\n    a: int\n    b: int\n    c: int\n    d: int\n    e: int\n",
        "study.plan.File -> task.task.Plan: two records share most fields; use one of them",
    ),
    "protocols": (
        PLAN,
        "from typing import Protocol\n\n\nclass Route(Protocol):\n    def go(self) -> None: ...\n\n\n"
        "class Only:\n    def go(self) -> None: ...\n",
        "study.plan -> Route: a protocol with fewer than two implementers; name the class itself",
    ),
    "importers": (
        PLAN,
        "+from fdvv import force_text\n",
        "modules with one importer: 3 of 2; fold a module into its only importer",
    ),
    "participles": (
        PLAN,
        "def _judged() -> None: ...\n",
        "functions named by a past participle: 1 of 0; name it by a verb, or by the noun it returns",
    ),
    "found": (PLAN, "foundAt = 1\n", "identifiers with 'found': 1 of 0; name the thing by what it holds"),
    "one": (PLAN, "def add(one_cN: float) -> None: ...\n", "identifiers with 'one': 1 of 0; name the thing"),
}
"""By kind: a file, its new text (with + what is appended), and how the line begins that says what to do."""


@pytest.mark.parametrize("kind", GROWTH)
def test_growth_of_each_kind_fails_with_what_to_do(
    kind: str, house: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, text, message = GROWTH[kind]
    before = (house / "budget.toml").read_text()
    write(house, {name: text})
    status, lines = check(house, capsys)
    assert status == 1
    assert any(line.startswith(message) for line in lines), lines
    assert (house / "budget.toml").read_text() == before


def test_a_command_that_takes_more_cpu_fails_where_it_is_measured(
    house: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    work = "import fdvv.study.plan; sum(range(10**7))\n"
    write(house, {"src/fdvv/__main__.py": work})
    assert check(house, capsys)[0] == 0
    status, lines = check(house, capsys, "--cpu")
    assert status == 1
    assert [line.partition(";")[0].partition(" of ")[2] for line in lines[1:]] == [
        "90 % of the CPU time of importing numpy"
    ]


@pytest.mark.clock
def test_our_commands_take_no_more_cpu_than_their_budget(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CI", "true")
    _, lines = check(CHECKOUT, capsys, "--cpu")
    assert [line for line in lines if "CPU" in line] == []


def test_a_file_in_no_part_or_in_two_fails_and_nothing_is_lowered(
    house: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (house / "src/fdvv/study").rename(house / "src/fdvv/survey")
    write(house, {"src/fdvv/__main__.py": "import fdvv.survey.plan\n"})
    replace(house, '"web/src/**/*.css"', '"README.md"')
    before = (house / "budget.toml").read_text()
    status, lines = check(house, capsys)
    assert status == 1
    homeless = "src/fdvv/survey/plan.py: in no row of [parts]; move it into a part, or add a row"
    assert any(line.startswith(homeless) for line in lines)
    assert "README.md: counted by page and Markdown; let the paths of one of them leave it out" in lines
    assert (house / "budget.toml").read_text() == before
    assert check(house, capsys, "--raise")[0] == 1


def test_what_shrinks_by_two_percent_lowers_its_limit(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(repository, {PLAN: "import fdvv.task.task\n" + "LENGTH = 1\n" * 48})
    line = "budget.toml: lines of study: 50 becomes 49; commit it with what shrank"
    assert check(repository, capsys) == (0, [line])
    assert (
        'paths = ["src/fdvv/study/**/*.py"], lines = 49, files = 2'
        in (repository / "budget.toml").read_text()
    )
    assert check(repository, capsys) == (0, [])


def test_what_shrinks_by_less_keeps_its_limit(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(repository, {"src/fdvv/task/task.py": TREE["src/fdvv/task/task.py"][:-1]})
    before = (repository / "budget.toml").read_text()
    assert check(repository, capsys) == (0, [])
    assert (repository / "budget.toml").read_text() == before


def test_a_row_with_nothing_left_goes(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (house / "web/src/page.ts").unlink()
    write(house, {PLAN: "LENGTH = 1\n" * 50})
    assert check(house, capsys)[0] == 0
    document = tomllib.loads((house / "budget.toml").read_text())
    assert "page" not in document["parts"]
    assert document["arrows"] == {"__main__": ["study"]}


def test_an_arrow_that_is_gone_leaves_the_others_of_its_row() -> None:
    arrows = {Row("arrows", "study", name): limit for name, limit in (("io", 0), ("task", 1))}
    text = write_limits('[arrows]\nstudy = ["io", "task"]\n', arrows)
    assert text == '[arrows]\nstudy = ["task"]\n'


def test_in_ci_a_lower_limit_is_only_named(
    repository: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CI", "true")
    write(repository, {PLAN: "import fdvv.task.task\n"})
    before = (repository / "budget.toml").read_text()
    line = "budget.toml: lines of study: 50 becomes 1; run make check and commit it"
    assert check(repository, capsys) == (0, [line])
    assert (repository / "budget.toml").read_text() == before


def test_growth_without_a_raised_budget_is_raised_by_a_commit_of_its_own(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(repository, {PLAN: "+# more\n"})
    assert check(repository, capsys, "--raise")[0] == 0
    status, lines = check(repository, capsys)
    assert status == 1
    assert lines == [
        "budget.toml: lines of study raised from 50 to 51 beside other files in the working tree; raise "
        "it in a commit of budget.toml alone that names what came in and what went out"
    ]
    commit(repository, "budget.toml")
    assert check(repository, capsys) == (0, [])
    commit(repository)
    assert check(repository, capsys) == (0, [])


def test_a_raise_beside_other_files_is_refused_until_it_is_put_back_and_raised_alone(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(repository, {PLAN: "+# more\n"})
    replace(repository, "lines = 50", "lines = 51")
    bad = commit(repository)
    write(repository, {"README.md": "# Push-buttons\n"})
    commit(repository)
    status, lines = check(repository, capsys)
    assert status == 1
    fault = f"budget.toml: lines of study raised from 50 to 51 beside other files in {bad}"
    assert [line.partition(", then raise")[0] for line in lines] == [f"{fault}; put it back"]
    replace(repository, "lines = 51", "lines = 50")
    commit(repository)
    assert check(repository, capsys)[1][0].startswith("study: 51 of 50 lines")
    replace(repository, "lines = 50", "lines = 51")
    assert check(repository, capsys) == (0, [])
    commit(repository)
    git(repository, "checkout", "--quiet", "--detach")
    assert check(repository, capsys) == (0, [])


def test_a_part_may_be_split_or_renamed_beside_other_files_if_the_sum_does_not_grow(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (repository / PLAN).rename(repository / "src/fdvv/task/plan.py")
    (repository / "src/fdvv/task").rename(repository / "src/fdvv/duty")
    write(
        repository,
        {
            "src/fdvv/__main__.py": "import fdvv.duty.plan\n",
            "src/fdvv/duty/plan.py": "import fdvv.duty.task\n" + "LENGTH = 1\n" * 49,
        },
    )
    replace(repository, "task = ", "duty = ")
    replace(repository, "src/fdvv/task/**", "src/fdvv/duty/**")
    replace(repository, "lines = 100, files = 2", "lines = 150, files = 3")
    replace(repository, "lines = 50, files = 2", "lines = 0, files = 1")
    replace(repository, '__main__ = ["study"]\nstudy = ["task"]', '__main__ = ["duty"]')
    commit(repository)
    assert check(repository, capsys)[0] == 0


def test_a_new_part_beside_other_files_is_refused(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(repository, {"tools/make.py": "\n"})
    replace(repository, "\nC = ", '\ntools = { paths = ["tools/*.py"], lines = 1, files = 1 }\nC = ')
    bad = commit(repository)
    status, lines = check(repository, capsys)
    assert status == 1
    assert [line.partition(" beside")[0] for line in lines] == [
        "budget.toml: lines of tools raised from 0 to 1",
        "budget.toml: files of tools raised from 0 to 1",
    ]
    assert f"in {bad};" in lines[0]


def test_without_git_who_raised_is_skipped_by_name(house: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, lines = check(house, capsys)
    assert status == 0
    assert [line[:48] for line in lines] == ["budget.toml: who raised a limit is not checked: "]


def test_files_left_out_of_the_count_are_a_raise(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(repository, {"firmware/more.h": "int more;\n"})
    replace(repository, '["firmware/made.h"]', '["firmware/made.h", "firmware/more.h"]')
    status, lines = check(repository, capsys)
    assert status == 1
    assert lines[0].startswith("budget.toml: generated: tools/make.sh -> firmware/more.h raised from 0 to 1")


def test_a_merge_may_have_the_highest_limit_of_its_parents_and_no_higher(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    git(repository, "checkout", "--quiet", "-b", "other")
    replace(repository, "lines = 50", "lines = 52")
    commit(repository)
    write(repository, {PLAN: "+# one\n# two\n"})
    commit(repository)
    git(repository, "checkout", "--quiet", "main")
    write(repository, {"README.md": "# Push-buttons\n"})
    commit(repository)
    git(repository, "merge", "--quiet", "--no-ff", "--no-commit", "other")
    git(repository, "commit", "--quiet", "--message", "merge")
    assert check(repository, capsys) == (0, [])
    git(repository, "reset", "--quiet", "--hard", "HEAD~1")
    git(repository, "merge", "--quiet", "--no-ff", "--no-commit", "other")
    replace(repository, "lines = 52", "lines = 53")
    write(repository, {PLAN: "+# three\n"})
    bad = commit(repository)
    status, lines = check(repository, capsys)
    assert status == 1
    assert lines[0].startswith(
        f"budget.toml: lines of study raised from 52 to 53 beside other files in {bad}"
    )


def test_in_a_shallow_clone_who_raised_is_skipped_by_name(
    repository: Path, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    clone = tmp_path_factory.mktemp("clone") / "house"
    git(repository, "clone", "--quiet", "--depth", "1", repository.as_uri(), str(clone))
    skipped = "budget.toml: who raised a limit is not checked: the clone is shallow"
    assert check(clone, capsys) == (0, [skipped])


def test_files_are_the_same_with_git_and_without(repository: Path) -> None:
    write(
        repository,
        {
            "build/out.py": "",
            "src/fdvv/made.py": "",
            "new.md": "",
            "web/.gitignore": "node_modules/\nsrc/messages.ts\n",
            "web/node_modules/a/b.ts": "",
            "web/src/messages.ts": "",
            "src/messages.ts": "",
        },
    )
    (repository / "README.md").unlink()
    tracked = list_files(repository)
    assert {"new.md", "src/messages.ts"} <= set(tracked)
    assert not {"README.md", "build/out.py", "src/fdvv/made.py", "web/src/messages.ts"} & set(tracked)
    (repository / ".git").rename(repository / "git")
    assert [name for name in list_files(repository) if not name.startswith("git/")] == tracked


def test_writing_the_same_limits_changes_nothing() -> None:
    text = (CHECKOUT / "budget.toml").read_text(encoding="utf-8")
    assert write_limits(text, parse_limits(tomllib.loads(text))) == text


@pytest.mark.parametrize("name", ["judged", "_found_row", "made_press", "fitted"])
def test_a_past_participle_is_no_name_of_a_function(name: str) -> None:
    assert begins_with_participle(name)


@pytest.mark.parametrize(
    "name", ["judge", "open_button", "seed", "_speed_mm_s", "is_fitted", "need", "__enter__"]
)
def test_verbs_and_nouns_are(name: str) -> None:
    assert not begins_with_participle(name)


@pytest.mark.parametrize(
    ("paths", "name", "matches"),
    [
        (["a/*.py"], "a/b.py", True),
        (["a/*.py"], "a/c/b.py", False),
        (["a/**/*.py"], "a/b.py", True),
        (["a/**/*.py"], "a/c/d/b.py", True),
        (["**/*.h", "x.c"], "x.c", True),
        (["a.py"], "axpy", False),
    ],
)
def test_paths_are_matched_as_git_does(paths: list[str], name: str, matches: bool) -> None:
    assert bool(to_pattern(paths).fullmatch(name)) is matches
