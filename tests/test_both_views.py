"""The declared answer of record, and what the enforced view adds to it (rule S6)."""

from __future__ import annotations

import json
from fnmatch import fnmatch
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import jsonschema
import networkx as nx
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.both_views import TRIED, both_views
from rosprivacy.settings import Settings
from tests.helpers.command import cli
from tests.helpers.paths import ROOT
from tests.helpers.sarif import checked
from tests.helpers.shared_enclaves import EXAMPLE, EXAMPLE_LABELS, FLEET, THREE, Enclaves, apart, policy
from tests.helpers.word import text_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tests.helpers.command import Cli

__all__ = ["cli"]

NODES = ("/a", "/b", "/c", "/d")
TOPICS = ("/s", "/t", "/u", "/*")
RIGHTS = [
    (role, topic, rule) for role in ("publish", "subscribe") for topic in TOPICS for rule in ("ALLOW", "ALLOW", "DENY")
]
LABELS = (
    "{source: [Video]}", "{leak: [Video]}", "{sanitizer: {Video: anonymise}}", "conduit",
    "{source: [Voice], leak: [Video]}", "{sanitizer: {Video: pseudonymise}}",
)  # fmt: skip

systems = st.tuples(
    st.lists(
        st.tuples(st.sampled_from(("/e", "/f")), st.lists(st.sampled_from(RIGHTS), min_size=1, max_size=3)),
        min_size=len(NODES), max_size=len(NODES),
    ),
    st.lists(st.sampled_from(LABELS), min_size=len(NODES), max_size=len(NODES)),
)  # fmt: skip


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


def moved(enclaves: Enclaves, move: Mapping[str, str]) -> Enclaves:
    """The same for one profile only, which leaves a copy of its DENYs behind."""
    found = {path: dict(profiles) for path, profiles in enclaves.items()}
    profiles = found[move["enclave"]]
    denied = [right for rights in profiles.values() for right in rights if right[2] == "DENY"]
    gone = profiles.pop(move["profile"])
    found["/moved"] = {move["profile"]: [*gone, *denied]}
    left = next(iter(profiles))
    profiles[left] = [*profiles[left], *(right for right in gone if right[2] == "DENY")]
    return found


def with_denials(enclaves: Enclaves, lines: list[dict[str, Any]]) -> Enclaves:
    """The policy with these lines in the profiles that they name."""
    found = {path: dict(profiles) for path, profiles in enclaves.items()}
    for line in lines:
        profile = found[line["enclave"]]
        profile[line["profile"]] = [*profile[line["profile"]], (line["role"], line["channel"]["name"], "DENY")]
    return found


def may(enclaves: Enclaves) -> set[tuple[str, str, str]]:
    """What profiles allow with the topics that are named, by rule S5, looked up name by name."""
    topics = {topic for profiles in enclaves.values() for rights in profiles.values() for _, topic, _ in rights}
    found = set()
    for profiles in enclaves.values():
        denied = [(role, name) for rights in profiles.values() for role, name, rule in rights if rule == "DENY"]
        for node, rights in profiles.items():
            for role, name, rule in rights:
                for topic in topics - {"/*"} if rule == "ALLOW" else ():
                    out = any(of == role and fnmatch(topic, taken) for of, taken in denied)
                    found |= {(node, role, topic)} if fnmatch(topic, name) and not out else set()
    return found


def ids(text: str, view: View) -> dict[str, bool]:
    """The findings that stand, and whether only in pseudonymised form."""
    Path("q.xml").write_text(text)
    result = rosprivacy.analyze("q.xml", "l.yaml", view=view)
    return {finding.id: finding.pseudonymised for finding in result.analysis.findings if finding.stands}


def is_gone(entry: Mapping[str, Any], enclaves: Enclaves) -> bool:
    """Whether a policy has no longer what the enforced view adds: where that is plain data, a pseudonymised rest is."""
    left = ids(policy(enclaves), View.enforced).get(entry["finding"]["id"])
    return left is None or (left and "plain" in entry)


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
            result = both_views(("p.xml",), ("l.yaml",), Settings())
            enforced = result.document()["enforced"]
        except rosprivacy.InputErrors:
            assume(False)
            raise
        declared = {finding.id: finding.pseudonymised for finding in result.analysis.findings if finding.stands}
        added = {entry["finding"]["id"] for entry in enforced["added"]}
        whole = ids(policy(union(enclaves)), View.declared)
        assert declared.keys() <= whole.keys()
        assert added == {one for one in whole if one not in declared or (declared[one] and not whole[one])}
        for entry in enforced["added"]:
            assert entry["enclaves"]
            assert entry["split"]
            assert is_gone(entry, apart(enclaves, entry["split"]))
            if entry["move"]:
                assert is_gone(entry, moved(enclaves, entry["move"]))
            if entry["deny"]:
                after = with_denials(enclaves, entry["deny"])
                assert is_gone(entry, after)
                lost = {(one["node"]["name"], one["role"], one["channel"]["name"]) for one in entry["loses"]}
                assert {one for one in lost if one[2] != "/*"} == may(enclaves) - may(after)
            else:
                assert entry["loses"] == []


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
@pytest.mark.parametrize("more", [("-f", "turtle"), ("--per-policy",), ("-f", "cnil-pia"), ("-f", "article30")])
def test_formats_that_do_not_tell_it_are_refused(cli: Cli, more: tuple[str, ...]) -> None:
    done = cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both", *more)
    assert done.returncode == 2
    message = " ".join(done.stderr.replace("│", " ").split())  # it stands in a box
    assert "--view both writes text, json, json1, sarif, html, markdown, docx" in message


@pytest.mark.usefixtures("example")
def test_a_profile_that_is_moved_and_a_deny_are_remedies_of_their_own_the_deny_with_its_price(cli: Cli) -> None:
    Path("p.xml").write_text(policy(THREE))
    text = cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both").stdout
    assert "   gone, too, if only /blur is moved from /robot to an enclave of its own: proven" in text
    assert "   gone, too, with a DENY to publish /blurred in /robot (p.xml): proven by a new analysis" in text
    assert "what their own profiles allow: /blur publish /blurred\n" in text
    document = both_views(("p.xml",), ("l.yaml",), Settings()).document()  # whoever stays has no right of the blur
    [entry] = document["enforced"]["added"]
    assert entry["move"] == {"enclave": "/robot", "profile": "/blur"}
    assert [(line["enclave"], line["role"], line["channel"]["name"]) for line in entry["deny"]] == [
        ("/robot", "publish", "/blurred")
    ]
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(document)


@pytest.mark.usefixtures("example")
def test_of_a_fleet_each_pattern_has_the_robots_on_which_the_enforced_view_adds_it(cli: Cli) -> None:
    """Each robot by itself gives the same: one is split already, one has the finding under the declared view."""
    Path("apart.xml").write_text(policy(apart(EXAMPLE, ["/robot"])))
    open_camera = [*EXAMPLE["/robot"]["/camera"], ("publish", "/blurred", "ALLOW")]
    Path("open.xml").write_text(policy({**EXAMPLE, "/robot": {**EXAMPLE["/robot"], "/camera": open_camera}}))
    Path("f.yaml").write_text(FLEET)
    done = cli("analyze", "--fleet", "f.yaml", "--view", "both", "-f", "json")
    document = json.loads(done.stdout)
    alone = json.loads(cli("analyze", "--fleet", "f.yaml", "-f", "json").stdout)
    enforced = document.pop("enforced")
    assert document == alone
    [entry] = enforced["added"]
    robots = {name for group in document["fleet"]["alike"] for name in group["robots"]}
    models = {"apart": "apart.xml", "open": "open.xml"}
    added = {
        name for name in robots
        if both_views((models.get(name, "p.xml"),), ("l.yaml",), Settings()).document()["enforced"]["added"]
    }  # fmt: skip
    assert entry["robots"] == sorted(added) == sorted(robots - models.keys())
    assert (entry["enclaves"], entry["split"]) == (["/robot"], ["/robot"])
    text = cli("analyze", "--fleet", "f.yaml", "--view", "both").stdout
    assert f"   added on 2 of 4 robots: {', '.join(entry['robots'])}" in text


@pytest.mark.usefixtures("example")
def test_one_that_a_person_has_accepted_is_told_all_the_same_and_its_remedies_are_proven(cli: Cli) -> None:
    [entry] = both_views(("p.xml",), ("l.yaml",), Settings()).document()["enforced"]["added"]
    said = "decision: accept, reason: nobody else gets in, owner: Ada, legal_basis: [6(1)(f)], date: 2026-11-02"
    Path("d.yaml").write_text(f"decisions: 1\nfindings:\n  - {{id: {entry['finding']['id']}, {said}}}\n")
    arguments = ("analyze", "p.xml", "-l", "l.yaml", "--view", "both", "--decisions", "d.yaml")
    [accepted] = json.loads(cli(*arguments, "-f", "json").stdout)["enforced"]["added"]
    assert accepted["finding"]["accepted"]
    assert accepted["finding"]["decision"]["reason"] == "nobody else gets in"
    assert {key: accepted[key] for key in accepted if key != "finding"} == {
        key: entry[key] for key in entry if key != "finding"
    }
    assert "nobody else gets in" in cli(*arguments).stdout
    run = checked(json.loads(cli(*arguments, "-f", "sarif").stdout))
    assert [one["suppressions"][0]["status"] for one in run["results"] if one["ruleId"] == "beyond-profile"] == [
        "accepted"
    ]


@pytest.mark.usefixtures("example")
def test_plain_data_beside_what_the_declared_view_has_pseudonymised_is_added(cli: Cli) -> None:
    """S10: a finding is pseudonymised only if nothing plain arrives; of one id both views say another thing."""
    Path("l.yaml").write_text(EXAMPLE_LABELS.replace("anonymise", "pseudonymise"))
    document = both_views(("p.xml",), ("l.yaml",), Settings()).document()
    [declared] = document["findings"]
    [entry] = document["enforced"]["added"]
    assert entry["finding"]["id"] == declared["id"]
    assert (declared["pseudonymised"], entry["finding"]["pseudonymised"], entry["plain"]) == (True, False, True)
    assert (entry["enclaves"], entry["split"]) == (["/robot"], ["/robot"])
    Path("q.xml").write_text(policy(apart(EXAMPLE, ["/robot"])))
    [left] = rosprivacy.analyze("q.xml", "l.yaml", view=View.enforced).analysis.findings
    assert left.pseudonymised
    arguments = ("p.xml", "-l", "l.yaml", "--view", "both")
    assert "   the declared view has it, too, but pseudonymised only" in cli("analyze", *arguments).stdout
    assert "in pseudonymised form only. This is about the plain data." in cli("report", *arguments).stdout
    assert "but pseudonymised only" in cli("analyze", *arguments, "-f", "sarif").stdout
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(document)


@pytest.mark.usefixtures("example")
def test_what_only_the_enforced_view_leaves_open_is_counted_beside_no_finding(cli: Cli) -> None:
    """S11, S12: the declared view finds nothing and leaves nothing open; the other reaches a node nobody reviewed."""
    Path("l.yaml").write_text(EXAMPLE_LABELS.replace("/uplink: {leak: [Video]}", "/none: {leak: [Video]}"))
    enclaves = {**EXAMPLE, "/none": {"/none": [("subscribe", "/nothing", "ALLOW")]}}
    Path("p.xml").write_text(policy(enclaves))
    document = both_views(("p.xml",), ("l.yaml",), Settings()).document()
    assert (document["verdict"], document["enforced"]["verdict"]) == ("no-leak-found", "undetermined")
    assert (document["enforced"]["added"], document["enforced"]["unreviewed"]) == ([], 1)
    (left,) = document["enforced"]["open"]
    arguments = ("p.xml", "-l", "l.yaml", "--view", "both")
    expected = f"it also leaves 1 element open that nobody has reviewed ({left['name']})"
    assert expected in cli("analyze", *arguments).stdout
    assert f"1 element that nobody has reviewed for it ({left['name']})" in cli("report", *arguments).stdout


@pytest.mark.usefixtures("example")
def test_a_wildcard_of_another_enclave_that_fewer_denys_cut_is_beyond_the_own_one_of_that_name() -> None:
    """S5, S6: /camera may write all of /a* but /ab; in its other enclave somebody else may write /ab, too."""
    camera = [("publish", "/a*", "ALLOW"), ("publish", "/ab", "DENY")]
    other = {"/camera": [("subscribe", "/z", "ALLOW")], "/other": [("publish", "/a*", "ALLOW")]}
    enclaves = {"/e": {"/camera": camera}, "/f": other, "/g": {"/uplink": [("subscribe", "/ab", "ALLOW")]}}
    Path("p.xml").write_text(policy(enclaves))
    Path("l.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n")
    [entry] = both_views(("p.xml",), ("l.yaml",), Settings()).document()["enforced"]["added"]
    assert (entry["beyond"], entry["enclaves"], entry["split"]) == ([0], ["/f"], ["/f"])


@pytest.mark.usefixtures("example")
@pytest.mark.parametrize(
    ("kind", "name", "role", "parts"),
    [
        ("topic", "/c/_action/feedback", ("publish", "subscribe"), ["feedback", "status"]),
        ("service", "/c/_action/send_goal", ("request", "reply"), ["cancel_goal", "get_result", "send_goal"]),
    ],
)
def test_a_deny_of_parts_of_an_action_is_one_that_can_be_written(
    kind: str, name: str, role: tuple[str, str], parts: list[str]
) -> None:
    """S3: parts are folded into the action, of which no line says publish, subscribe, request or reply."""
    lines = {
        node: f'<{kind}s {does}="ALLOW"><{kind}>{name}</{kind}></{kind}s>'
        for node, does in zip("xl", role, strict=True)
    }
    profiles = {"/e": {"s": "", "x": lines["x"]}, "/g": {"l": lines["l"]}}

    def text(denied: str) -> str:
        found = ""
        for path, nodes in profiles.items():
            said = "".join(
                f'<profile ns="/" node="{n}">{own}{denied if n == "x" else ""}</profile>' for n, own in nodes.items()
            )
            found += f'<enclave path="{path}"><profiles>{said}</profiles></enclave>'
        return f'<policy version="0.2.0"><enclaves>{found}</enclaves></policy>'

    Path("p.xml").write_text(text(""))
    Path("l.yaml").write_text("labels: 1\nnodes: {/s: {source: [Video]}, /l: {leak: [Video]}}\n")
    [entry] = both_views(("p.xml",), ("l.yaml",), Settings()).document()["enforced"]["added"]
    deny = [(line["role"], line["channel"]["kind"], line["channel"]["name"]) for line in entry["deny"]]
    assert deny == [(role[0], kind, f"/c/_action/{part}") for part in parts]
    added = "".join(f'<{k}s {r}="DENY"><{k}>{n}</{k}></{k}s>' for r, k, n in deny)
    assert entry["finding"]["id"] not in ids(text(added), View.enforced)


@pytest.mark.usefixtures("example")
def test_what_only_the_type_of_a_channel_holds_back_is_not_told_as_beyond_a_profile(cli: Cli) -> None:
    """S15: limits of types hold in the declared view only, since no middleware enforces what a type is used for."""
    Path("p.xml").write_text(
        policy({"/e": {"/s": [("publish", "/b", "ALLOW")]}, "/l": {"/l": [("subscribe", "/b", "ALLOW")]}})
    )
    types = "channels: {/b: {types: [std_msgs/msg/Bool]}}"
    Path("l.yaml").write_text(f"labels: 1\nnodes: {{/s: {{source: [Video]}}, /l: {{leak: [Video]}}}}\n{types}\n")
    arguments = ("p.xml", "-l", "l.yaml", "--view", "both")
    assert "   no step goes beyond a profile: " in cli("analyze", *arguments).stdout
    assert "No step of it goes beyond a profile: " in cli("report", *arguments).stdout
    said = cli("analyze", *arguments, "-f", "sarif").stdout
    assert "Only if a channel carries what its type cannot hold: Video can get" in said
    assert "Only if a node goes beyond" not in said


@pytest.mark.usefixtures("example")
def test_where_no_more_is_tried_it_is_not_said_that_splitting_ends_nothing(cli: Cli) -> None:
    """Each finding has a pair of enclaves of its own; S11: what is not known is said."""
    enclaves: Enclaves = {}
    said = "labels: 1\nnodes:\n"
    for i in range(TRIED + 1):
        enclaves[f"/e{i}"] = {f"/s{i}": [], f"/x{i}": [("publish", f"/t{i}", "ALLOW")]}
        enclaves[f"/l{i}"] = {f"/l{i}": [("subscribe", f"/t{i}", "ALLOW")]}
        said += f"  /s{i}: {{source: [Video]}}\n  /l{i}: {{leak: [Video]}}\n"
    Path("p.xml").write_text(policy(enclaves))
    Path("l.yaml").write_text(said)
    arguments = ("p.xml", "-l", "l.yaml", "--view", "both")
    none = f"; for all findings together, {TRIED} sets are tried at most"
    assert cli("analyze", *arguments).stdout.count(none) == 1
    assert none in cli("report", *arguments).stdout


@pytest.mark.usefixtures("example")
def test_sarif_has_notes_of_a_rule_of_their_own_at_the_line_of_another_profile(cli: Cli) -> None:
    run = checked(json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "--view", "both", "-f", "sarif").stdout))
    [result] = [one for one in run["results"] if one["ruleId"] == "beyond-profile"]
    assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == "beyond-profile"
    assert (result["level"], run["properties"]["verdict"]) == ("note", "no-leak-found")
    line = result["locations"][0]["physicalLocation"]["region"]["startLine"]
    assert Path("p.xml").read_text().splitlines()[line - 1].count("/blurred") == 1
    assert (
        "Nodes share enclave /robot. Gone if /robot is split into an enclave for each node."
        in (result["message"]["text"])
    )


@pytest.mark.slow
@pytest.mark.usefixtures("example")
@pytest.mark.parametrize("form", ["html", "markdown", "docx"])
def test_a_report_has_a_section_of_it_in_each_language_and_only_where_it_was_asked(cli: Cli, form: str) -> None:
    Path("p.xml").write_text(policy(THREE))
    for language, heading, step in (
        ("en", "What nodes could do beyond their own profiles", "beyond its own profile"),
        ("de", "Was Knoten über ihr eigenes Profil hinaus könnten", "über das eigene Profil hinaus"),
        ("fr", "Ce que des nœuds pourraient faire au-delà de leur propre profil", "au-delà de son propre profil"),
    ):
        arguments = ("report", "p.xml", "-l", "l.yaml", "-f", form, "--lang", language)
        assert cli(*arguments, "--view", "both", "-o", "both.out").returncode == 0
        cli(*arguments, "-o", "alone.out")
        told, alone = (read(Path(name), form) for name in ("both.out", "alone.out"))
        assert heading in told
        assert heading not in alone
        marked = {"html": f"{step}</span>", "markdown": f"(**{step}**)", "docx": f"({step})"}
        assert told.count(marked[form]) == 1  # one step of its path
        assert (form == "html") == ('stroke="#cc79a7" stroke-width="3" stroke-dasharray' in told)
        for part in ("/robot", "/blur", "DENY", "p.xml:8"):
            assert part in told.split(heading)[-1]


@pytest.mark.usefixtures("example")
def test_a_redacted_report_has_no_name_of_it(cli: Cli) -> None:
    Path("p.xml").write_text(policy(THREE))
    for form in ("html", "markdown"):
        cli("report", "p.xml", "-l", "l.yaml", "-f", form, "--view", "both", "--redact", "-o", "r.out")
        text = Path("r.out").read_text("utf-8")
        assert not [name for name in ("/robot", "/blur", "/camera", "/navigator", "/uplink", "p.xml") if name in text]
        assert "proven by a new analysis" in text


def read(file: Path, form: str) -> str:
    return text_of(file.read_bytes()) if form == "docx" else file.read_text("utf-8").replace("\\", "")


@pytest.mark.usefixtures("example")
@pytest.mark.parametrize("show", ["ros", "privacy"])
def test_a_picture_draws_apart_what_no_profile_allows_on_the_paths_of_added_findings_only(cli: Cli, show: str) -> None:
    Path("p.xml").write_text(policy(THREE))
    arguments = ("graph", "p.xml", "-l", "l.yaml", "--show", show, "-f", "graphml")
    drawn, alone = (lines(cli(*arguments, *more).stdout) for more in (("--view", "both"), ()))
    beyond = {ends for ends, look in drawn.items() if look == "beyond"}
    assert beyond == {("/camera", "/blurred"), ("/video", "/navigator"), ("/navigator", "/blurred")}
    assert {ends: look for ends, look in drawn.items() if look not in ("beyond", "onward")} == alone
    onward = {("/blurred", "/uplink")} if show == "privacy" else set()  # no data gets there under the declared view
    assert {ends for ends, look in drawn.items() if look == "onward"} == onward
    enforced = lines(cli(*arguments, "--view", "enforced").stdout)
    assert ("/camera", "/scan") not in drawn  # what the middleware lets through besides is on no path of a finding
    assert ("/scan", "/blur") in enforced if show == "ros" else True
    dot = cli("graph", "p.xml", "-l", "l.yaml", "--show", show, "--view", "both").stdout
    assert 'label="beyond the node\'s own profile: only its enclave allows it"' in dot


@pytest.mark.usefixtures("example")
def test_the_picture_of_an_added_finding_is_that_of_the_enforced_view(cli: Cli) -> None:
    [entry] = both_views(("p.xml",), ("l.yaml",), Settings()).document()["enforced"]["added"]
    arguments = ("graph", "p.xml", "-l", "l.yaml", "--finding", entry["finding"]["id"], "-f", "graphml")
    assert cli(*arguments).returncode == 2
    drawn = lines(cli(*arguments, "--view", "both").stdout)
    assert drawn == {("/camera", "/blurred"): "beyond", ("/blurred", "/uplink"): "shortest"}


def lines(graphml: str) -> dict[tuple[str, str], str]:
    graph = nx.parse_graphml(graphml)
    names = nx.get_node_attributes(graph, "label")
    return {(names[source], names[target]): data["look"] for source, target, data in graph.edges(data=True)}
