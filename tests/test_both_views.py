"""The declared answer of record, and what the enforced view adds to it (rule S6)."""

from __future__ import annotations

import json
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.modes import View
from rosprivacy.both_views import both_views
from rosprivacy.settings import Settings
from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

NODES = ("/a", "/b", "/c", "/d")
TOPICS = ("/s", "/t", "/u", "/*")
RIGHTS = [
    (role, topic, rule) for role in ("publish", "subscribe") for topic in TOPICS for rule in ("ALLOW", "ALLOW", "DENY")
]
LABELS = (
    "{source: [Video]}", "{leak: [Video]}", "{sanitizer: {Video: anonymise}}", "conduit",
    "{source: [Voice], leak: [Video]}",
)  # fmt: skip
EXAMPLE = {"/robot": {"/camera": [("publish", "/video", "ALLOW")],
                      "/blur": [("subscribe", "/video", "ALLOW"), ("publish", "/blurred", "ALLOW")]},
           "/uplink": {"/uplink": [("subscribe", "/blurred", "ALLOW")]}}  # fmt: skip
EXAMPLE_LABELS = """labels: 1
nodes: {/camera: {source: [Video]}, /blur: {sanitizer: {Video: anonymise}}, /uplink: {leak: [Video]}}
channels: {/video: sensitive, /blurred: sensitive}
"""
Enclaves = dict[str, dict[str, list[tuple[str, str, str]]]]

systems = st.tuples(
    st.lists(
        st.tuples(st.sampled_from(("/e", "/f")), st.lists(st.sampled_from(RIGHTS), min_size=1, max_size=3)),
        min_size=len(NODES), max_size=len(NODES),
    ),
    st.lists(st.sampled_from(LABELS), min_size=len(NODES), max_size=len(NODES)),
)  # fmt: skip


def policy(enclaves: Enclaves) -> str:
    lines = ['<policy version="0.2.0"><enclaves>']
    for path, profiles in enclaves.items():
        lines.append(f'<enclave path="{path}"><profiles>')
        for node, rights in profiles.items():
            lines.append(f'<profile ns="/" node="{node[1:]}">')
            lines += [f'<topics {role}="{rule}"><topic>{topic}</topic></topics>' for role, topic, rule in rights]
            lines.append("</profile>")
        lines.append("</profiles></enclave>")
    return "\n".join([*lines, "</enclaves></policy>\n"])


def of_drawn(drawn: list[tuple[str, list[tuple[str, str, str]]]]) -> Enclaves:
    enclaves: Enclaves = {}
    for node, (path, rights) in zip(NODES, drawn, strict=True):
        enclaves.setdefault(path, {})[node] = rights
    return enclaves


def union(enclaves: Enclaves) -> Enclaves:
    """Each node of an enclave has all lines of it: what the enforced view means, written out."""
    return {
        path: {node: [right for rights in profiles.values() for right in rights] for node in profiles}
        for path, profiles in enclaves.items()
    }


def apart(enclaves: Enclaves, chosen: list[str]) -> Enclaves:
    """The policy that somebody writes who splits some enclaves: a DENY goes with each of their nodes."""
    found: Enclaves = {}
    for path, profiles in enclaves.items():
        denied = [right for rights in profiles.values() for right in rights if right[2] == "DENY"]
        for node, rights in profiles.items():
            where = f"{path}{node}" if path in chosen else path
            found.setdefault(where, {})[node] = [*rights, *denied] if path in chosen else rights
    return found


def ids(text: str, view: View) -> set[str]:
    Path("q.xml").write_text(text)
    result = rosprivacy.analyze("q.xml", "l.yaml", view=view)
    return {finding.id for finding in result.analysis.findings if finding.stands}


@given(systems)
def test_what_is_added_is_what_the_union_of_all_profiles_has_and_splitting_ends_it(
    drawn: tuple[list[tuple[str, list[tuple[str, str, str]]]], list[str]],
) -> None:
    enclaves = of_drawn(drawn[0])
    with TemporaryDirectory() as folder, chdir(folder):
        Path("p.xml").write_text(policy(enclaves))
        said = "".join(f"  {node}: {label}\n" for node, label in zip(NODES, drawn[1], strict=True))
        Path("l.yaml").write_text(f"labels: 1\nnodes:\n{said}")
        try:
            result, enforced = both_views(("p.xml",), ("l.yaml",), Settings())
        except rosprivacy.InputErrors:
            assume(False)
            raise
        declared = {finding.id for finding in result.analysis.findings if finding.stands}
        added = {entry["finding"]["id"] for entry in enforced["added"]}
        assert added == ids(policy(union(enclaves)), View.declared) - declared
        for entry in enforced["added"]:
            assert entry["enclaves"]
            if entry["split"]:
                assert entry["finding"]["id"] not in ids(policy(apart(enclaves, entry["split"])), View.enforced)


@pytest.fixture
def example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy(EXAMPLE))
    Path("l.yaml").write_text(EXAMPLE_LABELS)


@pytest.mark.usefixtures("example")
def test_the_declared_answer_is_that_of_record_and_the_other_is_told_with_its_remedy(cli: Cli) -> None:
    done = cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both")
    assert (done.returncode, done.stdout.split(":")[0]) == (0, "no-leak-found")
    assert "What the enforced view adds: 1 finding" in done.stdout
    assert "   only because nodes share enclave /robot" in done.stdout
    assert "   gone if /robot is split into an enclave for each node: proven by a new analysis" in done.stdout
    for language, words in (
        ("de", "Was die Sicht enforced hinzufügt: 1"),
        ("fr", "Ce que la vue enforced ajoute\xa0: 1"),
    ):
        assert words in cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both", "--lang", language).stdout


@pytest.mark.usefixtures("example")
def test_the_document_has_it_beside_the_declared_answer(cli: Cli) -> None:
    document = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both", "-f", "json").stdout)
    alone = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json").stdout)
    enforced = document.pop("enforced")
    assert document == alone
    assert enforced["verdict"] == "leak"
    [entry] = enforced["added"]
    assert (entry["enclaves"], entry["split"], entry["finding"]["category"]) == (["/robot"], ["/robot"], "Video")


@pytest.mark.usefixtures("example")
@pytest.mark.parametrize("more", [("-f", "sarif"), ("--per-policy",), ("--save-graph", "g.json")])
def test_it_is_for_one_robot_in_text_and_json(cli: Cli, more: tuple[str, ...]) -> None:
    done = cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both", *more)
    assert done.returncode == 2
    assert "--view both is for the policies of one robot" in done.stderr
