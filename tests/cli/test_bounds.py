"""Every bound: an input one above it is refused with the option that raises it, one at it passes, raised it passes.

Rule S11: what meets a bound is refused, or the answer says what it does not know; nothing is left out in silence.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.bounds import BOUNDS, COUNTED
from tests.helpers.command import Cli, refused, run
from tests.helpers.daily import one_in
from tests.helpers.policies import document, policy

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

LABELS = "labels: 1\nnodes: {/a: conduit}\n"


@dataclass(frozen=True)
class Input:
    """Files with so many of something, and how they are read; ``line`` is where the bound is met."""

    files: dict[str, str]
    arguments: tuple[str, ...]
    line: str


def topics(*names: str, role: str = "publish") -> str:
    return f'<topics {role}="ALLOW">{"".join(f"<topic>{name}</topic>" for name in names)}</topics>'


def policy_of_bytes(number: int) -> Input:
    """Spaces at its end count too."""
    return Input({"p.xml": policy(topics("t")).ljust(number)}, ("analyze", "p.xml"), "p.xml: ")


def long_name(number: int) -> Input:
    return Input({"p.xml": policy("\n" + topics("/" + "n" * (number - 1)))}, ("analyze", "p.xml"), "p.xml:2: ")


def long_label(number: int) -> Input:
    text = f"labels: 1\nnodes:\n  /a: conduit\nflows:\n  - {{from: /{'n' * (number - 1)}, to: /a}}\n"
    return Input({"p.xml": policy(topics("t")), "l.yaml": text}, ("analyze", "p.xml", "-l", "l.yaml"), "l.yaml:5: ")


def nested_labels(number: int) -> Input:
    levels = number - 2  # beside the document's map and that of the nodes
    text = f"labels: 1\nnodes:\n  /a: {'[' * levels}{']' * levels}\n"
    return Input({"p.xml": policy(topics("t")), "l.yaml": text}, ("analyze", "p.xml", "-l", "l.yaml"), "l.yaml:3: ")


def fleet(groups: str) -> Input:
    text = f"fleet: 1\nmodels: {{m: {{policies: p.xml}}}}\n{groups}"
    return Input({"p.xml": policy(topics("t")), "f.yaml": text}, ("fleet", "f.yaml"), "f.yaml:")


def one_group(number: int) -> Input:
    return fleet(f"groups: [{{robots: {number}, model: m}}]\n")


def many_groups(number: int) -> Input:
    halves = number // 2, number - number // 2
    groups = "".join(f"  - {{robots: {half}, model: m, id: g{i}_*}}\n" for i, half in enumerate(halves))
    return fleet(f"groups:\n{groups}")


def named_robots(number: int) -> Input:
    robots = "".join(f"  r{i}: {{model: m}}\n" for i in range(number // 2))
    return fleet(f"robots:\n{robots}groups: [{{robots: {number - number // 2}, model: m, id: g_*}}]\n")


def two_wildcards(number: int) -> Input:
    """A pair without literal ends has 4 steps, and one for each character of what is written (``rt/ww…?`` in DDS)."""
    written = topics("/" + "w" * (number - len("rt/?") - 4) + "?")
    return Input({"p.xml": policy(f"\n{written}{topics('/*?', role='subscribe')}")}, ("analyze", "p.xml"), "p.xml:2: ")


def label_globs(number: int) -> Input:
    """A glob beside a name has 4 steps; the standard channels are switched off, since they are globs too."""
    text = "labels: 1\nnodes:\n" + "".join(f"  /{'*' * (i + 1)}a: conduit\n" for i in range((number + 3) // 4))
    files = {"p.xml": policy(topics("t")), "l.yaml": text}
    return Input(files, ("analyze", "p.xml", "-l", "l.yaml", "--standard-channels", "none"), "l.yaml:13: ")


def matched_names(number: int) -> Input:
    """A flow for each name that is read, for the wildcard, and for each name that it matches."""
    read = [f"t{i}" for i in range((number - 1) // 2)]
    written = ["*", *read[: 1 - number % 2]]  # one more if there have to be
    body = f"{topics(*read, role='subscribe')}\n{topics(*written)}"
    return Input({"p.xml": policy(body)}, ("analyze", "p.xml"), "p.xml:2: ")


def leaks(number: int) -> Input:
    """One finding for each leak of one source."""
    node = '<profile ns="/" node="{}"><topics {}="ALLOW"><topic>/t</topic></topics></profile>'
    nodes = node.format("a", "publish") + "".join(node.format(f"l{i}", "subscribe") for i in range(number))
    enclaves = f'<enclaves><enclave path="/e"><profiles>{nodes}</profiles></enclave></enclaves>'
    labels = "labels: 1\nnodes:\n  /a: {source: [Video]}\n  /l*: {leak: [Video]}\n"
    files = {"p.xml": f'<policy version="0.2.0">{enclaves}</policy>', "l.yaml": labels}
    return Input(files, ("analyze", "p.xml", "-l", "l.yaml"), "the analysis: ")


ROWS: list[tuple[str, int, Callable[[int], Input], int]] = [  # bound, set to, what has so many, or the default
    ("policy_bytes", 900, policy_of_bytes, 0),
    ("name", 300, long_name, 0),
    ("name", 300, long_label, 1),  # its name is not there: so much is read
    ("nesting", 6, nested_labels, 1),  # no label is a list of lists
    ("robots", 10, one_group, 0),
    ("robots", 10, many_groups, 0),
    ("robots", 10, named_robots, 0),
    ("findings", 7, leaks, 0),
    ("comparisons", 60, two_wildcards, 0),
    ("comparisons", 40, label_globs, 0),
    ("flows", 20, matched_names, 0),
    ("flows", 21, matched_names, 0),
]


def ran(folder: Path, given: Input, *more: str, by: Cli) -> tuple[int, list[str]]:
    for name, text in given.files.items():
        (folder / name).write_text(text)
    done = by(*given.arguments, *more, cwd=folder)
    return done.returncode, done.stderr.splitlines()


@pytest.mark.parametrize(
    ("name", "bound", "made", "problems"), ROWS, ids=lambda value: getattr(value, "__name__", None)
)
def test_one_above_is_refused_and_at_it_all_passes(
    cli: Cli, tmp_path: Path, name: str, bound: int, made: Callable[[int], Input], problems: int
) -> None:
    over, option = made(bound + 1), ("--bound", f"{name}={bound}")
    for file, text in over.files.items():
        (tmp_path / file).write_text(text)
    lines = refused(cli(*over.arguments, *option, cwd=tmp_path))
    (told,) = [line for line in lines if "--bound" in line]
    assert told.startswith(over.line)
    assert f"more than the bound of {bound}" in told
    assert told.endswith(f"raise it with --bound {name}=N")
    for given, set_to in ((made(bound), bound), (over, bound + 4)):
        code, lines = ran(tmp_path, given, "--bound", f"{name}={set_to}", by=cli)
        assert not any("--bound" in line for line in lines)
        assert (code == 2) == bool(problems)


@pytest.mark.parametrize(("name", "made"), [("name", long_name), ("robots", one_group), ("nesting", nested_labels)])
def test_the_default_is_refused_above_as_well(
    cli: Cli, tmp_path: Path, name: str, made: Callable[[int], Input]
) -> None:
    code, lines = ran(tmp_path, made(getattr(BOUNDS, name) + 1), by=cli)
    assert code == 2
    assert any(line.endswith(f"raise it with --bound {name}=N") for line in lines)
    (line,) = refused(cli(*made(1).arguments, "--bound", f"{name}x=5", cwd=tmp_path))
    assert line.startswith(f"--bound: '{name}x' is none of ")
    assert line.endswith(f"; did you mean {name}?")


def test_every_bound_has_its_rows() -> None:
    assert {*(name for name, *_ in ROWS), "search_steps", "path_steps", "passed_over"} == set(COUNTED)


def test_sources_are_followed_up_to_a_bound(cli: Cli, tmp_path: Path) -> None:
    code, (line,) = ran(tmp_path, leaks(5), "--bound", "search_steps=5", by=cli)
    assert code == 2
    assert line.startswith("the analysis: more than the bound of 5 elements reached, counted for each source; raise it")
    assert ran(tmp_path, leaks(5), by=cli) == (1, [])


def test_paths_that_are_not_counted_are_told(cli: Cli, tmp_path: Path) -> None:
    """No finding is left out, and the verdict stays (rule S11)."""
    given = leaks(5)
    ran(tmp_path, given, by=cli)
    whole = document(cli, *given.arguments[1:], cwd=tmp_path)
    some = document(cli, *given.arguments[1:], "--bound", "path_steps=6", cwd=tmp_path)
    assert [one["id"] for one in some["findings"]] == [one["id"] for one in whole["findings"]]
    assert (some["verdict"], len(some["findings"])) == ("leak", 5)
    (told,) = [said for said in some["diagnostics"] if said.get("code") == "paths-not-counted"]
    assert told["severity"] == "warning"
    assert "raise it with --bound path_steps=N" in told["message"]
    assert not [said for said in whole["diagnostics"] if said.get("code") == "paths-not-counted"]
    text = cli(*given.arguments, "--bound", "path_steps=1", cwd=tmp_path).stdout
    assert "how many paths share no flow is not counted" in " ".join(text.split())


def test_files_that_are_not_looked_into_are_told(cli: Cli, tmp_path: Path) -> None:
    """Rule S11: what lies behind a bound may be a policy; hidden files are looked into last."""
    (tmp_path / "d").mkdir()
    (tmp_path / "d/p.xml").write_text(policy(topics("t")))
    for name in (".a", "b.txt", "c.txt"):
        (tmp_path / "d" / name).write_text("text")
    for bound, number in ((2, 1), (3, 0)):
        some = document(cli, "d", "--bound", f"passed_over={bound}", cwd=tmp_path)
        told = [said["message"] for said in some["diagnostics"] if said.get("code") == "unread-file"]
        assert len(told) == number
        assert all("raise it with --bound passed_over=N" in one for one in told)


def test_a_fleet_file_of_a_kilobyte_states_no_millions(tmp_path: Path) -> None:
    """20 groups of 1,000,000 robots were not read in 120 s."""
    groups = "".join(f"  - {{robots: 1000000, model: m, id: g{i}_*}}\n" for i in range(20))
    given = fleet(f"groups:\n{groups}")
    assert len(given.files["f.yaml"]) < 1_000
    for name, text in given.files.items():
        (tmp_path / name).write_text(text)
    lines = refused(run("analyze", "--fleet", "f.yaml", cwd=tmp_path, seconds=60))
    assert lines[0].startswith("f.yaml:4: 1,000,000 robots in the fleet, more than the bound of 200,000")
    assert lines[-1].startswith("f.yaml:23: 20,000,000 robots in the fleet")


def written_and_read(written: list[str], read: list[str]) -> str:
    return policy(topics(*written) + topics(*read, role="subscribe"))


@pytest.mark.parametrize("number", one_in(2, [5, 20]))
def test_long_wildcards_that_overlap_are_compared(tmp_path: Path, number: int) -> None:
    """20 + 20 names of 900 characters (37 kB) were not compared in 120 s."""
    names = [f"/*{'a*b' * 300}{i}*" for i in range(2 * number)]
    (tmp_path / "p.xml").write_text(written_and_read(names[:number], names[number:]))
    assert run("analyze", "p.xml", cwd=tmp_path, seconds=60).returncode == 4
    graph = rosprivacy.analyze(tmp_path / "p.xml").analysis.graph
    joined = [flow for flow in graph.flows if flow.role == "matches"]
    assert len(joined) == number**2  # exact: each pair has names in common


@pytest.mark.slow
def test_rights_that_grow_with_the_square_of_a_policy_are_told_once(tmp_path: Path) -> None:
    """2,000 nodes of one enclave with a name each are 4 million flows in the enforced view, in 200 kB."""
    profile = '<profile ns="/" node="n{0}"><topics publish="ALLOW"><topic>t{0}</topic></topics></profile>'
    profiles = "".join(profile.format(i) for i in range(2_000))
    enclaves = f'<enclaves><enclave path="/e"><profiles>{profiles}</profiles></enclave></enclaves>'
    (tmp_path / "p.xml").write_text(f'<policy version="0.2.0">{enclaves}</policy>')
    assert run("analyze", "p.xml", "--view", "enforced", cwd=tmp_path, seconds=180).returncode == 4
    (line,) = refused(run("graph", "p.xml", "--view", "enforced", "-o", "p.svg", cwd=tmp_path, seconds=180))
    assert "more than the bound of 1,000,000 flows" in line  # a picture shows each


def test_a_deny_that_is_too_much_to_follow_is_told(cli: Cli, tmp_path: Path) -> None:
    """The careful answer is that a name is left, and a reader of the report knows it (rule S11)."""
    denied = topics("/", "/?*", *(f"/*{letter}{'?' * 12}" for letter in "abcdefgh")).replace("ALLOW", "DENY")
    (tmp_path / "p.xml").write_text(policy(f"{topics('/*')}\n{denied}"))
    done = cli("analyze", "p.xml", "-v", cwd=tmp_path)
    assert "p.xml:2: this DENY takes names out of wildcards" in " ".join(done.stdout.split())
