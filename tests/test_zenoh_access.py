"""Zenoh files in place of a policy: what each process may send and receive is a flow, and doubts are told (S5, S11)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.ingest.deployed.zenoh_grants import read_zenoh
from tests.helpers.command import cli

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"


def rule(name: str, permission: str, message: str, flow: str, *keys: str) -> dict[str, Any]:
    return {"id": name, "permission": permission, "messages": [message], "flows": [flow], "key_exprs": [*keys]}


def put(
    file: Path, *rules: dict[str, Any], default: str = "deny", subject: dict[str, Any] | None = None, **more: Any
) -> Path:
    ids = [one["id"] for one in rules]
    section = {
        "enabled": True,
        "default_permission": default,
        "rules": rules,
        "subjects": [{"id": "s", **(subject or {})}],
        "policies": [{"rules": ids, "subjects": ["s"]}],
        **more,
    }
    file.write_text(f"{{ // Zenoh\n access_control: {json.dumps(section)} }}", "utf-8")
    return file


def answered(cli: Cli, folder: Path, *arguments: str | Path) -> tuple[int, list[list[str]], list[str]]:
    """The exit code, the way of each finding, and what was said."""
    (folder / "labels.yaml").write_text(LABELS, "utf-8")
    done = cli("analyze", *arguments, "-l", folder / "labels.yaml", "--format", "json")
    assert done.returncode in (0, 1, 4), done.stderr
    document = json.loads(done.stdout)
    ways = [[step["name"] for step in finding["witness"]] for finding in document["findings"]]
    return done.returncode, ways, [one["message"] for one in document["diagnostics"]]


SENDS = rule("out", "allow", "put", "egress", "0/video/*/*")


def takes(*keys: str) -> dict[str, Any]:
    return rule("in", "allow", "put", "ingress", *keys)


def denies(key: str) -> dict[str, Any]:
    return rule("no", "deny", "put", "ingress", key)


@pytest.mark.parametrize(
    ("sent", "receiver", "through"),
    [
        ("0/video/*/*", [takes("0/video/*/*")], True),
        ("0/video/*/*", [takes("0/other/*/*")], False),
        ("0/video/*/*", [rule("in", "allow", "put", "egress", "0/video/*/*")], False),
        ("0/video/*/*", [takes("**")], True),
        ("0/video/*/*", [takes("**"), denies("0/video/**")], False),
        ("0/video/*/*", [takes("**"), denies("0/video/T/*")], True),
        ("0/video/*/*", [takes("1/video/*/*"), rule("o", "allow", "put", "egress", "1/x/*/*")], False),
        ("0/video/*/*", [takes("0/vid$*/*/*")], True),
        ("0/video/raw/*/*", [takes("0/video/**")], True),  # the old form, before rmw_zenoh 0.1.6: names below too
        ("0/video/raw/*/*", [takes("0/video/*/*")], False),
    ],
)
def test_what_passes_is_a_flow(
    cli: Cli, tmp_path: Path, sent: str, receiver: list[dict[str, Any]], *, through: bool
) -> None:
    sender = put(tmp_path / "camera.json5", rule("out", "allow", "put", "egress", sent))
    files = sender, put(tmp_path / "uplink.json5", *receiver)
    _, ways, _ = answered(cli, tmp_path, *files, "--domain", "0")
    assert ([way for way in ways if way[0] == "/camera" and way[-1] == "/uplink"] != []) == through


def test_queries_and_replies_are_legs_of_a_service(cli: Cli, tmp_path: Path) -> None:
    key = "0/ask/*/*"
    client = put(tmp_path / "camera.json5", rule("q", "allow", "query", "egress", key))
    server = put(tmp_path / "uplink.json5", rule("q", "allow", "query", "ingress", key))
    assert answered(cli, tmp_path, client, server)[:2] == (1, [["/camera", "/ask", "/uplink"]])
    silent = put(tmp_path / "uplink.json5", rule("r", "allow", "reply", "egress", key))
    assert not answered(cli, tmp_path, client, silent)[1]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"enabled": False}, "access control is not enabled"),
        ({"default": "allow"}, "default_permission is allow"),
    ],
)
def test_what_is_open_is_granted_and_told(cli: Cli, tmp_path: Path, more: dict[str, Any], said: str) -> None:
    sender = put(tmp_path / "camera.json5", SENDS)
    receiver = put(tmp_path / "uplink.json5", rule("x", "allow", "put", "ingress", "0/other/*/*"), **more)
    code, ways, told = answered(cli, tmp_path, sender, receiver)
    assert code == 1
    assert ways
    assert [one for one in told if one.startswith(said)]


def test_a_deny_that_does_not_hold_for_everybody_takes_nothing_away(cli: Cli, tmp_path: Path) -> None:
    sender = put(tmp_path / "camera.json5", SENDS)
    subjects = [{"id": "s"}, {"id": "t", "usernames": ["ann"]}]
    rules = [takes("0/video/*/*"), denies("0/video/*/*")]
    policies = [{"rules": ["in"], "subjects": ["t"]}, {"rules": ["no"], "subjects": ["s"]}]
    receiver = put(tmp_path / "uplink.json5", *rules, subjects=subjects, policies=policies)
    code, ways, told = answered(cli, tmp_path, sender, receiver)
    assert (code, bool(ways)) == (1, True)
    assert [one for one in told if one.endswith("it does not hold for everybody")]


def test_a_file_for_another_domain_grants_nothing_and_that_is_told(cli: Cli, tmp_path: Path) -> None:
    sender = put(tmp_path / "camera.json5", SENDS)
    _, ways, told = answered(cli, tmp_path, sender, put(tmp_path / "uplink.json5", SENDS), "--domain", "3")
    assert not ways
    assert "nothing is granted in domain 3: the process can send and receive no data" in told


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (("0/video/*/*", "1/video/*/*"), "keys of domain 0 and of domain 1; say which with --domain N"),
        (("0//video",), "key expression '0//video': an empty chunk"),
    ],
)
def test_a_problem_is_told_at_its_line(cli: Cli, tmp_path: Path, keys: tuple[str, ...], said: str) -> None:
    file = put(tmp_path / "camera.json5", rule("out", "allow", "put", "egress", *keys))
    done = cli("analyze", file)
    assert done.returncode == 2
    assert f"{file}:2: {said}" in done.stderr


TAKES = takes("0/commands/*/*")
ANY_SESSION = [["/camera", "/commands", "/uplink"], ["/camera", "/video", "/uplink"]]


def added(cli: Cli, folder: Path, *files: Path) -> list[list[str]]:
    """The ways that only the enforced view has."""
    _, declared, _ = answered(cli, folder, *files)
    _, enforced, _ = answered(cli, folder, *files, "--view", "enforced")
    assert all(way in enforced for way in declared)
    return [way for way in enforced if way not in declared]


def test_a_list_that_tells_nobody_apart_leaves_not_known_who_sends(cli: Cli, tmp_path: Path) -> None:
    """Nobody has to load the list of another process: no leak is found, and that is undetermined (S6, S11)."""
    sender = put(tmp_path / "camera.json5", SENDS)
    receiver = put(tmp_path / "uplink.json5", TAKES)
    code, ways, told = answered(cli, tmp_path, sender, receiver)
    assert (code, ways) == (4, [])
    assert [one for one in told if one.startswith("any session may send 1 name that this list lets in: ")]
    (way,) = added(cli, tmp_path, sender, receiver)  # it sends what one list lets in, and gets what another lets out
    assert way in ANY_SESSION


def test_a_single_process_gets_nothing_from_others(tmp_path: Path) -> None:
    """The enforced view is about processes that are known."""
    one, other = str(put(tmp_path / "camera.json5", SENDS)), str(put(tmp_path / "uplink.json5", TAKES))
    assert [len(read_zenoh(files, None, view="enforced")) for files in ([one], [one, other])] == [1, 3]


@pytest.mark.parametrize(
    ("who", "through", "said"),
    [
        ({"cert_common_names": ["camera"]}, True, ""),
        ({"cert_common_names": ["planner"]}, False, ""),
        ({"usernames": ["planner"]}, False, ""),
        ({"usernames": ["camera", "planner"]}, True, ""),
        (
            {"cert_common_names": ["operator"]},
            True,
            "whoever is operator, after whom no file is named, may send 1 name",
        ),
        ({"interfaces": ["lo"]}, True, "any session may send 1 name"),
        ({"zids": ["38a4829bce9166ee"]}, True, "any session may send 1 name"),
    ],
)
def test_who_has_a_name_of_its_own_is_told_apart(
    cli: Cli, tmp_path: Path, who: dict[str, Any], said: str, *, through: bool
) -> None:
    """A certificate or a user name; interfaces, protocols and ids of sessions prove nothing (S6)."""
    camera = put(tmp_path / "camera.json5", SENDS, subject={"cert_common_names": ["planner"]})
    planner = put(tmp_path / "planner.json5", rule("x", "allow", "declare_subscriber", "egress", "0/video/*/*"))
    receiver = put(tmp_path / "uplink.json5", TAKES, subject=who)
    ways = added(cli, tmp_path, camera, planner, receiver)
    assert (ANY_SESSION[0] in ways) == through
    assert ANY_SESSION[1] not in ways
    _, _, told = answered(cli, tmp_path, camera, planner, receiver)
    assert [one.startswith(said) for one in told if " may send " in one] == [True] * bool(said)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"enabled": False}, "any session may send this process all that no deny names"),
        ({"default": "allow"}, "any session may send this process all that no deny names"),
        ({"policies": []}, ""),
    ],
)
def test_a_router_without_access_control_lets_any_session_do_everything(
    cli: Cli, tmp_path: Path, more: dict[str, Any], said: str
) -> None:
    """With no policy at all the default holds for everybody (S6)."""
    named = {"cert_common_names": ["router"]}
    camera = put(tmp_path / "camera.json5", rule("out", "allow", "put", "egress", "0/mine/*/*"), subject=named)
    uplink = put(tmp_path / "uplink.json5", takes("0/other/*/*"), subject=named)
    router = put(tmp_path / "router.json5", TAKES, **more)
    _, ways, told = answered(cli, tmp_path, camera, uplink, router, "--view", "enforced")
    assert bool(said) == any("/router" not in way for way in ways)
    assert bool(said) == any(one.startswith(said) for one in told if said)


def test_denies_for_everybody_hold_for_any_session(cli: Cli, tmp_path: Path) -> None:
    denied = denies("0/commands/*/*")
    camera = put(tmp_path / "camera.json5", SENDS, subject={"usernames": ["camera"]})
    everything = takes("0/commands/*/*", "0/status/*/*")
    ways = added(cli, tmp_path, camera, put(tmp_path / "uplink.json5", everything, denied))
    assert ways == [["/camera", "/status", "/uplink"]]


def test_both_views_name_the_sessions_that_are_not_told_apart(cli: Cli, tmp_path: Path) -> None:
    files = put(tmp_path / "camera.json5", SENDS), put(tmp_path / "uplink.json5", TAKES)
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    done = cli("analyze", *files, "-l", tmp_path / "labels.yaml", "--view", "both", "--format", "json")
    (entry,) = json.loads(done.stdout)["enforced"]["added"]
    assert entry["enclaves"] == entry["split"] == ["zenoh:any-session"]


def test_no_deny_of_a_profile_and_no_move_of_one_process_is_told_of_access_lists(cli: Cli, tmp_path: Path) -> None:
    """Neither can be written there; who has a certificate is still let in where everybody is (S6)."""
    sends = rule("out", "allow", "put", "egress", "0/other/*/*")
    hears = takes("0/video/*/*", "0/log/*/*")
    logger = rule("out", "allow", "put", "egress", "0/log/*/*"), takes("0/video/*/*")
    files = [put(tmp_path / "camera.json5", sends), put(tmp_path / "uplink.json5", hears)]
    files.append(put(tmp_path / "logger.json5", *logger))
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    done = cli("analyze", *files, "-l", tmp_path / "labels.yaml", "--view", "both", "--format", "json")
    (entry,) = json.loads(done.stdout)["enforced"]["added"]
    assert (entry["split"], entry["move"], entry["deny"]) == (["zenoh:any-session"], None, [])


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
    graph = tmp_path / "graph.json"
    code, ways, told = answered(cli, tmp_path, *files, "--view", view, "--save-graph", graph)
    assert answered(cli, tmp_path, "--add", graph, "--view", view) == (code, ways, told)
    assert [one for one in told if one.startswith("any session may")]


def test_a_deny_of_put_does_not_stop_late_joiners(cli: Cli, tmp_path: Path) -> None:
    """As measured: what was put comes as a reply (S5, S11)."""
    for messages, through in ((["put"], True), (["put", "reply"], False)):
        denied = {**rule("no", "deny", "put", "egress", "0/video/**"), "messages": messages}
        sender = put(tmp_path / "camera.json5", denied, default="allow")
        receiver = put(tmp_path / "uplink.json5", takes("0/video/*/*"))
        _, ways, told = answered(cli, tmp_path, sender, receiver)
        assert bool(ways) == through
        assert any("late joiners get the messages by reply all the same" in one for one in told) == through


def test_a_session_with_a_namespace_is_heard_by_one_that_names_it(cli: Cli, tmp_path: Path) -> None:
    """Its keys begin with the namespace, and the name of the channel does not (S1)."""
    sender = put(tmp_path / "camera.json5", rule("out", "allow", "put", "egress", "robot/0/video/*/*"))
    sender.write_text(
        sender.read_text("utf-8").replace("{ // Zenoh", "{ namespace: 'robot', // of this robot"), "utf-8"
    )
    apart = "keys behind namespaces '', 'robot': Zenoh keeps them apart, here a name is one channel in all of them"
    for key, through, is_told in (("robot/**", True, False), ("robot/0/x/*/*", False, False), ("0/x/*/*", False, True)):
        receiver = put(tmp_path / "uplink.json5", takes(key))
        _, ways, told = answered(cli, tmp_path, sender, receiver)
        assert (bool(ways), apart in told) == (through, is_told)


def test_two_lists_of_one_name_are_a_gap(cli: Cli, tmp_path: Path) -> None:
    """The files of two computers: a flow from one process to the other would come back to where it began (S11)."""
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
    name = {"cert_common_names": ["camera"]}
    both = [SENDS, takes("0/video/*/*")]
    other = takes("0/other/*/*")
    files = [put(tmp_path / folder / "camera.json5", *both, subject=name) for folder in ("a", "b")]
    uplink = put(tmp_path / "uplink.json5", other, subject={"cert_common_names": ["uplink"]})
    assert answered(cli, tmp_path, *files, uplink)[0] == 4
    gaps = [one for policy in read_zenoh(map(str, (*files, uplink)), 0) for one in policy.diagnostics if one.code]
    assert [(one.code, one.place.file) for one in gaps] == [(ACCESS_GAP, str(files[1]))]
