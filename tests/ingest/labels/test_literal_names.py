"""``=`` before a name: one element, glob signs included (S7); and what is said of globs that mean more (S11, S12)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import BY_GLOBS
from rosprivacy.ingest.labels.binding import bind
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_template import template
from rosprivacy.ingest.mitigation.limits_file import read_limits
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.result import Result

# An administrator's shell that may read and write everything, beside a camera, an uplink and a map.
PROFILES = {
    "camera": ("image", ""),
    "root": ("*", "*"),
    "relay": ("copy", "image"),
    "uplink": ("", "copy"),
}
ENDS = "nodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n"


def policy(profiles: dict[str, tuple[str, str]] = PROFILES) -> str:
    text = ""
    for node, (writes, reads) in profiles.items():
        topics = "".join(
            f'<topics {role}="ALLOW"><topic>{name}</topic></topics>'
            for role, name in (("publish", writes), ("subscribe", reads))
            if name
        )
        text += f'<profile ns="/" node="{node}">{topics}</profile>'
    return (
        f'<policy version="0.2.0"><enclaves><enclave path="/"><profiles>{text}</profiles></enclave></enclaves></policy>'
    )


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.xml").write_text(policy())
    return tmp_path


def analyze(labels: str, **options: Any) -> Result:
    with open("l.yaml", "w", encoding="utf-8") as file:  # noqa: PTH123 - in the folder of the test
        file.write(f"labels: 1\n{labels}")
    return rosprivacy.analyze("p.xml", "l.yaml", **options)


def said_of(result: Result) -> set[tuple[str, str]]:
    """(kind, name) of all that a user's labels speak of."""
    elements, bound = result.analysis.graph.elements, result.bound.elements
    return {elements[v].identity[1:] for v, said in bound.items() if any(s.place.file == "l.yaml" for s in said)}


@pytest.mark.parametrize(
    ("labels", "expected"),
    [
        ('topics: {"=/*": sensitive}', {("topic", "/*")}),
        ('channels: {"=/*": mundane}', {("topic", "/*")}),
        ('topics: {"/*": sensitive}', {("topic", "/*"), ("topic", "/image"), ("topic", "/copy")}),
        ('topics: {"=/image": sensitive}', {("topic", "/image")}),
        ('nodes: {"=/camera": conduit}', {("node", "/camera")}),
    ],
)
@pytest.mark.usefixtures("robot")
def test_a_key_with_an_equals_sign_means_one_element(labels: str, expected: set[tuple[str, str]]) -> None:
    assert said_of(analyze(labels)) == expected


@pytest.mark.usefixtures("robot")
def test_it_ranks_as_a_full_name(tmp_path: Path) -> None:
    result = analyze(f'{ENDS}topics:\n  "=/*": sensitive\n  "/*": {{never: [Video]}}\n')
    held = {e.name: said for e, said in result.analysis.roles.items() if e.is_channel and e.name == "/*"}
    assert held == {"/*": {"Video": ("sensitive",)}}
    (tmp_path / "twice.yaml").write_text('labels: 1\ntopics: {"=/image": mundane}\n')
    with pytest.raises(InputErrors, match=r"keep one of them|more specific"):
        rosprivacy.analyze("p.xml", ["l.yaml", "twice.yaml", name_of(tmp_path, "topics: {/image: sensitive}")])


def name_of(folder: Path, labels: str) -> str:
    (folder / "more.yaml").write_text(f"labels: 1\n{labels}\n")
    return str(folder / "more.yaml")


@pytest.mark.parametrize(
    ("section", "name", "near"),
    [("topics", "=/imag", "/image"), ("nodes", "=/*", "there is a topic of that name"), ("topics", "=/im*", "=/*")],
)
@pytest.mark.usefixtures("robot")
def test_one_that_is_not_there_is_an_error_with_the_nearest(section: str, name: str, near: str) -> None:
    with pytest.raises(InputErrors, match="matches no") as caught:
        analyze(f'{section}: {{"{name}": {"sensitive" if section == "topics" else "conduit"}}}')
    assert near in str(caught.value) or near == "=/*"


@pytest.mark.usefixtures("robot")
def test_it_stands_in_flows_in_the_channels_of_a_source_and_in_between() -> None:
    """The design, 'The label file': it stands wherever a name does."""
    labels = (
        'nodes:\n  /root: {source: {Video: ["=/*"]}}\n'
        "elements:\n  frames: {kind: shared-memory, between: [=/camera, =/uplink]}\n  disk: {kind: storage}\n"
        'flows:\n  - {from: "=/camera", to: disk}\n  - {from: /root, to: "=/*", never: [Voice]}\n'
        '  - {from: {topic: "=/*"}, to: /root, never: [Voice]}\n'
    )
    result = analyze(labels)
    graph = result.analysis.graph
    through = {graph.elements[graph.flows[i].target].name for flows in result.bound.through.values() for i in flows}
    assert through == {"/*"}
    stated = {(graph.elements[f.source].name, graph.elements[f.target].name) for f in graph.flows if f.role == "flow"}
    assert ("/camera", "disk") in stated
    assert {("/camera", "frames"), ("frames", "/uplink")} <= stated
    restricted = {(graph.elements[graph.flows[i].source].name, graph.elements[graph.flows[i].target].name)
                  for i in result.bound.flows}  # fmt: skip
    assert restricted == {("/root", "/*"), ("/*", "/root")}


@pytest.mark.usefixtures("robot")
def test_it_stands_in_entries_that_are_replaced_decisions_limits_and_the_question_why_not(tmp_path: Path) -> None:
    result = analyze(f'{ENDS}topics: {{"=/*": mundane}}\n')
    assert len(result.findings) == 1  # past the shell
    assert len(said_of(result.with_entry("topics", "=/*", None))) == 2
    limits = tmp_path / "limits.yaml"
    limits.write_text('limits: 1\nplaces:\n  - {at: "=/*", never: all}\n')
    (rule,) = read_limits(str(limits), result.analysis.graph).rules
    assert {result.analysis.graph.elements[v].name for v in rule.vertices} == {"/*"}
    decisions = tmp_path / "d.yaml"
    decisions.write_text(
        "decisions: 1\nfindings:\n"
        "- {source: =/camera, leak: =/uplink, decision: accept, reason: r, owner: o, legal_basis: 6(1)(f)}\n"
    )
    assert analyze(ENDS, decisions=str(decisions)).analysis.findings[0].accepted
    assert result.why_not("=/camera", "=/uplink")


def test_it_stands_in_fleet_files_after_the_robot(robot: Path) -> None:
    (robot / "f.yaml").write_text(
        "fleet: 1\nrobots:\n  r1: {policies: p.xml}\n  r2: {policies: p.xml}\n"
        'elements: {cloud: {kind: external-system, country: DE}}\nflows:\n  - {from: "r1:=/*", to: cloud}\n'
    )
    graph = rosprivacy.analyze_fleet("f.yaml").analysis.graph
    ends = {graph.elements[f.source].identity for f in graph.flows if f.role == "flow"}
    assert ends == {("r1", "topic", "/*")}


# ---------------------------------------------------------------- globs that mean more than they seem to


@pytest.mark.usefixtures("robot")
def test_filling_in_a_wildcards_line_closes_that_wildcard_only() -> None:
    """'/*': mundane, as an older template offered it, turned a leak into 'nothing found'."""
    assert analyze(f'{ENDS}channels: {{"=/*": mundane}}\n').analysis.verdict == "leak"


@pytest.mark.usefixtures("robot")
def test_the_bare_line_of_an_older_template_is_answered_with_what_to_write() -> None:
    result = analyze(f'{ENDS}channels: {{"/*": mundane}}\n')
    (warning,) = [d for d in result.diagnostics if d.code == "glob-like-a-wildcard"]
    assert (str(warning.place), warning.severity) == ("l.yaml:5", "warning")
    assert "2 more elements" in warning.message
    assert 'write "=/*"' in warning.message
    for other in (  # the file tells them apart; and the line as the template had it, not filled in
        'topics: {"/*": sensitive, "=/*": mundane}',
        'channels: {"/*": }',
    ):
        assert not [d for d in analyze(f"{ENDS}{other}\n").diagnostics if d.code == "glob-like-a-wildcard"]


def globs(labels: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = analyze(labels).document()["assumptions"]["globs"]
    return rows


@pytest.mark.usefixtures("robot")
def test_each_glob_says_what_it_decides_and_closes() -> None:
    (row,) = globs(f'{ENDS}topics: {{"/im*": mundane}}\n')
    assert (row["file"], row["line"], row["says"]) == ("l.yaml", 5, ["mundane"])
    assert (row["elements"], row["closed"], row["reviewed"]) == (1, 1, 0)
    assert row["leak"]["name"] == "/uplink"
    (row,) = globs(f'{ENDS}topics: {{"/i*": sensitive, /image: sensitive}}\n')
    assert (row["elements"], row["closed"], row["reviewed"], row["warning"]) == (1, 0, 0, "")
    assert globs(f"{ENDS}topics: {{/image: mundane}}\n") == []  # no glob


@pytest.mark.parametrize(
    ("labels", "warning", "doubted"),
    [
        ('channels: {"/*": mundane}', "last-path", {"/image"}),  # the verdict hangs on it
        (
            'channels: {"/*": sensitive}\nnodes:\n  /camera: {source: [Video], leak: none}\n  "*": conduit',
            "last-path",
            {"/*", "/copy", "/image", "/relay", "/root", "/uplink"},
        ),
        # channels are open
        ('nodes:\n  /camera: {source: [Video]}\n  "/[!c]*": conduit', "", {"/relay", "/root", "/uplink"}),
        ('nodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n  "/rel*": conduit', "", {"/relay"}),
        ('nodes:\n  /camera: {source: [Video]}\n  "/r*": {sanitizer: {Video: drop}}', "", {"/relay", "/root"}),
        ('topics: {"/*": sensitive}', "", {"/*", "/copy", "/image"}),  # it closes nothing
    ],
)
@pytest.mark.usefixtures("robot")
def test_what_only_a_glob_answers_for_is_in_doubt_and_the_last_path_a_warning(
    labels: str, warning: str, doubted: set[str]
) -> None:
    result = analyze(labels if "nodes" in labels else f"{ENDS}{labels}")
    assert {doubt.element.name for doubt in result.doubts if doubt.name == BY_GLOBS and doubt.element} == doubted
    rows = result.document()["assumptions"]["globs"]
    assert warning in {row["warning"] for row in rows}
    assert ("   warning: the glob at l.yaml:" in result.to("text").partition("\nAssumed\n")[2]) == bool(warning)


def test_a_line_about_flows_with_a_glob_says_what_it_decides_and_closes(robot: Path) -> None:
    three = {name: PROFILES[name] for name in ("camera", "relay", "uplink")}
    (robot / "p.xml").write_text(policy(three))
    labels = f'{ENDS}  /relay: conduit\nflows:\n  - {{from: "/im*", to: "*", never: [Video]}}\n'
    (row,) = globs(labels)
    assert (row["line"], row["says"], row["elements"], row["closed"]) == (7, ["never"], 0, 0)
    assert (row["flows"], row["flows_closed"], row["leak"]["name"], row["warning"]) == (1, 1, "/uplink", "")
    assert "\nGlobs of label files: 1\n   the glob at l.yaml:7 (never)" in analyze(labels).to("text", verbose=True)
    reviewed = labels.replace("/relay: conduit", "/relay: conduit\nchannels: {/image: sensitive}")
    (row,) = globs(reviewed)
    assert row["warning"] == "last-path"  # nothing else is open
    assert globs(labels.replace("/im*", "/image").replace('"*"', "/relay")) == []  # no glob
    (row,) = globs(f"{labels}  - {{from: /image, to: /relay, only: [Video]}}\n")
    assert (row["flows"], row["flows_closed"], row["leak"], row["warning"]) == (0, 0, None, "")  # a name outranks it
    (robot / "p.xml").write_text(policy({**three, "logger": ("", "image")}))
    (row,) = globs(labels)
    assert (row["flows"], row["flows_closed"], row["warning"]) == (2, 2, "")


# ---------------------------------------------------------------- every line that is offered


def says_of(graph: FlowGraph, section: str, name: str) -> set[tuple[str, str]]:
    """(kind, name) of the elements that a line changes, if a person writes a label there."""
    word = "conduit" if section in ("nodes", "elements") else "sensitive"
    labels = parse_labels(json.dumps({"labels": 1, section: {name: word}}), load(), name="line")
    return {graph.elements[vertex].identity[1:] for vertex in bind(graph, [labels]).elements}


def check(graph: FlowGraph, offered: Iterable[tuple[str, str, str, str]]) -> int:
    count = 0
    for section, written, kind, name in offered:
        count += 1
        assert says_of(graph, section, written) == {(kind, name)}
    return count


def offered_by_the_template(graph: FlowGraph) -> list[tuple[str, str, str, str]]:
    entries = parse_labels(template(graph), load(), name="template").entries
    kinds = {"node": "nodes", "topic": "topics", "service": "services", "action": "actions"}
    return [(kinds[e.kinds[0]], e.name, e.kinds[0], e.name.removeprefix("=")) for e in entries]


def offered_by_the_review_list(file: str, graph: FlowGraph) -> set[tuple[str, str, str, str]]:
    """With a source at every node, so that every channel is open; and with one only, so that nodes are."""
    nodes = [e.name for e in graph.elements if e.is_node]
    found = set()
    for sources in (nodes, nodes[:1], nodes[-1:]):
        labels = {"labels": 1, "nodes": {f"={name}": {"source": ["Video"]} for name in sources}}
        document = rosprivacy.analyze([file], parse_labels(labels, load(), name="l")).document()
        found |= {
            (q["label"]["section"], q["label"]["name"], q["element"]["kind"], q["element"]["name"])
            for q in document["open"]
        }
    return found


def test_a_line_of_the_template_or_the_review_list_changes_its_element_and_no_other(robot: Path) -> None:
    graph = build([read_policy(str(robot / "p.xml"))], "declared")
    assert check(graph, offered_by_the_template(graph)) == 7
    assert check(graph, offered_by_the_review_list(str(robot / "p.xml"), graph)) >= 3


@pytest.mark.slow
@pytest.mark.corpus
def test_a_line_that_is_offered_changes_its_element_and_no_other_in_real_policies(corpus: Path) -> None:
    wildcards = 0
    for file in sorted((corpus / "policies").rglob("*.xml")):
        try:
            graph = build([read_policy(str(file))], "declared")
        except InputErrors:
            continue
        lines = {*offered_by_the_template(graph), *offered_by_the_review_list(str(file), graph)}
        check(graph, lines)
        wildcards += sum(written.startswith("=") for _, written, _, _ in lines)
    assert wildcards >= 7  # else the test could not fail
