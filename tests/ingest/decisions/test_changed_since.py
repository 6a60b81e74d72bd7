"""A decision remembers what it was made about; where that has changed since, every output says so (rule S10)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import Cli, refused
from tests.helpers.fleet_files import policy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

ID = "0123456789abcdef"
DIRECT = policy("/camera>/a", "/relay>/b</a", "/second</c", "/uplink</b")
LONGER = policy("/camera>/a", "/relay>/c</a", "/second>/b</c", "/uplink</b")
TWICE = policy("/camera>/a,/d", "/relay>/b</a", "/second</c", "/uplink</b,/d")
LABELS = """labels: 1
nodes: {/camera: {source: [Video]}, /relay: conduit, /second: conduit, /uplink: {leak: [Video]}}
channels: {"/?": sensitive}
"""
SIGNED = ("--reason", "agreed", "--owner", "me", "--legal-basis", "6(1)(f)")
EXAMPLES = [
    ("care-home", ["care-home.policy.xml"], "care-home.labels.yaml"),
    ("factory", ["before.policy.xml"], "run2.labels.yaml"),
]


@pytest.fixture
def decided(cli: Cli, tmp_path: Path) -> Path:
    """A folder in which the one finding is accepted, as it is by the first policy."""
    (tmp_path / "p.xml").write_text(DIRECT)
    (tmp_path / "l.yaml").write_text(LABELS)
    cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json", "-o", "r.json", cwd=tmp_path)
    (finding,) = json.loads((tmp_path / "r.json").read_text())["findings"]
    assert (
        cli(
            "decide",
            "accept",
            finding["id"],
            "--report",
            "r.json",
            *SIGNED,
            "--decisions",
            "decisions.yaml",
            cwd=tmp_path,
        ).returncode
        == 0
    )
    return tmp_path


def told(cli: Cli, folder: Path, *options: str) -> dict[str, Any]:
    done = cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "decisions.yaml", "-f", "json", *options, cwd=folder)
    assert done.returncode in (0, 4), done.stderr
    return dict(json.loads(done.stdout)) | {"code": done.returncode}


def test_what_it_was_made_about_is_written_down(decided: Path) -> None:
    text = (decided / "decisions.yaml").read_text()
    assert text.endswith(
        "  made_about:\n    view: declared\n    path: [/camera, /a, /relay, /b, /uplink]\n    disjoint_paths: 1\n"
    )


def test_nothing_is_told_while_nothing_changes(cli: Cli, decided: Path) -> None:
    document = told(cli, decided)
    assert document["findings"][0]["accepted"]
    assert "changed" not in document["findings"][0]["decision"]
    assert not any("changed since" in said["message"] for said in document["diagnostics"])


@pytest.mark.parametrize(
    ("changed", "options", "what"),
    [
        (LONGER, (), {"path": ("/camera -> /a -> /relay -> /b -> /uplink",
                               "/camera -> /a -> /relay -> /c -> /second -> /b -> /uplink")}),
        (TWICE, (), {"path": ("/camera -> /a -> /relay -> /b -> /uplink", "/camera -> /d -> /uplink"),
                     "disjoint_paths": ("1", "2")}),
        (DIRECT, ("--view", "enforced"), {"view": ("declared", "enforced"), "disjoint_paths": ("1", "2"), "path": (
            "/camera -> /a -> /relay -> /b -> /uplink", "/camera -> /a -> /uplink")}),
    ],
    ids=["path", "more paths", "view"],
)  # fmt: skip
def test_what_changed_is_told_and_the_acceptance_still_counts(
    cli: Cli, decided: Path, changed: str, options: tuple[str, ...], what: dict[str, tuple[str, str]]
) -> None:
    """The finding is the same: the same kind of data from the same source at the same leak."""
    (decided / "p.xml").write_text(changed)
    document = told(cli, decided, *options)
    (finding,) = document["findings"]
    assert finding["accepted"]
    told_of = {change["what"]: (change["before"], change["now"]) for change in finding["decision"]["changed"]}
    assert told_of == what
    assert document["decisions"][0]["changed"] == finding["decision"]["changed"]
    (message,) = (said for said in document["diagnostics"] if "changed since the decision" in said["message"])
    assert (message["severity"], message["line"]) == ("warning", 4)


@pytest.mark.parametrize(
    ("command", "form"),
    [("analyze", "text"), ("analyze", "sarif"), ("analyze", "turtle"), ("report", "html"), ("report", "markdown")],
)
def test_every_output_says_so_and_one_that_is_shown_to_others_names_nothing(
    cli: Cli, decided: Path, command: str, form: str
) -> None:
    (decided / "p.xml").write_text(LONGER)
    asked = (command, "p.xml", "-l", "l.yaml", "--decisions", "decisions.yaml", "-f", form, "-o", "out")
    cli(*asked, cwd=decided)
    written = " ".join((decided / "out").read_text("utf-8").split())
    assert "changed since" in written.lower()
    assert "/second" in written
    if command == "report":
        cli(*asked, "--redact", cwd=decided)
        assert "/second" not in (decided / "out").read_text("utf-8")


def test_an_entry_of_earlier_versions_is_compared_to_nothing(cli: Cli, decided: Path) -> None:
    text = (decided / "decisions.yaml").read_text()
    (decided / "decisions.yaml").write_text(text[: text.index("  made_about")])
    (decided / "p.xml").write_text(LONGER)
    document = told(cli, decided)
    assert document["findings"][0]["accepted"]
    assert not any("changed since" in said["message"] for said in document["diagnostics"])


@pytest.mark.parametrize(("folder", "policies", "labels"), EXAMPLES, ids=[row[0] for row in EXAMPLES])
def test_to_accept_a_finding_changes_nothing_of_what_it_was_decided_about(
    cli: Cli, tmp_path: Path, folder: str, policies: list[str], labels: str
) -> None:
    named = [str(ROOT / "examples" / folder / name) for name in (*policies, labels)]
    asked = ("analyze", *named[:-1], "-l", named[-1], "-f", "json")
    cli(*asked, "-o", tmp_path / "r.json")
    found = [finding["id"] for finding in json.loads((tmp_path / "r.json").read_text())["findings"]]
    assert found
    for number, one in enumerate(found):
        file = tmp_path / f"{number}.yaml"
        cli("decide", "accept", one, "--report", tmp_path / "r.json", *SIGNED, "--decisions", file)
        assert "made_about" in file.read_text()
        assert '"changed"' not in cli(*asked, "--decisions", file).stdout


@pytest.mark.parametrize(
    ("about", "said"),
    [
        ("x", "made_about is a map, not a text"),
        ("{robots: []}", "robots of a decision names nothing"),  # else it would be about all robots
        ("{robots: r1}", "robots takes a list, not a text"),
        ("{robots: [r1, {a: b}]}", "robots takes text"),
        ("{path: [1]}", "path takes text"),
        ("{disjoint_paths: none}", "disjoint_paths takes a number"),
        ("{disjoint_paths: 0}", "disjoint_paths takes a number"),
        ("{disjoint_paths: 99999999999}", "disjoint_paths takes a number"),
        ("{view: [a]}", "view takes text"),
        ("{robot: [r1]}", "unknown key 'robot'; did you mean 'robots'?"),
        ("{disjoint_paths: 1}, leak: /uplink", "made_about without an id"),
    ],
)
def test_what_is_no_such_memory_is_refused(cli: Cli, decided: Path, about: str, said: str) -> None:
    entry = f"{'' if 'leak' in about else f'id: {ID}, '}decision: avoid, made_about: {about}"
    (decided / "decisions.yaml").write_text(f"decisions: 1\nfindings:\n- {{{entry}}}\n")
    lines = refused(cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "decisions.yaml", cwd=decided))
    assert any(said in line for line in lines), lines
