"""A project file names what commands read; it comes with a checkout, so it reaches nothing but what lies below it."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.cli.project_file import KEYS, nearest_project, project_schema, read_project
from tests.helpers.command import cli, refused

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

STATED = """\
policies = ["*.policy.xml"]
labels = "care-home.labels.yaml"
lang = "de"
fail-on = ["leak"]
"""


@pytest.fixture
def home(examples: Path, tmp_path: Path) -> Path:
    """A repository with a system, and a project file that names it."""
    folder = tmp_path / "robot"
    shutil.copytree(examples / "care-home", folder)
    (folder / ".git").mkdir()
    (folder / "below").mkdir()
    (folder / "rosprivacy.toml").write_text(STATED)
    return folder


def document(cli: Cli, *arguments: str, cwd: Path) -> dict[str, object]:
    done = cli("analyze", "--format", "json", *arguments, cwd=cwd)
    whole: dict[str, object] = json.loads(done.stdout)
    return whole


@pytest.mark.parametrize("where", [".", "below"])
def test_commands_take_what_is_not_named(cli: Cli, home: Path, where: str) -> None:
    named = ["*.policy.xml", "--labels", "care-home.labels.yaml"]
    plain = cli("analyze", "-q", "--no-project", "--lang", "de", *named, cwd=home)
    done = cli("analyze", "-q", cwd=home / where)
    assert (done.stdout, done.returncode) == (plain.stdout, plain.returncode)
    assert [line for line in done.stderr.splitlines() if "rosprivacy.toml: policies" in line]


def test_what_was_taken_stands_in_every_output(cli: Cli, home: Path) -> None:
    digest = hashlib.sha256(STATED.encode()).hexdigest()
    for form in ("json", "json1", "text", "html", "markdown", "sarif", "cnil-pia"):
        done = cli("analyze", "--format", form, "-o", "out", cwd=home)
        assert done.returncode == 1
        text = (home / "out").read_text()
        assert "rosprivacy.toml" in text, form
        assert digest[:12] in text, form


def test_the_command_line_wins(cli: Cli, home: Path) -> None:
    assert "Daten" in cli("analyze", "-q", cwd=home).stdout
    assert "Daten" not in cli("analyze", "-q", "--lang", "en", cwd=home).stdout  # also where it says the default
    (home / "other.labels.yaml").write_text("labels: 1\nauthor: Ada\n")
    done = cli("analyze", "-q", "--labels", "other.labels.yaml", cwd=home)
    assert "not its labels care-home.labels.yaml, since others are named" in done.stderr
    assert done.returncode == 4  # without data that comes in, 'leak' fails, too
    assert cli("analyze", "-q", "--fail-on", "never", cwd=home).returncode == 0


def test_another_system_takes_nothing_of_this(cli: Cli, home: Path, examples: Path) -> None:
    other = str(examples / "factory" / "before.policy.xml")
    assumptions = document(cli, other, cwd=home)["assumptions"]
    assert isinstance(assumptions, dict)
    assert "project" not in assumptions
    assert not assumptions["labels"]
    assert "since another system is named" in cli("analyze", "-q", other, cwd=home).stderr
    same = document(cli, "care-home.policy.xml", cwd=home)["assumptions"]
    assert isinstance(same, dict)
    assert same["labels"]


def test_diff_is_against_the_baseline(cli: Cli, home: Path) -> None:
    assert "a baseline" in cli("diff", cwd=home).stderr
    assert cli("diff", cwd=home).returncode == 2
    (home / "known.json").write_text(json.dumps(document(cli, cwd=home)))
    with (home / "rosprivacy.toml").open("a") as file:
        file.write('baseline = "known.json"\n')
    assert cli("diff", cwd=home).returncode == 0
    (home / "care-home.labels.yaml").write_text("labels: 1\nauthor: Ada\n")
    changed = cli("diff", "--fail-on", "any", cwd=home)
    assert changed.returncode == 1


def test_a_fleet_is_a_system(cli: Cli, examples: Path, tmp_path: Path) -> None:
    shutil.copytree(examples / "fleet", tmp_path / "fleet")
    (tmp_path / "rosprivacy.toml").write_text('fleet = "fleet/fleet.yaml"\n')
    file = next((tmp_path / "fleet").glob("*fleet.yaml"))
    (tmp_path / "rosprivacy.toml").write_text(f'fleet = "fleet/{file.name}"\n')
    named = cli("analyze", "-q", "--no-project", "--fleet", f"fleet/{file.name}", cwd=tmp_path)
    assert cli("analyze", "-q", cwd=tmp_path).stdout == named.stdout
    assert "name at least one policy" in cli("mitigate", cwd=tmp_path).stderr


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('polices = "a.xml"', "unknown key 'polices'; did you mean policies?"),
        ('include-root = "/"', "unknown key 'include-root'; a project file states"),
        ("allow-unsigned = true", "unknown key"),
        ('neo4j = "bolt://elsewhere"', "unknown key"),
        ('output = "/tmp/x"', "unknown key"),
        ('standard-channels = "mine.yaml"', "unknown key"),
        ('labels = "/etc/passwd"', "leaves the folder"),
        ('labels = "../labels.yaml"', "leaves the folder"),
        ('labels = "out.yaml"', "leaves the folder"),
        ('policies = "policies"', "leaves the folder"),
        ('policies = "p*/*.xml"', "leaves the folder"),
        ("labels = [1]", "no name of a file"),
        ('lang = "xx"', "'xx' is no value of lang"),
        ('fail-on = ["all"]', "'all' is no value of fail-on"),
        ("domain = -1", "-1 is no domain"),
        ("domain = true", "True is no domain"),
        ("a = ", "Invalid value"),
    ],
)
def test_what_it_may_not_say(tmp_path: Path, line: str, what: str) -> None:
    folder = tmp_path / "robot"
    (folder / "policies").mkdir(parents=True)
    (tmp_path / "secret.xml").write_text("<policy/>")
    (folder / "out.yaml").symlink_to(tmp_path / "secret.xml")
    (folder / "policies" / "out.xml").symlink_to(tmp_path / "secret.xml")
    (folder / "rosprivacy.toml").write_text(f"# ours\n{line}\n")
    with pytest.raises(InputErrors) as raised:
        read_project(folder / "rosprivacy.toml")
    (error,) = raised.value.errors
    assert error.line == 2
    assert what in str(error)


def test_every_problem_is_one_line(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "rosprivacy.toml").write_text('fleet = "f"\npolicies = "p"\nlang = 1\nx = 2\n')
    assert [line.split(":")[1] for line in refused(cli("analyze", cwd=tmp_path))] == ["1", "3", "4"]


def test_it_states_nothing_that_decides_where_to_read_or_write() -> None:
    assert {*KEYS} == {
        "policies", "fleet", "labels", "types", "decisions", "baseline", "domain", "lang", "fail-on",
    }  # fmt: skip


@given(
    st.dictionaries(
        st.sampled_from([*KEYS, "other"]),
        st.sampled_from(["p", "", 0, -1, True, None, "de", "leak", ["p"], ["p", 3], ["leak", "never"], ["x"], {}]),
    )
)
def test_the_schema_for_editors_accepts_what_is_read(table: dict[str, Any]) -> None:
    jsonschema.Draft202012Validator.check_schema(project_schema())
    table = {key: value for key, value in table.items() if value is not None}
    with TemporaryDirectory() as folder:
        file = Path(folder, "rosprivacy.toml")
        lines = [f"{key} = {'{}' if value == {} else json.dumps(value)}" for key, value in table.items()]
        file.write_text("\n".join(lines), "utf-8")
        try:
            read_project(file)
        except InputErrors:
            read = False
        else:
            read = True
    assert jsonschema.Draft202012Validator(project_schema()).is_valid(table) == read, table


def test_the_search_ends(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert nearest_project(home / "below") == home / "rosprivacy.toml"
    own = home / "below" / "pyproject.toml"
    own.write_text('[project]\ndependencies = ["rosprivacy"]\n[tool.other]\nx = 1\n')  # nothing is said here
    assert nearest_project(home / "below") == home / "rosprivacy.toml"
    own.write_text('[tool.rosprivacy]\nlang = "fr"\n')
    assert nearest_project(home / "below") == own
    own.unlink()
    (home / "rosprivacy.toml").rename(tmp_path / "rosprivacy.toml")
    assert nearest_project(home / "below") is None  # beyond the root of the repository
    (home / ".git").rmdir()
    assert nearest_project(home / "below") == tmp_path / "rosprivacy.toml"
    monkeypatch.setenv("HOME", str(tmp_path))
    assert nearest_project(home / "below") is None  # what lies in the home folder is of everything below it
    assert nearest_project(tmp_path) == tmp_path / "rosprivacy.toml"


def test_another_file_system_ends_the_search(tmp_path: Path) -> None:
    shared = Path("/dev/shm")  # noqa: S108 - a file system of its own, where there is one
    if not shared.is_dir() or shared.stat().st_dev == shared.parent.stat().st_dev:
        pytest.skip("this machine has one file system only")
    folder = shared / f"rosprivacy-{os.getpid()}-{tmp_path.name}"
    folder.mkdir()
    try:
        assert nearest_project(folder) is None
    finally:
        folder.rmdir()


def test_a_file_of_python_that_says_nothing_is_no_project_file(cli: Cli, home: Path) -> None:
    (home / "pyproject.toml").write_text("[tool.other]\n")
    assert "has no [tool.rosprivacy]" in "".join(refused(cli("analyze", "--project", "pyproject.toml", cwd=home)))


def test_two_files_in_one_folder(cli: Cli, home: Path) -> None:
    (home / "pyproject.toml").write_text('[tool.rosprivacy]\nlang = "fr"\n')
    assert "keep one of them" in "".join(refused(cli("analyze", cwd=home)))


def test_a_file_that_others_could_have_put_there(cli: Cli, home: Path) -> None:
    home.chmod(0o777)
    assert "all may write" in "".join(refused(cli("analyze", "-q", cwd=home / "below")))
    named = cli("analyze", "-q", "--project", home / "rosprivacy.toml", cwd=home / "below")
    assert named.returncode == 1
    assert cli("analyze", "-q", "--no-project", "care-home.policy.xml", cwd=home).returncode == 4
    home.chmod(0o755)
    if os.getuid() == 0:
        os.chown(home / "rosprivacy.toml", 65534, -1)
        assert "another user" in "".join(refused(cli("analyze", "-q", cwd=home)))


def test_types_that_nobody_names_are_said_to_lie_there(cli: Cli, home: Path) -> None:
    """They could turn a leak into 'undetermined' (rule S15), so a folder alone does not make them count."""
    before = cli("analyze", cwd=home).stdout
    (home / "care-home.types.yaml").write_text("types: 1\ntopics: {}\n")
    after = cli("analyze", "--lang", "en", cwd=home).stdout
    assert "message types lie in care-home.types.yaml, and are not read" in after
    assert "care-home.types.yaml" not in before
    assert "not read" not in cli("analyze", "--types", "care-home.types.yaml", "--lang", "en", cwd=home).stdout
