"""The policy reader: each row is one sentence of the SROS 2 policy format, or a rule of the design."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.includes import LINE

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Policy

VERSION = 'version="0.2.0"'
TALK = '<topics publish="ALLOW"><topic>chatter</topic></topics>'
XSI = 'xmlns:x="http://www.w3.org/2001/XMLSchema-instance" x:noSchema="y"'


def profile(body: str = "", ns: str = "/", node: str = "talker") -> str:
    return f'<profile ns="{ns}" node="{node}">{body}</profile>'


def enclave(*profiles: str, path: str = "/robot") -> str:
    return f'<enclave path="{path}"><profiles>{"".join(profiles)}</profiles></enclave>'


def policy(*enclaves: str, head: str = VERSION) -> str:
    return f"<policy {head}><enclaves>{''.join(enclaves)}</enclaves></policy>"


def old(*profiles: str, version: str = "0.1.0") -> str:
    return f'<policy version="{version}">\n<profiles>{"".join(profiles)}</profiles></policy>'


def of(body: str, ns: str = "/", node: str = "talker") -> str:
    """A policy with one profile."""
    return policy(enclave(profile(body, ns, node)))


def publishes(name: str) -> str:
    return f'<topics publish="ALLOW"><topic>{name}</topic></topics>'


def read(folder: Path, text: str | bytes) -> Policy:
    file = folder / "p.xml"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_policy(str(file))


def refused(folder: Path, text: str | bytes) -> list[tuple[int, str]]:
    """(line, problem) of each problem; every message is one short line that says what to do."""
    with pytest.raises(InputErrors) as caught:
        read(folder, text)
    assert all(isinstance(error, PolicyError) for error in caught.value.errors)
    assert all(LINE.fullmatch(line) and len(line) < 600 for line in str(caught.value).split("\n"))
    assert all(error.file == str(folder / "p.xml") for error in caught.value.errors)
    return [(error.line, error.problem) for error in caught.value.errors]


def granted(policy: Policy) -> list[str]:
    return [f"{g.node} {'' if g.allow else 'DENY '}{g.role} {g.name}" for g in policy.grants]


def diagnostics(policy: Policy) -> list[tuple[str, int]]:
    return [(str(d.severity), d.place.line) for d in policy.diagnostics]


def test_a_grant_knows_its_line_enclave_and_profile_and_the_policy_its_hash(tmp_path: Path) -> None:
    text = policy("\n" + enclave("\n" + profile("\n" + TALK, "/front", "camera"), path="/robot/camera"))
    result = read(tmp_path, text)
    (grant,), (owner,) = result.grants, result.profiles
    assert (grant.allow, grant.role, grant.kind, grant.name) == (True, "publish", "topic", "/front/chatter")
    assert (grant.enclave, grant.node) == ("/robot/camera", "/front/camera")
    assert str(grant.place) == f"{tmp_path}/p.xml:4"
    assert (owner.enclave, owner.node, owner.place.line) == ("/robot/camera", "/front/camera", 3)
    assert result.sources == ((f"{tmp_path}/p.xml", hashlib.sha256(text.encode()).hexdigest()),)
    assert read(tmp_path, text) == result


def test_a_line_beyond_65535_is_still_right(tmp_path: Path) -> None:
    """libxml2 keeps 16 bits of it."""
    assert read(tmp_path, of("\n" * 70_000 + TALK)).grants[0].place.line == 70_001


SECOND = f"\n<profiles>{profile(TALK, node='b')}</profiles></enclave>"
CHATTER = ["/talker publish /chatter"]


@pytest.mark.parametrize(
    ("text", "grants"),
    [
        (of(""), []),  # an empty <profile> is valid
        (of(publishes("a") + publishes("b")), ["/talker publish /a", "/talker publish /b"]),
        (of('<actions call="ALLOW"><action>a</action></actions>' + TALK), ["/talker call /a", *CHATTER]),
        (of(TALK + f"<metadata><anything at='all'>{publishes('a')}</anything></metadata>"), CHATTER),
        (policy(enclave(profile(TALK), "<metadata/>")), CHATTER),
        (policy(enclave(profile(TALK)).replace("<profiles>", '<profiles type="x">')), CHATTER),
        (policy("<!-- a -->", enclave(profile(f"<!-- b -->{TALK}<!-- c -->")), "<!-- d -->"), CHATTER),
        (f'<?xml version="1.0"?><?pi x?>{policy("<?pi y?>", enclave(profile(TALK)))}', CHATTER),
        (policy(enclave(profile(TALK)), head=f"{VERSION} {XSI}"), CHATTER),
        (f'<?xml version="1.0" encoding="ISO-8859-1"?>{of(TALK, node="é")}'.encode("latin-1"), ["/é publish /chatter"]),
        # one node twice in an enclave is the union; a DENY is kept beside the ALLOW that it overrides (S5)
        (policy(enclave(profile(TALK), profile(publishes("b")))), [*CHATTER, "/talker publish /b"]),
        (of(TALK + TALK.replace("ALLOW", "DENY")), [*CHATTER, "/talker DENY publish /chatter"]),
        # an attribute grants its own direction only
        (of('<topics subscribe="ALLOW"><topic>a</topic></topics>'), ["/talker subscribe /a"]),
        (
            of('<topics subscribe="DENY" publish="ALLOW"><topic>a</topic></topics>'),
            ["/talker publish /a", "/talker DENY subscribe /a"],
        ),
    ],
)
def test_what_is_valid_is_read_without_a_word(tmp_path: Path, text: str | bytes, grants: list[str]) -> None:
    result = read(tmp_path, text)
    assert (granted(result), diagnostics(result)) == (grants, [])


@pytest.mark.parametrize(
    ("kind", "allowed", "denied"),
    [("topic", "publish", "subscribe"), ("service", "reply", "request"), ("action", "call", "execute")],
)
def test_each_group_has_its_two_roles(tmp_path: Path, kind: str, allowed: str, denied: str) -> None:
    body = f'<{kind}s {allowed}="ALLOW" {denied}="DENY"><{kind}>x</{kind}></{kind}s>'
    grants = read(tmp_path, of(body)).grants
    assert [(g.kind, g.role, g.allow) for g in grants] == [(kind, allowed, True), (kind, denied, False)]


def test_one_node_in_several_enclaves_is_normal(tmp_path: Path) -> None:
    """TurtleBot3: 64 profiles for 38 nodes."""
    result = read(tmp_path, policy(enclave(profile(TALK), path="/a"), enclave(profile(), path="/b")))
    assert [(p.enclave, p.node) for p in result.profiles] == [("/a", "/talker"), ("/b", "/talker")]
    assert diagnostics(result) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("<launch/>", "the root element is <launch>"),
        (profile(TALK), "the root element is <profile>"),
        (policy(enclave(profile()), head=""), "<policy> without version"),
        (policy(enclave(profile()), head='version="0.3.0"'), "policy version '0.3.0'"),
        (policy(enclave(profile()), head='version=""'), "policy version ''"),
        (policy(enclave(profile()), head=f'{VERSION} strict="1"'), "unknown attribute 'strict' on <policy>"),
        (f"<policy {VERSION}/>", "<policy> without <enclaves>"),
        (f"<policy {VERSION}><enclaves>{enclave(profile())}</enclaves><enclaves/></policy>", "second <enclaves>"),
        (policy(), "<enclaves> is empty"),
        (policy(enclave(profile())).replace("<enclaves>", "<enclaves x='1'>"), "unknown attribute 'x' on <enclaves>"),
        (policy('<enclave path="/a"/>'), "<enclave> without <profiles>"),
        (policy(enclave(profile())).replace(' path="/robot"', ""), "<enclave> without path"),
        (policy('<enclave path="/a"><profiles/></enclave>'), "<profiles> is empty"),
        (policy(enclave('<profile node="a"/>')), "<profile> without ns"),
        (policy(enclave('<profile ns="/"/>')), "<profile> without node"),
        (policy(enclave('<profile ns="/" node=""/>')), "<profile> without node"),
        (policy(enclave('<profile ns="/" node="a" enclave="/b"/>')), "unknown attribute 'enclave' on <profile>"),
        (of('<topics publish="ALLOW"/>'), "<topics> is empty"),
        (of('<topics publish="allow"><topic>a</topic></topics>'), "publish='allow' on <topics>"),  # case-sensitive
        (of('<topics publish=""><topic>a</topic></topics>'), "publish='' on <topics>"),
        (of('<topics request="ALLOW"><topic>a</topic></topics>'), "unknown attribute 'request' on <topics>"),
        (of('<services publish="ALLOW"><service>a</service></services>'), "unknown attribute 'publish' on <services>"),
        (of('<actions reply="ALLOW"><action>a</action></actions>'), "unknown attribute 'reply' on <actions>"),
        (of('<topics publish="ALLOW"><topic type="x">a</topic></topics>'), "unknown attribute 'type' on <topic>"),
        (of(publishes("a<b/>")), "<b> inside <topic>"),
        (of("publish everything"), "text between the elements of <profile>"),
        (of(f"{TALK}x"), "text between the elements of <profile>"),
        (policy(enclave(profile()), "<domain/>"), "<domain> under <enclaves>"),
        *(
            (of(publishes(name)), "character class in") for name in ("[[:alpha:]]", "a[[.x.]]", "[[=a=]]")
        ),  # S4: exactly
        (of(publishes("[:\n\tx:1: fake; error\x85\u2028" + "a" * 5000)), "character class in"),
    ],
)
def test_what_is_invalid_is_refused_by_name(tmp_path: Path, text: str, problem: str) -> None:
    ((line, message),) = refused(tmp_path, text)
    assert line == 1
    assert problem in message


@pytest.mark.parametrize(
    ("text", "home"),
    [
        (policy(enclave(profile()).replace("</enclave>", f"{TALK}</enclave>")), "profile"),  # published once
        (of("<topic>a</topic>"), "topics"),  # published too
        (of('<topics publish="ALLOW"><service>a</service></topics>' + TALK), "services"),
        (policy(profile()), "profiles"),
        (f"<policy {VERSION}>{enclave(profile())}</policy>", "enclaves"),
    ],
)
def test_a_misplaced_element_is_told_where_it_belongs(tmp_path: Path, text: str, home: str) -> None:
    with pytest.raises(InputErrors) as caught:
        read(tmp_path, text)
    assert any(f"it belongs in <{home}>" in str(error) for error in caught.value.errors)


def test_every_problem_of_a_file_is_reported_at_once(tmp_path: Path) -> None:
    text = """<policy version="9">
<enclaves>
<enclave path="/a"><profiles>
<profile node="a"><topics publish="YES"><topic>x</topic></topics></profile>
<profile ns="/"><topic>x</topic></profile>
<profile ns="/" node="b"><services/>
<actions execute="ALLOW"><action>x<y/></action></actions></profile>
</profiles></enclave>
<enclave path="/b"/>
</enclaves>
</policy>"""
    assert [line for line, _ in refused(tmp_path, text)] == [1, 4, 4, 5, 5, 6, 7, 9]


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"", 1),
        (b"  \n ", 2),
        (b"labels: 1", 1),
        (b"\x00\x01\x02", 1),
        (of(TALK).encode()[:-20], 1),  # truncated
        (b"<policy version='0.2.0'>\n<enclaves>\n</policy>", 3),
        (of(TALK, node="caf\xe9").encode("latin-1"), 1),  # not UTF-8, and does not say so
        (b'<?xml version="1.0" encoding="no-such"?><policy/>', 1),
        (b"<policy>&nbsp;</policy>", 1),
        (b"<a>" * 300 + b"</a>" * 300, 1),  # deeper than libxml2 takes
    ],
)
def test_what_is_not_xml_is_one_problem_with_its_line(tmp_path: Path, data: bytes, line: int) -> None:
    ((at, problem),) = refused(tmp_path, data)
    assert (at, problem.startswith("not well-formed XML")) == (line, True)


@pytest.mark.parametrize("name", ["none.xml", "a" * 300], ids=["absent", "impossible"])
def test_a_file_that_cannot_be_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputErrors, match=name[:100]):
        read_policy(str(tmp_path / name))


@pytest.mark.parametrize(
    ("written", "ns", "node", "full"),
    [
        ("scan", "/robot/", "lidar", "/robot/scan"),  # ns(+'/'); more in test_names
        ("~/state", "/robot", "lidar", "/robot/lidar/state"),
        ("\n scan", "/", "lidar", "/\n scan"),  # text is not trimmed
        ("sc<!-- not a name -->an", "/", "lidar", "/scan"),  # comments inside text are dropped
        ("sc<?pi x?>an", "/", "lidar", "/scan"),
        ("<![CDATA[sc]]>an", "/", "lidar", "/scan"),
        ("a&amp;b", "/", "lidar", "/a&b"),
        ("*", "/", "lidar", "/*"),  # wildcards go as they are
        ("/a/[!b]?", "/", "lidar", "/a/[!b]?"),
        ("$(env HOME)", "/", "lidar", "/$(env HOME)"),  # no substitutions
    ],
)
def test_a_name_is_resolved_as_sros2_does(tmp_path: Path, written: str, ns: str, node: str, full: str) -> None:
    assert [g.name for g in read(tmp_path, of(publishes(written), ns, node)).grants] == [full]


@pytest.mark.parametrize(
    ("ns", "node", "full", "odd"),
    [
        ("/x", "a", "/x/a", False),
        ("/x/", "a", "/x/a", False),
        ("/", "/a", "//a", False),  # a strange name is put behind the namespace like any other
        ("/", "~a", "/~a", False),
        ("", "a", "/a", True),
        ("x", "a", "x/a", True),
    ],
)
def test_a_node_is_named_by_its_namespace_which_begins_with_a_slash(
    tmp_path: Path, ns: str, node: str, full: str, *, odd: bool
) -> None:
    result = read(tmp_path, of(TALK, ns, node))
    assert (result.profiles[0].node, diagnostics(result)) == (full, [("warning", 1)] if odd else [])


@pytest.mark.parametrize(
    ("text", "grants", "expected", "keyword"),
    [
        (
            of("\n<topics><topic>a</topic></topics>"),
            [],
            ("warning", 2),
            "grants nothing",
        ),  # never ALLOW by default
        (of(publishes("~x")), ["/talker publish /talkerx"], ("warning", 1), "write ~/"),  # no slash is added
        (of(publishes(""), "/a", "n"), ["/a/n publish /a/"], ("warning", 1), "as /a/"),
        (of(publishes(" ")), ["/talker publish / "], ("warning", 1), "as / "),
        (  # DDS breaks at the first grant of a subject name: read too, for safety
            policy(enclave(profile(TALK)).replace("</enclave>", SECOND)),
            [*CHATTER, "/b publish /chatter"],
            ("warning", 2),
            "several <profiles> in enclave /robot",
        ),
        (  # create_permission uses only the first
            policy(enclave(profile(TALK)), "\n", enclave(profile(TALK, node="b"))),
            [*CHATTER, "/b publish /chatter"],
            ("warning", 2),
            "p.xml:1",
        ),
        # dialects that are found in public
        (old(profile(TALK, "/a", "b")), ["/a/b publish /a/chatter"], ("notice", 2), "0.1.0"),
        (old(profile(publishes("~x"), "/a", "b")), ["/a/b publish /a/b/x"], ("notice", 2), "0.1.0"),  # ~x is ~/x there
        (old(profile(publishes("~/x"), "/a", "b")), ["/a/b publish /a/b/x"], ("notice", 2), "0.1.0"),
        (old(profile(TALK), version="0.2.0"), CHATTER, ("notice", 2), "0.1.0"),
        (policy(enclave(profile(TALK)), head='version="0.1.0"'), CHATTER, ("notice", 1), "0.1.0"),
        (
            policy(enclave(profile(TALK))).replace("enclave", "context").replace("<contexts>", "\n<contexts>"),
            CHATTER,
            ("notice", 2),
            "<contexts>",
        ),
        (  # ADMAS, 6 files
            "\n" + policy(enclave(profile(TALK)), head=f'{VERSION} xmlns="http://ros2.org/sros2/policy"'),
            CHATTER,
            ("notice", 2),
            "default namespace",
        ),
        (
            policy(enclave(f'\n<profile xmlns="urn:x" ns="/" node="talker">{TALK}</profile>')),
            CHATTER,
            ("notice", 2),
            "namespace of its own",
        ),
    ],
)
def test_what_sros2_reads_otherwise_is_read_and_told(
    tmp_path: Path, text: str, grants: list[str], expected: tuple[str, int], keyword: str
) -> None:
    result = read(tmp_path, text)
    assert granted(result) == grants
    assert diagnostics(result)[0] == expected
    assert keyword in result.diagnostics[0].message


def test_format_0_1_0_makes_each_node_an_enclave_of_its_own(tmp_path: Path) -> None:
    result = read(tmp_path, old(profile(TALK) + profile(TALK, "/a", "b")))
    assert [(p.enclave, p.node) for p in result.profiles] == [("/talker", "/talker"), ("/a/b", "/a/b")]


def test_a_tilde_without_a_slash_is_not_repaired_in_a_policy_of_0_2_0(tmp_path: Path) -> None:
    """Even if it has no enclaves, as in 0.1.0."""
    result = read(tmp_path, old(profile(publishes("~a"), node="n"), version="0.2.0"))
    assert [g.name for g in result.grants] == ["/na"]
