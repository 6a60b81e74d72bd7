"""What policies take away is stated, and told (rules S4, S5, S11): by the command, as a reader sees it.

The base: a camera that brings video in, a node that lets it out, a topic between them. Each case changes one thing.
"""

from __future__ import annotations

import json
from itertools import product
from typing import TYPE_CHECKING

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.ingest.policies.common_names import some_name
from rosprivacy.ingest.policies.joint_policies import why_refused
from rosprivacy.ingest.policies.names import matcher

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

XI = 'xmlns:xi="http://www.w3.org/2001/XInclude"'
STRICT = ("--fail-on", "undetermined")
LEAK = "leak: data can reach a leak"


def topics(rule: str, *names: str) -> str:
    return f"<topics {rule}>{''.join(f'<topic>{name}</topic>' for name in names)}</topics>"


def profile(node: str, *groups: str) -> str:
    return f'<profile ns="/" node="{node}">\n' + "\n".join(groups) + "\n</profile>"


def enclave(path: str, *profiles: str) -> str:
    return f'<enclave path="{path}">' + "".join(f"<profiles>\n{inner}</profiles>" for inner in profiles) + "</enclave>"


def policy(*enclaves: str) -> str:
    return f'<policy version="0.2.0" {XI}><enclaves>\n' + "\n".join(enclaves) + "\n</enclaves></policy>\n"


PUBLISH, SUBSCRIBE = topics('publish="ALLOW"', "/video"), topics('subscribe="ALLOW"', "/video")
DENIED = topics('subscribe="DENY"', "/video")
CAMERA = enclave("/cam", profile("camera", PUBLISH))
UPLINK = enclave("/up", profile("uplink", SUBSCRIBE))
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"
OPEN = "labels: 1\nnodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    write(tmp_path, "l.yaml", LABELS)
    write(tmp_path, "open.yaml", OPEN)
    return tmp_path


def write(folder: Path, name: str, text: str) -> None:
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


# ---------------------------------------------------------------- S5: where a DENY counts


DEAD = {
    "a second <profiles>": [CAMERA, enclave("/up", profile("uplink", SUBSCRIBE), profile("uplink", DENIED))],
    "a repeated <enclave>": [CAMERA, UPLINK, enclave("/up", profile("uplink", DENIED))],
}


@pytest.mark.parametrize("view", ["declared", "enforced"])
@pytest.mark.parametrize("where", DEAD)
def test_a_deny_that_sros2_does_not_read_cuts_nothing_and_is_told(here: Path, cli: Cli, where: str, view: str) -> None:
    write(here, "p.xml", policy(*DEAD[where]))
    done = cli("analyze", "p.xml", "-l", "l.yaml", "--view", view)
    assert done.returncode == 1
    assert done.stdout.startswith(LEAK)
    (line,) = (line for line in done.stdout.splitlines() if "dead DENY" in line)
    at = (here / "p.xml").read_text().splitlines().index(DENIED) + 1
    assert line.startswith(f"warning: p.xml:{at}: dead DENY: subscribe /video is not taken away")


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_a_deny_of_another_file_cuts_nothing_and_both_files_are_named(here: Path, cli: Cli, view: str) -> None:
    write(here, "p.xml", policy(CAMERA, UPLINK))
    write(here, "q.xml", policy(enclave("/up", profile("uplink", DENIED))))
    done = cli("analyze", "p.xml", "q.xml", "-l", "l.yaml", "--view", view)
    assert (done.returncode, done.stdout.splitlines()[0]) == (1, LEAK)
    (line,) = (line for line in done.stdout.splitlines() if line.startswith("warning"))
    assert line.startswith("warning: p.xml:7: enclave /up is stated in q.xml too")


def test_a_deny_in_an_include_of_the_first_profiles_counts(here: Path, cli: Cli) -> None:
    write(here, "f.xml", profile("uplink", DENIED))
    include = '<xi:include href="f.xml"/>'
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE) + include)))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert (done.returncode, "dead DENY" in done.stdout) == (0, False)
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE), include)))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert (done.returncode, "warning: f.xml:2: dead DENY" in done.stdout) == (1, True)


def test_a_denied_flow_is_told_with_both_lines(here: Path, cli: Cli) -> None:
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", SUBSCRIBE) + profile("other", DENIED))))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert done.returncode == 0
    _, line = done.stdout.splitlines()[
        done.stdout.splitlines().index("Allowed by one line and denied by another: 1") :
    ][:2]
    assert line == "   /video -> /uplink  (subscribe; ALLOW at p.xml:8, DENY at p.xml:10)"
    report = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "-f", "json").stdout)
    (denied,) = report["denied"]
    assert [(g["line"], g["profile"]) for g in denied["allowed_by"] + denied["denied_by"]] == [
        (8, "/uplink"),
        (10, "/other"),
    ]


@pytest.mark.parametrize("where", [*DEAD, "another file"])
def test_a_saved_graph_knows_where_a_deny_counts(here: Path, cli: Cli, where: str) -> None:
    write(here, "p.xml", policy(*DEAD.get(where, [CAMERA, UPLINK])))
    files = ["p.xml"]
    if where not in DEAD:
        write(here, "q.xml", policy(enclave("/up", profile("uplink", DENIED))))
        files.append("q.xml")
    assert cli("analyze", *files, "-l", "l.yaml", "--save-graph", "g.json").returncode == 1
    done = cli("analyze", "--add", "g.json", "-l", "l.yaml")
    assert (done.returncode, done.stdout.splitlines()[0]) == (1, LEAK)
    earlier = json.loads((here / "g.json").read_text())  # as an earlier version wrote it
    for saved in earlier["policies"]:
        for grant in saved["grants"]:
            grant.pop("dead", None)
        for said in saved["diagnostics"]:
            said.pop("code", None)
        saved["diagnostics"] = [d for d in saved["diagnostics"] if not d["message"].startswith("dead DENY")]
    write(here, "g.json", json.dumps(earlier))
    done = cli("analyze", "--add", "g.json", "-l", "l.yaml")
    assert (done.returncode, done.stdout.splitlines()[0]) == (1, LEAK)
    assert ("saved by an earlier version" in done.stdout) is (where in DEAD)


def test_a_deny_of_one_robot_of_a_domain_counts_in_its_own_policy(here: Path, cli: Cli) -> None:
    write(here, "c.xml", policy(CAMERA))
    write(here, "u.xml", policy(UPLINK))
    write(here, "q.xml", policy(enclave("/up", profile("uplink", DENIED))))
    write(here, "c.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}}\n")
    write(here, "u.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n")
    first = "  a: {policies: [c.xml], labels: [c.yaml], domain: lab}\n"
    second = "  b: {policies: [u.xml, q.xml], labels: [u.yaml], domain: lab}\n"
    write(here, "fleet.yaml", f"fleet: 1\nrobots:\n{first}{second}")
    done = cli("analyze", "--fleet", "fleet.yaml")
    assert (done.returncode, done.stdout.splitlines()[0]) == (1, LEAK)
    assert "enclave /up is stated in u.xml too" in done.stdout


@pytest.mark.parametrize("first", ["uplink", "other"])
def test_mitigate_puts_a_deny_where_it_counts(here: Path, cli: Cli, first: str) -> None:
    """In the first ``<profiles>`` if it allows the flow too; if not, the line of the second one allows no more."""
    beside = profile(first, topics('subscribe="ALLOW"', "/video" if first == "uplink" else "/audio"))
    write(here, "p.xml", policy(CAMERA, enclave("/up", beside, profile("uplink", SUBSCRIBE))))
    done = cli("mitigate", "p.xml", "-l", "l.yaml", "--by", "deny", "--patch", "m.patch")
    assert "warning" not in done.stderr
    patch = (here / "m.patch").read_text()
    assert patch
    text = (here / "p.xml").read_text().splitlines(keepends=True)
    write(here, "p.xml", "".join(applied(text, patch.splitlines(keepends=True))))
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


# ---------------------------------------------------------------- case 5, S11: what is not read


def test_xml_counts_in_any_case_and_other_files_are_counted(here: Path, cli: Cli) -> None:
    write(here, "d/p.xml", policy(CAMERA))
    write(here, "d/Q.XML", policy(UPLINK))
    write(here, "d/r.policy", "")
    done = cli("analyze", "d", "-l", "open.yaml", "-v", *STRICT)
    assert (done.returncode, "/uplink  (node; 2 steps" in done.stdout) == (4, True)
    assert "notice: d: 1 file is not read, as the name does not end in .xml: r.policy" in done.stdout


def test_a_linked_folder_is_read_once_whatever_leads_to_it(here: Path, cli: Cli) -> None:
    write(here, "d/p.xml", policy(CAMERA))
    write(here, "e/q.xml", policy(UPLINK))
    (here / "d" / "e").symlink_to("../e")
    (here / "e" / "back").symlink_to("../d")
    done = cli("analyze", "d", "-l", "l.yaml", "-f", "json")
    assert done.returncode == 1
    assert [read["file"] for read in json.loads(done.stdout)["assumptions"]["policies"]] == ["d/e/q.xml", "d/p.xml"]


def test_a_folder_behind_a_glob_is_read(here: Path, cli: Cli) -> None:
    write(here, "r/p.xml", policy(CAMERA))
    write(here, "r/sub/q.xml", policy(UPLINK))
    assert cli("analyze", "r/*", "-l", "l.yaml").returncode == 1


def test_a_dangling_link_is_an_error(here: Path, cli: Cli) -> None:
    write(here, "d/p.xml", policy(CAMERA))
    (here / "d" / "zz.xml").symlink_to("gone.xml")
    done = cli("analyze", "d", "-l", "open.yaml")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "d/zz.xml: a link to nothing: gone.xml; correct the link, or remove it\n"


REVIEWED = (
    "labels: 1\nnodes: {/camera: {source: [Video], leak: none}, /monitor: conduit}\nchannels: {/video: sensitive}\n"
)
MONITOR = enclave("/mon", profile("monitor", SUBSCRIBE))


def test_a_fragment_with_grants_that_nothing_includes_leaves_it_undetermined(here: Path, cli: Cli) -> None:
    write(here, "rev.yaml", REVIEWED)
    write(here, "d/p.xml", policy(CAMERA, MONITOR))
    assert cli("analyze", "d", "-l", "rev.yaml", *STRICT).returncode == 0
    write(here, "d/q.xml", UPLINK)
    done = cli("analyze", "d", "-l", "rev.yaml", *STRICT)
    assert done.returncode == 4
    assert done.stdout.startswith("undetermined: no leak reached, but not all is known; d/q.xml was not read")
    assert "d/q.xml:1: not read: the root element is <enclave>, not <policy>, and no policy read" in done.stdout
    log = json.loads(cli("analyze", "d", "-l", "rev.yaml", "-f", "sarif").stdout)
    assert [result["ruleId"] for result in log["runs"][0]["results"]] == ["files-not-read"]
    assert "so no data was followed" not in cli("report", "d", "-l", "rev.yaml").stdout
    write(here, "d/p.xml", policy(CAMERA, MONITOR, '<xi:include href="q.xml"/>'))
    assert cli("analyze", "d", "-l", "l.yaml").returncode == 1


def test_a_fleet_with_a_fragment_that_nothing_includes_is_undetermined(here: Path, cli: Cli) -> None:
    write(here, "rev.yaml", REVIEWED)
    write(here, "d/p.xml", policy(CAMERA, MONITOR))
    write(here, "fleet.yaml", "fleet: 1\nrobots: {a: {policies: [d], labels: [rev.yaml]}}\n")
    assert cli("analyze", "--fleet", "fleet.yaml").returncode == 0
    write(here, "d/q.xml", UPLINK)
    done = cli("analyze", "--fleet", "fleet.yaml", *STRICT)
    assert (done.returncode, "d/q.xml:1: not read" in done.stdout.replace(f"{here}/", "")) == (4, True)


# ---------------------------------------------------------------- case 12: what brings nothing


def test_a_fallback_that_is_taken_is_a_warning(here: Path, cli: Cli) -> None:
    include = '<xi:include href="gone.xml"><xi:fallback/></xi:include>'
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", include))))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    line = "p.xml:8: included file 'gone.xml' not found: what stands in <fallback> is read in its place"
    assert line in done.stdout


def test_a_group_without_a_rule_is_a_warning(here: Path, cli: Cli) -> None:
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", topics("", "/video")))))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    line = "p.xml:8: <topics> without publish or subscribe grants nothing; write publish="
    assert line in done.stdout


# ---------------------------------------------------------------- case 15: names that no ROS accepts


@pytest.mark.parametrize("name", ["/video ", "/video/", "//video"])
def test_a_name_that_no_node_can_have_is_a_warning_with_the_nearest(here: Path, cli: Cli, name: str) -> None:
    write(here, "p.xml", policy(CAMERA, enclave("/up", profile("uplink", *[topics('subscribe="ALLOW"', name)] * 2))))
    done = cli("analyze", "p.xml", "-l", "l.yaml")
    assert "a name in p.xml is none that a ROS node can have" in done.stdout.splitlines()[0]  # rule S11: it rides
    (line,) = (line for line in done.stdout.splitlines() if "no ROS node can use" in line)
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


# ---------------------------------------------------------------- S4 exactly (D1, D5)


PATTERNS = {
    "the only common name is denied": (["/r?/image"], ["/r1/*"], ["/r1/image"]),
    "several DENYs take the whole": (["/a/t[0-1]"], ["/a/t[0-1]"], ["/a/t0", "/a/t1"]),
    "one DENY takes the whole": (["/a/x"], ["/a/*"], ["/a/*"]),
    "wildcards that are denied together": (["/*"], ["/[a-c]"], ["/[a-b]", "/c*"]),
}


@pytest.mark.parametrize("case", PATTERNS)
def test_a_pattern_of_which_denys_leave_no_common_name_carries_nothing(here: Path, cli: Cli, case: str) -> None:
    writes, reads, denied = PATTERNS[case]
    channels = "".join(f'  "{name}": sensitive\n' for name in writes)
    write(here, "l.yaml", LABELS.replace("channels: {/video: sensitive}\n", f"channels:\n{channels}"))

    def answer(*names: str) -> tuple[int, str]:
        reader = profile("uplink", topics('subscribe="ALLOW"', *reads), topics('subscribe="DENY"', *names))
        camera = enclave("/cam", profile("camera", topics('publish="ALLOW"', *writes)))
        write(here, "p.xml", policy(camera, enclave("/up", reader)))
        done = cli("analyze", "p.xml", "-l", "l.yaml", *STRICT)
        return done.returncode, done.stdout.partition(":")[0]

    assert answer(*denied) == (0, "no-leak-found")
    assert answer(*denied[1:], "/z") == (1, "leak")


@pytest.mark.parametrize("other", ["", "asks"])
@pytest.mark.parametrize("writes", [False, True])
def test_a_deny_of_the_topics_of_an_action_counts_for_a_wildcard_of_actions(
    here: Path,
    cli: Cli,
    other: str,
    writes: bool,  # noqa: FBT001
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
    write(here, "p.xml", policy(*enclaves))
    source, leak = ("/n5", "/n0") if writes else ("/n0", "/n5")
    write(here, "l.yaml", f"labels: 1\nnodes: {{{source}: {{source: [Video]}}, {leak}: {{leak: [Video]}}}}")
    assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 4
    if other and not writes:
        write(here, "l.yaml", f"labels: 1\nnodes: {{{source}: {{source: [Video]}}, /{other}: {{leak: [Video]}}}}")
        assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 1


def test_a_write_deny_takes_nothing_from_reading(here: Path, cli: Cli) -> None:
    reader = profile("uplink", topics('subscribe="ALLOW"', "/v*"), topics('publish="DENY"', "/v*"))
    write(here, "p.xml", policy(CAMERA, enclave("/up", reader)))
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


def test_what_is_too_large_to_tell_is_taken_as_left() -> None:
    many = tuple(f"/*{letter}{'?' * 12}" for letter in "abcdefgh")
    assert some_name(("/*",), (*many, "/*"))  # nothing is left, but that takes too many steps
