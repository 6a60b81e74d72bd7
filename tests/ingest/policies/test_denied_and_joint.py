"""What policies take away is stated, and told (rules S4, S5, S11): by the command, as a reader sees it.

The base: a camera that brings video in, a node that lets it out, a topic between them. Each case changes one thing.
"""

from __future__ import annotations

import json
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.ingest.policies.joint_policies import why_refused
from rosprivacy.ingest.policies.names import matcher
from rosprivacy.ingest.policies.wildcards import some_name
from tests.helpers.command import XI
from tests.helpers.fleet_files import write

if TYPE_CHECKING:
    from tests.helpers.command import Cli

STRICT = ("--fail-on", "undetermined")
VIEWS = pytest.mark.parametrize("view", ["declared", "enforced"])


def topics(rule: str, *names: str) -> str:
    return f"<topics {rule}>{''.join(f'<topic>{name}</topic>' for name in names)}</topics>"


def profile(node: str, *groups: str) -> str:
    return f'<profile ns="/" node="{node}">\n' + "\n".join(groups) + "\n</profile>"


def enclave(path: str, *profiles: str) -> str:
    return f'<enclave path="{path}">' + "".join(f"<profiles>\n{inner}</profiles>" for inner in profiles) + "</enclave>"


def policy(*enclaves: str) -> str:
    return f'<policy version="0.2.0" {XI}><enclaves>\n' + "\n".join(enclaves) + "\n</enclaves></policy>\n"


SUBSCRIBE = topics('subscribe="ALLOW"', "/video")
DENIED = topics('subscribe="DENY"', "/video")
CAMERA = enclave("/cam", profile("camera", topics('publish="ALLOW"', "/video")))
UPLINK = enclave("/up", profile("uplink", SUBSCRIBE))
DENYING = enclave("/up", profile("uplink", DENIED))
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write("l.yaml", LABELS)


DEAD: dict[str, tuple[list[str], ...]] = {
    "a second <profiles>": ([CAMERA, enclave("/up", profile("uplink", SUBSCRIBE), profile("uplink", DENIED))],),
    "a repeated <enclave>": ([CAMERA, UPLINK, DENYING],),
    "another file": ([CAMERA, UPLINK], [DENYING]),
}


class TestWhereADenyCounts:
    """Rule S5: sros2 reads the first ``<profiles>`` of the first ``<enclave>`` of a path, in each file by itself."""

    def files(self, where: str) -> list[str]:
        names = ["p.xml", "q.xml"][: len(DEAD[where])]
        for name, enclaves in zip(names, DEAD[where], strict=True):
            write(name, policy(*enclaves))
        return names

    @VIEWS
    @pytest.mark.parametrize("where", DEAD)
    def test_elsewhere_it_cuts_nothing_and_is_told(self, cli: Cli, where: str, view: str) -> None:
        done = cli("analyze", *self.files(where), "-l", "l.yaml", "--view", view)
        assert (done.returncode, done.stdout.partition(":")[0]) == (1, "leak")
        at = 7 if where == "another file" else Path("p.xml").read_text().splitlines().index(DENIED) + 1
        why = "enclave /up is stated in q.xml too" if where == "another file" else "dead DENY: subscribe /video"
        assert f"warning: p.xml:{at}: {why}" in done.stdout

    @pytest.mark.parametrize("where", DEAD)
    def test_a_saved_graph_knows_it(self, cli: Cli, where: str) -> None:
        """One that an earlier version wrote has no ``dead``, and says so."""
        assert cli("analyze", *self.files(where), "-l", "l.yaml", "--save-graph", "g.json").returncode == 1
        assert cli("analyze", "--add", "g.json", "-l", "l.yaml").returncode == 1
        earlier = json.loads(Path("g.json").read_text())
        for saved in earlier["policies"]:
            for grant in saved["grants"]:
                grant.pop("dead", None)
            for diagnostic in saved["diagnostics"]:
                diagnostic.pop("code", None)
            saved["diagnostics"] = [d for d in saved["diagnostics"] if not d["message"].startswith("dead DENY")]
        write("g.json", json.dumps(earlier))
        done = cli("analyze", "--add", "g.json", "-l", "l.yaml")
        assert done.returncode == 1
        assert ("saved by an earlier version" in done.stdout) is (where != "another file")

    def test_in_an_include_of_the_first_profiles_it_counts(self, cli: Cli) -> None:
        write("f.xml", profile("uplink", DENIED))
        include = '<xi:include href="f.xml"/>'
        write("p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE) + include)))
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert (done.returncode, "dead DENY" in done.stdout) == (0, False)
        write("p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE), include)))
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert (done.returncode, "warning: f.xml:2: dead DENY" in done.stdout) == (1, True)

    def test_of_one_robot_of_a_domain_it_counts_in_its_own_policy(self, cli: Cli) -> None:
        for name, enclaves in (("c.xml", CAMERA), ("u.xml", UPLINK), ("q.xml", DENYING)):
            write(name, policy(enclaves))
        write("c.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}}\n")
        write("u.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n")
        first = "  a: {policies: [c.xml], labels: [c.yaml], domain: lab}\n"
        second = "  b: {policies: [u.xml, q.xml], labels: [u.yaml], domain: lab}\n"
        write("fleet.yaml", f"fleet: 1\nrobots:\n{first}{second}")
        done = cli("analyze", "--fleet", "fleet.yaml")
        assert (done.returncode, "enclave /up is stated in u.xml too" in done.stdout) == (1, True)


def test_a_denied_flow_is_told_with_both_lines(cli: Cli) -> None:
    write("p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE) + profile("other", DENIED))))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert done.returncode == 0
    assert "   /video -> /uplink  (subscribe; ALLOW at p.xml:8, DENY at p.xml:10)\n" in done.stdout
    (denied,) = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json").stdout)["denied"]
    lines = [(grant["line"], grant["profile"]) for grant in denied["allowed_by"] + denied["denied_by"]]
    assert lines == [(8, "/uplink"), (10, "/other")]


@pytest.mark.parametrize("first", ["uplink", "other"])
def test_mitigate_puts_a_deny_where_it_counts(cli: Cli, first: str) -> None:
    """In the first ``<profiles>`` if it allows the flow too; if not, the line of the second one allows no more."""
    beside = profile(first, topics('subscribe="ALLOW"', "/video" if first == "uplink" else "/audio"))
    write("p.xml", policy(CAMERA, enclave("/up", beside, profile("uplink", SUBSCRIBE))))
    done = cli("mitigate", "p.xml", "-l", "l.yaml", "--by", "deny", "--patch", "m.patch")
    assert "warning" not in done.stderr
    patch = Path("m.patch").read_text().splitlines(keepends=True)
    write("p.xml", "".join(applied(Path("p.xml").read_text().splitlines(keepends=True), patch)))
    assert cli("analyze", "p.xml", "-l", "l.yaml").returncode != 1


def applied(text: list[str], patch: list[str]) -> list[str]:
    """A unified diff of one file, applied."""
    after: list[str] = []
    at = 0
    for line in patch[2:]:
        if line.startswith("@@"):
            start = int(line.split()[1].split(",")[0][1:]) - 1
            after += text[at:start]
            at = start
        elif line[0] == "+":
            after.append(line[1:])
        else:
            assert text[at] == line[1:]
            after += text[at : at + 1] if line[0] == " " else []
            at += 1
    return after + text[at:]


@pytest.mark.parametrize("fleet", [False, True])
def test_a_fragment_with_grants_that_nothing_includes_leaves_it_undetermined(cli: Cli, *, fleet: bool) -> None:
    """Rule S11."""
    monitor = enclave("/mon", profile("monitor", SUBSCRIBE))
    labels = "nodes: {/camera: {source: [Video], leak: none}, /monitor: conduit}\nchannels: {/video: sensitive}\n"
    write("r.yaml", f"labels: 1\n{labels}")
    write("d/p.xml", policy(CAMERA, monitor))
    write("fleet.yaml", "fleet: 1\nrobots: {a: {policies: [d], labels: [r.yaml]}}\n")
    question = ("--fleet", "fleet.yaml") if fleet else ("d", "-l", "r.yaml")
    assert cli("analyze", *question, *STRICT).returncode == 0
    write("d/q.xml", UPLINK)
    done = cli("analyze", *question, *STRICT)
    assert (done.returncode, "d/q.xml:1: not read" in done.stdout) == (4, True)
    results = json.loads(cli("analyze", *question, "-f", "sarif").stdout)["runs"][0]["results"]
    assert [result["ruleId"] for result in results] == ["files-not-read"]
    write("d/p.xml", policy(CAMERA, monitor, '<xi:include href="q.xml"/>'))
    assert cli("analyze", "d", "-l", "l.yaml").returncode == 1


@pytest.mark.parametrize("name", ["/video ", "/video/", "//video"])
def test_a_name_that_no_node_can_have_is_a_warning_with_the_nearest(cli: Cli, name: str) -> None:
    write("p.xml", policy(CAMERA, enclave("/up", profile("uplink", *[topics('subscribe="ALLOW"', name)] * 2))))
    lines = cli("analyze", "p.xml", "-l", "l.yaml").stdout.splitlines()
    assert "a name in p.xml is none that a ROS node can have" in lines[0]  # rule S11: it rides
    (line,) = (line for line in lines if "no ROS node can use" in line)
    assert line.strip().startswith(f"p.xml:8: no ROS node can use the topic {name!r}: it ")
    assert "; did you mean /video?" in line


@pytest.mark.parametrize(
    ("name", "good"),
    [
        ("/a/b_2", True), ("/a__b", True), ("/_a", True), ("/A/_action/feedback", True),
        ("/*", True), ("/r[0-9]/*", True), ("/a?", True), ("/[!/]x", True),
        ("/a-b", False), ("/a/2b", False), ("/a//b", False), ("/a/", False), ("/", False), ("/{node}/a", False),
        ("/a~", False), ("/é", False), ("/*/", False), ("/a b*", False), ("/" + "a" * 247, False),
    ],
)  # fmt: skip
def test_names_are_refused_as_by_rmw_validate_full_topic_name(name: str, good: bool) -> None:  # noqa: FBT001
    assert (why_refused(name) == "") is good


PATTERNS = {
    "the only common name is denied": (["/r?/image"], ["/r1/*"], ["/r1/image"]),
    "several DENYs take the whole": (["/a/t[0-1]"], ["/a/t[0-1]"], ["/a/t0", "/a/t1"]),
    "one DENY takes the whole": (["/a/x"], ["/a/*"], ["/a/*"]),
    "wildcards that are denied together": (["/*"], ["/[a-c]"], ["/[a-b]", "/c*"]),
}


@pytest.mark.parametrize("case", PATTERNS)
def test_a_pattern_of_which_denys_leave_no_common_name_carries_nothing(cli: Cli, case: str) -> None:
    writes, reads, denied = PATTERNS[case]
    channels = "".join(f'  "{name}": sensitive\n' for name in writes)
    write("l.yaml", LABELS.replace("channels: {/video: sensitive}\n", f"channels:\n{channels}"))

    def answer(*names: str) -> tuple[int, str]:
        reader = profile("uplink", topics('subscribe="ALLOW"', *reads), topics('subscribe="DENY"', *names))
        camera = enclave("/cam", profile("camera", topics('publish="ALLOW"', *writes)))
        write("p.xml", policy(camera, enclave("/up", reader)))
        done = cli("analyze", "p.xml", "-l", "l.yaml", *STRICT)
        return done.returncode, done.stdout.partition(":")[0]

    assert answer(*denied) == (0, "no-leak-found")
    assert answer(*denied[1:], "/z") == (1, "leak")


@pytest.mark.parametrize("other", ["", "asks"])
@pytest.mark.parametrize("writes", [False, True])
def test_a_deny_of_the_topics_of_an_action_counts_for_a_wildcard_of_actions(
    cli: Cli, other: str, *, writes: bool
) -> None:
    """S4 exactly: the only names that the two share are topics of actions, and these the DENY takes out.

    The enclave of the other node, whose wildcard has the same name, denies nothing.
    """
    ours, theirs = ("publish", "subscribe") if writes else ("subscribe", "publish")
    word = "execute" if writes else "call"
    action = f'<actions {word}="ALLOW"><action>/a/ac?</action></actions>'
    deny = f'<topics {ours}="DENY"><topic>/a/*</topic></topics>'
    enclaves = [
        enclave("/e1", profile("n5", action, deny)),
        enclave("/e0", profile("n0", topics(f'{theirs}="ALLOW"', "/a/*"))),
    ]
    enclaves += [enclave("/e2", profile(other, action))] if other else []
    write("p.xml", policy(*enclaves))
    source, leak = ("/n5", "/n0") if writes else ("/n0", "/n5")
    write("l.yaml", f"labels: 1\nnodes: {{{source}: {{source: [Video]}}, {leak}: {{leak: [Video]}}}}")
    assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 4
    if other and not writes:
        write("l.yaml", f"labels: 1\nnodes: {{{source}: {{source: [Video]}}, /{other}: {{leak: [Video]}}}}")
        assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 1


def test_a_write_deny_takes_nothing_from_reading(cli: Cli) -> None:
    reader = profile("uplink", topics('subscribe="ALLOW"', "/v*"), topics('publish="DENY"', "/v*"))
    write("p.xml", policy(CAMERA, enclave("/up", reader)))
    assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 1


PIECES = st.sampled_from(["a", "b", "*", "?", "[ab]", "[!a]", "[^b]"])
EXPRESSIONS = st.lists(PIECES, max_size=3).map("".join)
NAMES = ["".join(letters) for n in range(8) for letters in product("abc", repeat=n)]  # c: any other character


@given(st.lists(EXPRESSIONS, min_size=1, max_size=2), st.lists(EXPRESSIONS, max_size=3))
@example(["?*", "*a"], ["?", "??", "b*"])
def test_some_name_is_left_as_by_brute_force_over_short_names(wanted: list[str], denied: list[str]) -> None:
    wants, denies = list(map(matcher, wanted)), list(map(matcher, denied))
    left = any(all(w(name) for w in wants) and not any(d(name) for d in denies) for name in NAMES)
    assert some_name(tuple(wanted), tuple(denied)) is left


@pytest.mark.parametrize(
    "denied",
    [[f"/*{letter}{'?' * 12}" for letter in "abcdefgh"], ["/" + "".join(map(chr, range(0x4E00, 0x4E00 + 3_300)))]],
    ids=["many states", "many letters"],
)
def test_what_is_too_large_to_tell_is_taken_as_left(denied: list[str]) -> None:
    assert some_name(("/*",), (*denied, "/*"))  # nothing is left, but that takes too many steps
