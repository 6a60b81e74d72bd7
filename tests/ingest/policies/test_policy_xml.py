"""The policy reader: each row is one sentence of the SROS 2 policy format, or a rule of the design."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors, PolicyError
from rosprivacy.analysis.model import Policy, Profile, Severity
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from pathlib import Path

LINE = re.compile(r"[^;]+: .+; .+")  # file:line: what is wrong; what to do
VERSION = 'version="0.2.0"'
TALK = '<topics publish="ALLOW"><topic>chatter</topic></topics>'


def profile(body: str = "", ns: str = "/", node: str = "talker") -> str:
    return f'<profile ns="{ns}" node="{node}">{body}</profile>'


def enclave(*profiles: str, path: str = "/robot") -> str:
    return f'<enclave path="{path}"><profiles>{"".join(profiles)}</profiles></enclave>'


def policy(*enclaves: str, head: str = VERSION) -> str:
    return f"<policy {head}><enclaves>{''.join(enclaves)}</enclaves></policy>"


def of(body: str, ns: str = "/", node: str = "talker") -> str:
    """A policy with one profile."""
    return policy(enclave(profile(body, ns, node)))


def read(folder: Path, text: str) -> Policy:
    file = folder / "p.xml"
    file.write_text(text, encoding="utf-8")
    return read_policy(str(file))


def refused(folder: Path, text: str) -> list[tuple[int, str]]:
    """(line, problem) of each problem; every message is one line that says what to do."""
    with pytest.raises(InputErrors) as caught:
        read(folder, text)
    assert all(isinstance(error, PolicyError) for error in caught.value.errors)
    assert all(LINE.fullmatch(line) for line in str(caught.value).split("\n"))
    assert all(error.file == str(folder / "p.xml") for error in caught.value.errors)
    return [(error.line, f"{error.problem}; {error.hint}") for error in caught.value.errors]


def granted(policy: Policy) -> list[tuple[str, str, str]]:
    return [("ALLOW" if g.allow else "DENY", g.role, g.name) for g in policy.grants]


def said(policy: Policy) -> list[tuple[str, int, str]]:
    return [(str(d.severity), d.place.line, d.message) for d in policy.diagnostics]


# ---------------------------------------------------------------- structure


def test_a_grant_knows_its_line_enclave_and_profile(tmp_path: Path) -> None:
    text = """<policy version="0.2.0">
  <enclaves>
    <enclave path="/robot/camera">
      <profiles>
        <profile ns="/front" node="camera">
          <topics publish="ALLOW">
            <topic>image</topic>
          </topics>
        </profile>
      </profiles>
    </enclave>
  </enclaves>
</policy>"""
    result = read(tmp_path, text)
    (grant,) = result.grants
    assert (grant.allow, grant.role, grant.kind, grant.name) == (True, "publish", "topic", "/front/image")
    assert (grant.enclave, grant.node) == ("/robot/camera", "/front/camera")
    assert str(grant.place) == f"{tmp_path}/p.xml:7"
    (owner,) = result.profiles
    assert (owner.enclave, owner.node, owner.place.line) == ("/robot/camera", "/front/camera", 5)


def test_a_line_beyond_65535_is_still_right(tmp_path: Path) -> None:  # libxml2 keeps 16 bits of it
    result = read(tmp_path, of("\n" * 70_000 + TALK))
    assert result.grants[0].place.line == 70_001


def test_the_bytes_that_were_read_are_known_by_their_hash(tmp_path: Path) -> None:  # S12: files with their hashes
    import hashlib

    result = read(tmp_path, of(TALK))
    digest = hashlib.sha256((tmp_path / "p.xml").read_bytes()).hexdigest()
    assert result.sources == ((str(tmp_path / "p.xml"), digest),)


@pytest.mark.parametrize(
    "text",
    [
        of(""),  # an empty <profile> is valid
        of('<topics publish="ALLOW"><topic>a</topic></topics><topics publish="ALLOW"><topic>b</topic></topics>'),
        of('<actions call="ALLOW"><action>a</action></actions>' + TALK),  # any order of groups
        of(TALK + "<metadata><anything at='all'><topics/></anything></metadata>"),  # metadata is ignored
        policy(enclave(profile(), "<metadata/>")),
        policy(enclave(profile()).replace("<profiles>", '<profiles type="x">')),  # @type is optional
        f"<!-- a --><policy {VERSION}><!-- b --><enclaves><!-- c -->{enclave(profile())}<!-- d --></enclaves></policy>",
        f'<?xml version="1.0"?><?pi x?><policy {VERSION}><?pi y?><enclaves>{enclave(profile())}</enclaves></policy>',
        policy(
            enclave(profile()), head=f'{VERSION} xmlns:x="http://www.w3.org/2001/XMLSchema-instance" x:noSchema="y"'
        ),
    ],
)
def test_valid_structure_is_read_without_a_word(tmp_path: Path, text: str) -> None:
    assert said(read(tmp_path, text)) == []


def test_comments_under_enclaves_do_not_hide_what_follows(tmp_path: Path) -> None:  # the paper's tool crashes on one
    text = policy("<!-- first -->", enclave(profile(f"<!-- x -->{TALK}<!-- y -->")), "<!-- last -->")
    assert granted(read(tmp_path, text)) == [("ALLOW", "publish", "/chatter")]


def test_what_metadata_says_is_no_grant(tmp_path: Path) -> None:
    assert granted(read(tmp_path, of(f"<metadata>{TALK}</metadata>"))) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("<launch/>", "the root element is <launch>, not <policy>; name an SROS 2 policy"),
        (profile(TALK), "the root element is <profile>, not <policy>; name the policy that includes it"),
        (policy(enclave(profile()), head=""), '<policy> without version; write version="0.2.0"'),
        (policy(enclave(profile()), head='version="0.3.0"'), "policy version '0.3.0'"),
        (policy(enclave(profile()), head='version=""'), "policy version ''"),
        (policy(enclave(profile()), head=f'{VERSION} strict="1"'), "unknown attribute 'strict' on <policy>"),
        (f"<policy {VERSION}/>", "<policy> without <enclaves>"),
        (policy(), "<enclaves> is empty; add an <enclave>"),
        (policy('<enclave path="/a"/>'), "<enclave> without <profiles>"),
        (policy("<enclave><profiles><profile ns='/' node='a'/></profiles></enclave>"), "<enclave> without path"),
        (policy('<enclave path="/a"><profiles/></enclave>'), "<profiles> is empty; add a <profile>"),
        (policy(enclave('<profile node="a"/>')), "<profile> without ns"),
        (policy(enclave('<profile ns="/"/>')), "<profile> without node"),
        (policy(enclave('<profile ns="/" node=""/>')), "<profile> without node"),
        (policy(enclave('<profile ns="/" node="a" enclave="/b"/>')), "unknown attribute 'enclave' on <profile>"),
        (of('<topics publish="ALLOW"/>'), "<topics> is empty; add a <topic>"),  # empty <topics> is not valid
        (of('<topics publish="allow"><topic>a</topic></topics>'), "publish='allow' on <topics>"),  # case-sensitive
        (of('<topics publish=""><topic>a</topic></topics>'), "publish='' on <topics>; write ALLOW or DENY"),
        (of('<topics request="ALLOW"><topic>a</topic></topics>'), "unknown attribute 'request' on <topics>"),
        (of('<services publish="ALLOW"><service>a</service></services>'), "unknown attribute 'publish' on <services>"),
        (of('<actions reply="ALLOW"><action>a</action></actions>'), "unknown attribute 'reply' on <actions>"),
        (of('<topics publish="ALLOW"><topic type="x">a</topic></topics>'), "unknown attribute 'type' on <topic>"),
        (of('<topics publish="ALLOW"><topic>a<b/></topic></topics>'), "<b> inside <topic>"),
        (of("publish everything"), "text between the elements of <profile>"),
        (of(f"{TALK}x"), "text between the elements of <profile>"),
        (policy(enclave(profile()), "<domain/>"), "<domain> under <enclaves>; here comes <enclave>"),
        (f"<policy {VERSION}><enclaves>{enclave(profile())}</enclaves><enclaves/></policy>", "second <enclaves>"),
    ],
)
def test_invalid_structure_is_refused_by_name(tmp_path: Path, text: str, problem: str) -> None:
    ((line, message),) = refused(tmp_path, text)
    assert line == 1
    assert problem in message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        # <topics> directly under <enclave>, as published once: say where it belongs
        (policy(enclave(profile()).replace("</enclave>", f"{TALK}</enclave>")), "it belongs in <profile>"),
        (of("<topic>a</topic>"), "<topic> under <profile>; it belongs in <topics>"),  # published too
        (of('<topics publish="ALLOW"><service>a</service></topics>' + TALK), "it belongs in <services>"),
        (policy(profile()), "<profile> under <enclaves>; it belongs in <profiles>"),
        (f"<policy {VERSION}>{enclave(profile())}</policy>", "<enclave> under <policy>; it belongs in <enclaves>"),
        (of("<nested>a</nested>"), "<nested> under <profile>; here comes <actions> or <services> or <topics>"),
    ],
)
def test_a_misplaced_element_is_told_where_it_belongs(tmp_path: Path, text: str, message: str) -> None:
    assert any(message in problem for _, problem in refused(tmp_path, text))


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
    lines = [line for line, _ in refused(tmp_path, text)]
    assert lines == [1, 4, 4, 5, 5, 6, 7, 9]


# ---------------------------------------------------------------- what is not XML


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"", 1),
        (b"  \n ", 2),
        (b"labels: 1", 1),
        (b"\x00\x01\x02", 1),
        (policy(enclave(profile(TALK))).encode()[:-20], 1),  # truncated
        (b"<policy version='0.2.0'>\n<enclaves>\n</policy>", 3),
        (policy(enclave(profile(node="caf\xe9"))).encode("latin-1"), 1),  # not UTF-8, and does not say so
        (b'<?xml version="1.0" encoding="no-such"?><policy/>', 1),
        (b"<policy>&nbsp;</policy>", 1),
        (b"<a>" * 300 + b"</a>" * 300, 1),  # deeper than libxml2 takes
    ],
)
def test_what_is_not_xml_is_one_problem_with_its_line(tmp_path: Path, data: bytes, line: int) -> None:
    file = tmp_path / "p.xml"
    file.write_bytes(data)
    with pytest.raises(InputErrors) as caught:
        read_policy(str(file))
    (error,) = caught.value.errors
    assert (error.file, error.line) == (str(file), line)
    assert error.problem.startswith("not well-formed XML")
    assert LINE.fullmatch(str(error))


def test_a_policy_in_another_declared_encoding_is_read(tmp_path: Path) -> None:
    text = f'<?xml version="1.0" encoding="ISO-8859-1"?>{of(TALK, node="café")}'
    file = tmp_path / "p.xml"
    file.write_bytes(text.encode("latin-1"))
    assert read_policy(str(file)).profiles[0].node == "/café"


def test_a_file_that_is_not_there_is_line_0(tmp_path: Path) -> None:
    with pytest.raises(InputErrors, match=r"none\.xml: file not found; correct the path"):
        read_policy(str(tmp_path / "none.xml"))


def test_a_name_that_no_file_can_have_is_a_problem_of_the_input(tmp_path: Path) -> None:  # the system says ENAMETOOLONG
    with pytest.raises(InputErrors):
        read_policy(str(tmp_path / ("a" * 300)))


# ---------------------------------------------------------------- attributes


@pytest.mark.parametrize(
    ("attributes", "rules"),
    [
        ("", []),  # an absent attribute means nothing, never ALLOW
        ('publish="ALLOW"', ["ALLOW publish"]),
        ('subscribe="ALLOW"', ["ALLOW subscribe"]),
        ('publish="DENY"', ["DENY publish"]),
        ('publish="ALLOW" subscribe="ALLOW"', ["ALLOW publish", "ALLOW subscribe"]),  # both on one element
        ('subscribe="DENY" publish="ALLOW"', ["ALLOW publish", "DENY subscribe"]),  # with different values
    ],
)
def test_an_attribute_grants_its_own_direction_only(tmp_path: Path, attributes: str, rules: list[str]) -> None:
    result = read(tmp_path, of(f"<topics {attributes}><topic>a</topic></topics>"))
    assert [f"{rule} {role}" for rule, role, _ in granted(result)] == rules


@pytest.mark.parametrize(
    ("group", "item", "kind", "roles"),
    [
        ("topics", "topic", "topic", ("publish", "subscribe")),
        ("services", "service", "service", ("reply", "request")),
        ("actions", "action", "action", ("call", "execute")),
    ],
)
def test_each_group_has_its_two_roles(tmp_path: Path, group: str, item: str, kind: str, roles: tuple[str, str]) -> None:
    body = f'<{group} {roles[0]}="ALLOW" {roles[1]}="DENY"><{item}>x</{item}></{group}>'
    grants = read(tmp_path, of(body)).grants
    assert [(g.kind, g.role, g.allow) for g in grants] == [(kind, roles[0], True), (kind, roles[1], False)]


def test_a_group_without_attribute_grants_nothing_and_says_so(tmp_path: Path) -> None:
    result = read(tmp_path, of("\n<topics><topic>a</topic></topics>"))
    assert granted(result) == []
    hint = 'write publish="ALLOW", or remove it'
    assert said(result) == [("warning", 2, f"<topics> without publish or subscribe grants nothing; {hint}")]


# ---------------------------------------------------------------- names


@pytest.mark.parametrize(
    ("written", "ns", "node", "full"),
    [
        ("/scan", "/robot", "lidar", "/scan"),  # absolute: as it is
        ("scan", "/", "lidar", "/scan"),  # relative: namespace + name
        ("scan", "/robot", "lidar", "/robot/scan"),
        ("scan", "/robot/", "lidar", "/robot/scan"),  # ns(+'/')
        ("~/state", "/robot", "lidar", "/robot/lidar/state"),  # private: namespace + node + rest
        ("~state", "/", "lidar", "/lidarstate"),  # no slash is added
        ("~", "/", "lidar", "/lidar"),
        (" scan ", "/", "lidar", "/ scan "),  # text is not trimmed
        ("\n scan", "/", "lidar", "/\n scan"),
        ("sc<!-- not a name -->an", "/", "lidar", "/scan"),  # comments inside text are dropped
        ("sc<?pi x?>an", "/", "lidar", "/scan"),
        ("<![CDATA[sc]]>an", "/", "lidar", "/scan"),
        ("a&amp;b", "/", "lidar", "/a&b"),
        ("*", "/", "lidar", "/*"),  # wildcards go as they are
        ("/a/[!b]?", "/", "lidar", "/a/[!b]?"),
        ("x", "", "lidar", "/x"),  # an empty namespace is the root
        ("x", "a", "lidar", "a/x"),  # a namespace without / is not repaired
        ("$(env HOME)", "/", "lidar", "/$(env HOME)"),  # no substitutions
    ],
)
def test_a_name_is_resolved_as_sros2_does(tmp_path: Path, written: str, ns: str, node: str, full: str) -> None:
    body = f'<topics publish="ALLOW"><topic>{written}</topic></topics>'
    assert [g.name for g in read(tmp_path, of(body, ns, node)).grants] == [full]


@pytest.mark.parametrize(
    ("ns", "node", "full"),
    [("/", "a", "/a"), ("/x", "a", "/x/a"), ("/x/", "a", "/x/a"), ("", "a", "/a"), ("x", "a", "x/a")],
)
def test_a_node_is_named_by_its_namespace(tmp_path: Path, ns: str, node: str, full: str) -> None:
    assert read(tmp_path, of(TALK, ns, node)).profiles[0].node == full


@pytest.mark.parametrize("node", ["/a", "~a"])
def test_a_strange_node_name_is_put_behind_its_namespace_like_any_other(tmp_path: Path, node: str) -> None:
    assert read(tmp_path, of("", "/", node)).profiles[0].node == f"/{node}"  # ns(+'/') + node: ns / has its slash


@pytest.mark.parametrize("ns", ["", "a"])
def test_a_namespace_that_is_not_absolute_is_a_warning(tmp_path: Path, ns: str) -> None:
    ((severity, line, message),) = said(read(tmp_path, of(TALK, ns)))
    assert (severity, line) == ("warning", 1)
    assert message.startswith(f"namespace '{ns}' does not begin with /")


@pytest.mark.parametrize(("written", "ns", "full"), [("", "/", "/"), ("", "/a", "/a/"), (" ", "/", "/ ")])
def test_a_blank_name_is_a_warning_with_the_name_that_it_makes(
    tmp_path: Path, written: str, ns: str, full: str
) -> None:
    result = read(tmp_path, of(f'<topics publish="ALLOW"><topic>{written}</topic></topics>', ns))
    assert [g.name for g in result.grants] == [full]
    ((severity, _, message),) = said(result)
    assert severity == "warning"
    assert message.endswith(f"as {full}")


@pytest.mark.parametrize("name", ["[[:alpha:]]", "a[[.x.]]", "[[=a=]]"])
def test_a_character_class_is_refused_rather_than_read_wrongly(tmp_path: Path, name: str) -> None:  # S4: exactly
    ((_, message),) = refused(tmp_path, of(f'<topics publish="ALLOW"><topic>{name}</topic></topics>'))
    assert "write a range such as [a-z]" in message


def test_a_message_about_a_name_stays_one_line(tmp_path: Path) -> None:
    evil = "[:\n\tx:1: fake; error\x85\u2028" + "a" * 5000
    ((_, message),) = refused(tmp_path, of(f'<topics publish="ALLOW"><topic>{evil}</topic></topics>'))
    assert len(message) < 400


# ---------------------------------------------------------------- enclaves and profiles


def test_several_profiles_in_an_enclave_are_a_warning_and_all_are_read(tmp_path: Path) -> None:
    # DDS breaks at the first grant of a subject name; union for safety + warning
    groups = f"<profiles>{profile(TALK)}</profiles>\n<profiles>{profile(TALK, node='b')}</profiles>"
    result = read(tmp_path, policy(f'<enclave path="/e">{groups}</enclave>'))
    assert [g.node for g in result.grants] == ["/talker", "/b"]
    ((severity, line, message),) = said(result)
    assert (severity, line) == ("warning", 2)
    assert message.startswith("several <profiles> in enclave /e")


def test_an_enclave_named_twice_is_a_warning_that_names_the_first(tmp_path: Path) -> None:
    # create_permission uses only the first
    result = read(tmp_path, policy(enclave(profile(TALK)), "\n", enclave(profile(TALK, node="b"))))
    assert [(g.enclave, g.node) for g in result.grants] == [("/robot", "/talker"), ("/robot", "/b")]
    ((severity, line, message),) = said(result)
    assert (severity, line) == ("warning", 2)
    assert f"first at {tmp_path}/p.xml:1" in message


def test_one_node_in_several_enclaves_is_normal(tmp_path: Path) -> None:  # TurtleBot3: 64 profiles for 38 nodes
    result = read(tmp_path, policy(enclave(profile(TALK), path="/a"), enclave(profile(), path="/b")))
    assert [(p.enclave, p.node) for p in result.profiles] == [("/a", "/talker"), ("/b", "/talker")]
    assert said(result) == []


def test_one_node_twice_in_an_enclave_is_the_union(tmp_path: Path) -> None:
    body = '<topics subscribe="ALLOW"><topic>b</topic></topics>'
    result = read(tmp_path, policy(enclave(profile(TALK), profile(body))))
    assert granted(result) == [("ALLOW", "publish", "/chatter"), ("ALLOW", "subscribe", "/b")]
    assert said(result) == []


def test_a_deny_is_kept_beside_the_allow_that_it_overrides(tmp_path: Path) -> None:  # S5: the graph decides
    body = '<topics publish="DENY"><topic>chatter</topic></topics>'
    result = read(tmp_path, policy(enclave(profile(TALK), profile(body, node="b"))))
    assert granted(result) == [("ALLOW", "publish", "/chatter"), ("DENY", "publish", "/chatter")]


# ---------------------------------------------------------------- dialects


OLD = '<policy version="0.1.0">\n<profiles>{}</profiles></policy>'


def test_format_0_1_0_makes_each_node_an_enclave_of_its_own(tmp_path: Path) -> None:
    result = read(tmp_path, OLD.format(profile(TALK) + profile(TALK, "/a", "b")))
    assert [(p.enclave, p.node) for p in result.profiles] == [("/talker", "/talker"), ("/a/b", "/a/b")]
    ((severity, line, message),) = said(result)
    assert (severity, line) == ("notice", 2)
    assert "0.1.0" in message


@pytest.mark.parametrize(
    ("written", "full"),
    [("~state", "/a/b/state"), ("~/state", "/a/b/state"), ("state", "/a/state"), ("/state", "/state")],
)
def test_format_0_1_0_writes_private_names_without_a_slash(tmp_path: Path, written: str, full: str) -> None:
    body = f'<services reply="ALLOW"><service>{written}</service></services>'
    assert [g.name for g in read(tmp_path, OLD.format(profile(body, "/a", "b"))).grants] == [full]


def test_contexts_of_the_transitional_format_are_read_as_enclaves(tmp_path: Path) -> None:
    text = policy(enclave(profile(TALK))).replace("enclave", "context").replace("<contexts>", "\n<contexts>")
    result = read(tmp_path, text)
    assert [g.enclave for g in result.grants] == ["/robot"]
    assert said(result) == [("notice", 2, "<contexts> of a transitional format: read as <enclaves>")]


def test_a_default_namespace_is_read_through_with_a_notice(tmp_path: Path) -> None:  # ADMAS, 6 files
    result = read(
        tmp_path, "\n" + policy(enclave(profile(TALK)), head=f'{VERSION} xmlns="http://ros2.org/sros2/policy"')
    )
    assert granted(result) == [("ALLOW", "publish", "/chatter")]
    ((severity, line, message),) = said(result)
    assert (severity, line) == ("notice", 2)
    assert message.startswith("default namespace on <policy>")


@pytest.mark.parametrize(
    "text",
    [
        of(f'\n<x:topics xmlns:x="urn:x" publish="ALLOW"><x:topic>a</x:topic></x:topics>{TALK}'),
        policy(enclave(f'\n<profile xmlns="urn:x" ns="/" node="a">{TALK}</profile>')),
        f'<policy {VERSION}>\n<enclaves xmlns="urn:x">{enclave(profile(TALK))}</enclaves></policy>',
    ],
)
def test_an_element_of_another_namespace_is_never_taken_for_ours_in_silence(tmp_path: Path, text: str) -> None:
    # sros2 refuses it, or its stylesheet returns nothing; what sros2 refuses is read with a notice, or refused
    try:
        lines = [line for _, line, _ in said(read(tmp_path, text))]
    except InputErrors as error:
        lines = [problem.line for problem in error.errors]
    assert 2 in lines


def test_an_old_version_with_enclaves_is_not_taken_in_silence(tmp_path: Path) -> None:  # the XSD fixes 0.2.0
    try:
        lines = [line for _, line, _ in said(read(tmp_path, policy(enclave(profile(TALK)), head='version="0.1.0"')))]
    except InputErrors as error:
        lines = [problem.line for problem in error.errors]
    assert lines == [1]


def test_diagnostics_are_warnings_and_notices_only(tmp_path: Path) -> None:
    body = enclave(profile("<topics><topic> </topic></topics>", "a"))
    result = read(tmp_path, policy(body, head='version="0.1.0"'))
    assert {d.severity for d in result.diagnostics} == {Severity.WARNING, Severity.NOTICE}


def test_the_same_file_gives_the_same_policy(tmp_path: Path) -> None:  # S14
    text = policy(enclave(profile(TALK), profile(TALK, "/a")))
    assert read(tmp_path, text) == read(tmp_path, text)
    assert isinstance(read(tmp_path, text).profiles[0], Profile)


def test_profiles_without_enclaves_keep_the_names_of_their_version(tmp_path: Path) -> None:  # 0.1.0: ~a is ~/a
    body = '<topics publish="ALLOW"><topic>~a</topic></topics>'
    for version, full in (("0.1.0", "/n/a"), ("0.2.0", "/na")):
        text = f'<policy version="{version}"><profiles><profile ns="/" node="n">{body}</profile></profiles></policy>'
        result = read(tmp_path, text)
        assert [g.name for g in result.grants] == [full]
        assert "0.1.0" in said(result)[0][2]
