"""Zenoh files in place of a policy: what each process may send and receive is a flow, and doubts are told (S5, S11).

Which messages an access list lets through is held by ``ingest/deployed``, by random lists.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.ingest.deployed.zenoh_grants import read_zenoh

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
BOTH = ("--view", "both", "--format", "json")


def rule(name: str, permission: str, message: str, flow: str, *keys: str) -> dict[str, Any]:
    return {"id": name, "permission": permission, "messages": [message], "flows": [flow], "key_exprs": [*keys]}


def sends(*keys: str) -> dict[str, Any]:
    return rule("out", "allow", "put", "egress", *keys)


def takes(*keys: str) -> dict[str, Any]:
    return rule("in", "allow", "put", "ingress", *keys)


def denies(key: str) -> dict[str, Any]:
    return rule("no", "deny", "put", "ingress", key)


def put(
    file: Path, *rules: dict[str, Any], default: str = "deny", subject: dict[str, Any] | None = None, **more: Any
) -> Path:
    """An access list with one subject, written to a file of that name."""
    section = {
        "enabled": True,
        "default_permission": default,
        "rules": rules,
        "subjects": [{"id": "s", **(subject or {})}],
        "policies": [{"rules": [one["id"] for one in rules], "subjects": ["s"]}],
        **more,
    }
    file.write_text(f"{{ // Zenoh\n access_control: {json.dumps(section)} }}", "utf-8")
    return file


def certificate(name: str) -> dict[str, Any]:
    return {"cert_common_names": [name]}


class Answer(NamedTuple):
    code: int
    ways: list[list[str]]  # of each finding
    messages: list[str]

    def begins(self, text: str) -> bool:
        return any(message.startswith(text) for message in self.messages)


def answered(cli: Cli, folder: Path, *arguments: str | Path) -> Answer:
    (folder / "labels.yaml").write_text(LABELS, "utf-8")
    done = cli("analyze", *arguments, "-l", folder / "labels.yaml", "--format", "json")
    assert done.returncode in (0, 1, 4), done.stderr
    document = json.loads(done.stdout)
    ways = [[step["name"] for step in finding["witness"]] for finding in document["findings"]]
    return Answer(done.returncode, ways, [one["message"] for one in document["diagnostics"]])


def only_enforced(cli: Cli, folder: Path, *files: Path) -> list[list[str]]:
    """The ways that only the enforced view has."""
    declared = answered(cli, folder, *files).ways
    enforced = answered(cli, folder, *files, "--view", "enforced").ways
    assert all(way in enforced for way in declared)
    return [way for way in enforced if way not in declared]


SENDS = sends("0/video/*/*")
TAKES = takes("0/commands/*/*")


@pytest.mark.parametrize(
    ("receiver", "through"),
    [
        ([takes("0/video/*/*")], True),
        ([takes("0/other/*/*")], False),
        ([sends("0/video/*/*")], False),
        ([takes("**"), denies("0/video/**")], False),
        ([takes("**"), denies("0/video/T/*")], True),
        ([takes("1/video/*/*"), sends("1/x/*/*")], False),
    ],
)
def test_what_passes_is_a_flow(cli: Cli, tmp_path: Path, receiver: list[dict[str, Any]], *, through: bool) -> None:
    files = put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", *receiver)
    ways = answered(cli, tmp_path, *files, "--domain", "0").ways
    assert any((way[0], way[-1]) == ("/camera", "/uplink") for way in ways) == through


def test_queries_and_replies_are_legs_of_a_service(cli: Cli, tmp_path: Path) -> None:
    key = "0/ask/*/*"
    client = put(tmp_path / "camera.json5", rule("q", "allow", "query", "egress", key))
    server = put(tmp_path / "uplink.json5", rule("q", "allow", "query", "ingress", key))
    assert answered(cli, tmp_path, client, server)[:2] == (1, [["/camera", "/ask", "/uplink"]])
    silent = put(tmp_path / "uplink.json5", rule("r", "allow", "reply", "egress", key))
    assert not answered(cli, tmp_path, client, silent).ways


FOR_ANN = {
    "subjects": [{"id": "s"}, {"id": "t", "usernames": ["ann"]}],
    "policies": [{"rules": ["in"], "subjects": ["t"]}, {"rules": ["no"], "subjects": ["s"]}],
}


@pytest.mark.parametrize(
    ("rules", "more", "message"),
    [
        ([takes("0/other/*/*")], {"enabled": False}, "access control is not enabled"),
        ([takes("0/other/*/*")], {"default": "allow"}, "default_permission is allow"),
        ([takes("0/video/*/*"), denies("0/video/*/*")], FOR_ANN, "it does not hold for everybody"),
    ],
    ids=["off", "allowed by default", "a deny that does not hold for everybody"],
)
def test_what_is_open_is_granted_and_told(
    cli: Cli, tmp_path: Path, rules: list[dict[str, Any]], more: dict[str, Any], message: str
) -> None:
    answer = answered(
        cli, tmp_path, put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", *rules, **more)
    )
    assert (answer.code, bool(answer.ways)) == (1, True)
    assert any(message in one for one in answer.messages)


def test_keys_of_another_domain_grant_nothing_and_those_of_two_need_a_domain(cli: Cli, tmp_path: Path) -> None:
    files = put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", SENDS)
    answer = answered(cli, tmp_path, *files, "--domain", "3")
    assert not answer.ways
    assert "nothing is granted in domain 3: the process can send and receive no data" in answer.messages
    both = put(tmp_path / "camera.json5", sends("0/video/*/*", "1/video/*/*"))
    done = cli("analyze", both)
    assert done.returncode == 2
    assert f"{both}:2: keys of domain 0 and of domain 1; say which with --domain N" in done.stderr


def test_a_list_that_tells_nobody_apart_leaves_not_known_who_sends(cli: Cli, tmp_path: Path) -> None:
    """Nobody has to load the list of another process: no leak is found, and that is undetermined (S6, S11)."""
    files = put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", TAKES)
    answer = answered(cli, tmp_path, *files)
    assert (answer.code, answer.ways) == (4, [])
    assert answer.begins("any session may send 1 name that this list lets in: ")
    (way,) = only_enforced(cli, tmp_path, *files)  # it sends what one list lets in, and gets what another lets out
    assert way in (["/camera", "/commands", "/uplink"], ["/camera", "/video", "/uplink"])
    one, other = map(str, files)  # the enforced view is about processes that are known
    assert [len(read_zenoh(names, None, view="enforced")) for names in ([one], [one, other])] == [1, 3]


@pytest.mark.parametrize(
    ("who", "through", "message"),
    [
        (certificate("camera"), True, ""),
        (certificate("planner"), False, ""),
        ({"usernames": ["planner"]}, False, ""),
        ({"usernames": ["camera", "planner"]}, True, ""),
        (certificate("operator"), True, "whoever is operator, after whom no file is named, may send 1 name"),
        ({"interfaces": ["lo"]}, True, "any session may send 1 name"),
        ({"zids": ["38a4829bce9166ee"]}, True, "any session may send 1 name"),
    ],
)
def test_who_has_a_name_of_its_own_is_told_apart(
    cli: Cli, tmp_path: Path, who: dict[str, Any], message: str, *, through: bool
) -> None:
    """A certificate or a user name; interfaces, protocols and ids of sessions prove nothing (S6)."""
    files = (
        put(tmp_path / "camera.json5", SENDS, subject=certificate("planner")),
        put(tmp_path / "planner.json5", rule("x", "allow", "declare_subscriber", "egress", "0/video/*/*")),
        put(tmp_path / "uplink.json5", TAKES, subject=who),
    )
    ways = only_enforced(cli, tmp_path, *files)
    assert (["/camera", "/commands", "/uplink"] in ways) == through
    assert ["/camera", "/video", "/uplink"] not in ways
    senders = [one for one in answered(cli, tmp_path, *files).messages if " may send " in one]
    assert [one.startswith(message) for one in senders] == [True] * bool(message)


@pytest.mark.parametrize(
    ("more", "is_open"), [({"enabled": False}, True), ({"default": "allow"}, True), ({"policies": []}, False)]
)
def test_a_router_without_access_control_lets_any_session_do_everything(
    cli: Cli, tmp_path: Path, more: dict[str, Any], *, is_open: bool
) -> None:
    """With no policy at all the default holds for everybody (S6)."""
    named = certificate("router")
    files = (
        put(tmp_path / "camera.json5", sends("0/mine/*/*"), subject=named),
        put(tmp_path / "uplink.json5", takes("0/other/*/*"), subject=named),
        put(tmp_path / "router.json5", TAKES, **more),
    )
    answer = answered(cli, tmp_path, *files, "--view", "enforced")
    assert any("/router" not in way for way in answer.ways) == is_open
    assert answer.begins("any session may send this process all that no deny names") == is_open


def test_denies_for_everybody_hold_for_any_session(cli: Cli, tmp_path: Path) -> None:
    camera = put(tmp_path / "camera.json5", SENDS, subject={"usernames": ["camera"]})
    uplink = put(tmp_path / "uplink.json5", takes("0/commands/*/*", "0/status/*/*"), denies("0/commands/*/*"))
    assert only_enforced(cli, tmp_path, camera, uplink) == [["/camera", "/status", "/uplink"]]


def test_both_views_propose_no_deny_and_no_move_of_access_lists(cli: Cli, tmp_path: Path) -> None:
    """Neither can be written there; who has a certificate is still let in where everybody is (S6)."""
    files = (
        put(tmp_path / "camera.json5", sends("0/other/*/*")),
        put(tmp_path / "uplink.json5", takes("0/video/*/*", "0/log/*/*")),
        put(tmp_path / "logger.json5", sends("0/log/*/*"), takes("0/video/*/*")),
    )
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    done = cli("analyze", *files, "-l", tmp_path / "labels.yaml", *BOTH)
    (entry,) = json.loads(done.stdout)["enforced"]["added"]
    assert entry["enclaves"] == entry["split"] == ["zenoh:any-session"]
    assert (entry["move"], entry["deny"]) == (None, [])


def test_check_says_who_is_let_in(cli: Cli, tmp_path: Path) -> None:
    policy = tmp_path / "robot.policy.xml"
    policy.write_text(
        '<policy version="0.2.0"><enclaves><enclave path="/"><profiles><profile ns="/" node="uplink">'
        '<topics subscribe="ALLOW"><topic>/commands</topic></topics></profile></profiles></enclave></enclaves></policy>'
    )
    done = cli("check", policy, put(tmp_path / "uplink.json5", TAKES))
    assert (done.returncode, "any session may send 1 name that this list lets in" in done.stdout) == (4, True)


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_a_saved_graph_says_the_same(cli: Cli, tmp_path: Path, view: str) -> None:
    """Who is let in is told by what it was saved from too."""
    files = put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", TAKES)
    answer = answered(cli, tmp_path, *files, "--view", view, "--save-graph", tmp_path / "graph.json")
    assert answered(cli, tmp_path, "--add", tmp_path / "graph.json", "--view", view) == answer
    assert answer.begins("any session may")


@pytest.mark.parametrize(("messages", "through"), [(["put"], True), (["put", "reply"], False)])
def test_a_deny_of_put_does_not_stop_late_joiners(
    cli: Cli, tmp_path: Path, messages: list[str], *, through: bool
) -> None:
    """As measured: what was put comes as a reply (S5, S11)."""
    denied = {**rule("no", "deny", "put", "egress", "0/video/**"), "messages": messages}
    sender = put(tmp_path / "camera.json5", denied, default="allow")
    answer = answered(cli, tmp_path, sender, put(tmp_path / "uplink.json5", takes("0/video/*/*")))
    assert bool(answer.ways) == through
    assert any("late joiners get the messages by reply all the same" in one for one in answer.messages) == through


@pytest.mark.parametrize(
    ("key", "through", "apart"), [("robot/**", True, False), ("robot/0/x/*/*", False, False), ("0/x/*/*", False, True)]
)
def test_a_session_with_a_namespace_is_heard_by_one_that_names_it(
    cli: Cli, tmp_path: Path, key: str, *, through: bool, apart: bool
) -> None:
    """Its keys begin with the namespace, and the name of the channel does not (S1)."""
    sender = put(tmp_path / "camera.json5", sends("robot/0/video/*/*"))
    sender.write_text(sender.read_text("utf-8").replace("{ // Zenoh", "{ namespace: 'robot', // Zenoh"), "utf-8")
    answer = answered(cli, tmp_path, sender, put(tmp_path / "uplink.json5", takes(key)))
    assert (bool(answer.ways), answer.begins("keys behind namespaces '', 'robot': ")) == (through, apart)


def test_two_lists_of_one_name_are_a_gap(cli: Cli, tmp_path: Path) -> None:
    """The files of two computers: a flow from one process to the other would come back to where it began (S11)."""
    files = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        folder.mkdir()
        files.append(put(folder / "camera.json5", SENDS, takes("0/video/*/*"), subject=certificate("camera")))
    files.append(put(tmp_path / "uplink.json5", takes("0/other/*/*"), subject=certificate("uplink")))
    assert answered(cli, tmp_path, *files).code == 4
    gaps = [one for policy in read_zenoh(map(str, files), 0) for one in policy.diagnostics if one.code]
    assert [(one.code, one.place.file) for one in gaps] == [(ACCESS_GAP, str(files[1]))]
