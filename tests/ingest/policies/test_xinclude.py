"""Includes: what sros2's policies use is read with its own file and line; what is hostile reads nothing else.

Sources: XInclude 1.0; ``reference/sros2.md``, section 2. Sentences on security: includes stay inside a folder tree,
no network, no DTD, no entities, bounds on depth and bytes.
"""

from __future__ import annotations

import os
import re
import runpy
import socket
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.paths import TESTS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import Policy

LINE = re.compile(r".+:\d+: .+; .+")
NEW, OLD = "http://www.w3.org/2001/XInclude", "http://www.w3.org/2003/XInclude"
CHILDREN = 'xpointer="xpointer(/profile/*)"'
HIDDEN = '<profile><topics publish="ALLOW"><topic>secret</topic></topics></profile>'
FUZZ = runpy.run_path(str(TESTS / "fuzz_corpus.py"))


def topic(name: str) -> str:
    return f'<topics publish="ALLOW"><topic>{name}</topic></topics>'


def include(href: str, rest: str = CHILDREN, namespace: str = NEW) -> str:
    return f'<xi:include xmlns:xi="{namespace}" href="{href}" {rest}/>'


def write(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def policy(folder: Path, *bodies: str, name: str = "p.xml") -> Path:
    """A policy with one profile for each body: a, b, …"""
    profiles = "".join(f'<profile ns="/" node="{chr(97 + i)}">{body}</profile>' for i, body in enumerate(bodies))
    enclaves = f'<enclaves><enclave path="/e"><profiles>{profiles}</profiles></enclave></enclaves>'
    return write(folder / name, f'<policy version="0.2.0">{enclaves}</policy>')


def read(file: Path, **options: Any) -> Policy:
    return read_policy(str(file), **options)


def refused(file: Path, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read(file, **options)
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    return lines


def names(policy: Policy) -> list[str]:
    return [grant.name for grant in policy.grants]


def places(policy: Policy, folder: Path) -> list[str]:
    return [str(grant.place).removeprefix(f"{folder}/") for grant in policy.grants]


# ---------------------------------------------------------------- what policies use


@pytest.mark.parametrize("namespace", [NEW, OLD])  # BOTH; common/node.xml uses 2003
def test_both_namespaces_are_read(tmp_path: Path, namespace: str) -> None:
    write(tmp_path / "node.xml", f"<profile>{topic('rosout')}</profile>")
    assert names(read(policy(tmp_path, include("node.xml", namespace=namespace)))) == ["/rosout"]


def test_another_namespace_is_no_include(tmp_path: Path) -> None:
    write(tmp_path / "node.xml", f"<profile>{topic('rosout')}</profile>")
    assert "<include> under <profile>" in refused(policy(tmp_path, include("node.xml", namespace="urn:x")))[0]


def test_a_grant_from_an_include_names_the_included_file_and_line(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>\n\n{topic('rosout')}</profile>")
    result = read(policy(tmp_path, topic("a") + include("common/node.xml") + topic("b")))
    assert names(result) == ["/a", "/rosout", "/b"]  # in document order
    assert places(result, tmp_path) == ["p.xml:1", "common/node.xml:3", "p.xml:1"]
    assert [grant.node for grant in result.grants] == ["/a"] * 3  # granted to the profile that includes
    assert [Path(file).name for file, _ in result.sources] == ["node.xml", "p.xml"]


def test_a_name_in_an_include_belongs_to_the_profile_that_includes(tmp_path: Path) -> None:
    write(tmp_path / "node.xml", f"<profile>{topic('~/state')}</profile>")
    assert names(read(policy(tmp_path, include("node.xml"), include("node.xml")))) == ["/a/state", "/b/state"]


def test_hrefs_are_relative_to_the_including_file(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>{include('node/log.xml')}</profile>")
    write(tmp_path / "common" / "node" / "log.xml", f"<profile>{include('../time.xml')}{topic('rosout')}</profile>")
    write(tmp_path / "common" / "time.xml", f"<profile>{topic('clock')}</profile>")
    write(tmp_path / "node" / "log.xml", HIDDEN)
    result = read(policy(tmp_path, include("common/node.xml")))
    assert names(result) == ["/clock", "/rosout"]
    assert places(result, tmp_path) == ["common/time.xml:1", "common/node/log.xml:1"]


@pytest.mark.parametrize(
    ("fragment", "xpointer", "wrapped"),
    [
        ("<profile>{}</profile>", "/profile/*", "{}"),
        ("<profile>{}</profile>", "/*/*", "{}"),
        ("<profile>{}</profile>", " /profile/topics ", "{}"),
        ("{}", "", "{}"),  # no xpointer: the root element
        ("{}", "/topics", "{}"),
        ("<profile>{}</profile>", "/profile/topics/*", '<topics publish="ALLOW">{}</topics>'),
    ],
)
def test_an_xpointer_selects_elements(tmp_path: Path, fragment: str, xpointer: str, wrapped: str) -> None:
    write(tmp_path / "f.xml", fragment.format(topic("x")))
    rest = f'xpointer="xpointer({xpointer})"' if xpointer else ""
    assert names(read(policy(tmp_path, wrapped.format(include("f.xml", rest))))) == ["/x"]


@pytest.mark.parametrize(
    ("xpointer", "depth"),
    [
        ("/profiles/*", 3),
        ("/policy/enclaves/enclave/profiles/*", 3),
        ("/policy/enclaves/*", 1),
        ("/policy/enclaves", 0),
    ],
)
def test_the_xpointers_of_public_policies_are_read(tmp_path: Path, xpointer: str, depth: int) -> None:
    inner = policy(tmp_path, topic("x"), name="inner.xml")
    if xpointer.startswith("/profiles"):
        write(inner, f'<profiles>\n<profile ns="/" node="a">{topic("x")}</profile></profiles>')
    around = ["<enclaves>", '<enclave path="/e">', "<profiles>"][:depth]
    back = ["</profiles>", "</enclave>", "</enclaves>"][3 - depth :]
    pointed = include("inner.xml", f'xpointer="xpointer({xpointer})"')
    outer = "".join(['<policy version="0.2.0">', *around, pointed, *back, "</policy>"])
    result = read(write(tmp_path / "p.xml", outer))
    assert names(result) == ["/x"]
    assert [profile.node for profile in result.profiles] == ["/a"]
    assert Path(result.profiles[0].place.file).name == "inner.xml"


@pytest.mark.parametrize(
    "xpointer",
    ["profile", "element(/1)", "xpointer(//a)", "xpointer(/a/*)xpointer(/x)", "xpointer(id('a'))", "(", "xpointer()"],
)
def test_another_xpointer_is_refused_by_its_text(tmp_path: Path, xpointer: str) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    (line,) = refused(policy(tmp_path, include("f.xml", f'xpointer="{xpointer}"')))
    assert xpointer in line
    assert "is not supported; write xpointer(/a/b/*)" in line


def test_an_xpointer_that_selects_nothing_is_a_warning(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    result = read(policy(tmp_path, include("f.xml", 'xpointer="xpointer(/profil/*)"')))
    ((severity, line, message),) = [(str(d.severity), d.place.line, d.message) for d in result.diagnostics]
    assert (severity, line, result.grants) == ("warning", 1, ())
    assert "selects no element" in message


def test_a_missing_file_is_refused_at_the_include(tmp_path: Path) -> None:
    (line,) = refused(policy(tmp_path, f"\n{include('none.xml')}"))
    assert line.startswith(f"{tmp_path}/p.xml:2: included file 'none.xml' not found")


@pytest.mark.parametrize("namespace", [NEW, OLD])
def test_a_fallback_takes_the_place_of_a_missing_file(tmp_path: Path, namespace: str) -> None:
    fallback = f"<xi:fallback>\n{topic('b')}</xi:fallback>"
    text = f'<xi:include xmlns:xi="{namespace}" href="none.xml">{fallback}</xi:include>'
    result = read(policy(tmp_path, text))
    assert (names(result), places(result, tmp_path)) == (["/b"], ["p.xml:2"])


def test_a_fallback_may_include_and_may_be_empty(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f"<profile>{topic('x')}</profile>")
    missing = '<xi:include xmlns:xi="{}" href="none.xml"><xi:fallback>{}</xi:fallback></xi:include>'
    assert names(read(policy(tmp_path, missing.format(NEW, missing.format(NEW, include("f.xml")))))) == ["/x"]
    assert names(read(policy(tmp_path, missing.format(NEW, "")))) == []


def test_a_fallback_of_a_file_that_is_there_is_not_used(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f"<profile>{topic('x')}</profile>")
    text = f'<xi:include xmlns:xi="{NEW}" href="f.xml" {CHILDREN}><xi:fallback>{topic("b")}</xi:fallback></xi:include>'
    assert names(read(policy(tmp_path, text))) == ["/x"]


def test_a_fallback_outside_of_an_include_is_refused(tmp_path: Path) -> None:
    (line,) = refused(policy(tmp_path, f'<xi:fallback xmlns:xi="{NEW}">{topic("b")}</xi:fallback>'))
    assert "<fallback> outside <xi:include>" in line


def test_text_in_a_fallback_is_not_dropped_in_silence(tmp_path: Path) -> None:  # it would stand between the elements
    text = f'<xi:include xmlns:xi="{NEW}" href="none.xml"><xi:fallback>rosout</xi:fallback></xi:include>'
    assert "text" in refused(policy(tmp_path, text))[0]


def test_the_same_file_may_be_included_by_many(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f"<profile>{topic('x')}</profile>")
    assert len(read(policy(tmp_path, *[include("f.xml")] * 20)).grants) == 20


def test_a_problem_in_a_file_that_many_include_is_reported_once(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", '<profile>\n<topics publish="YES"><topic>x</topic></topics></profile>')
    (line,) = refused(policy(tmp_path, *[include("f.xml")] * 5))
    assert line.startswith(f"{tmp_path}/f.xml:2: publish='YES' on <topics>")


def test_problems_of_the_policy_and_its_includes_are_reported_together(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", "<profile>\n<domain/></profile>")
    write(tmp_path / "g.xml", "<profile>\n")
    found = refused(policy(tmp_path, f"{include('f.xml')}\n{include('g.xml')}{include('none.xml')}<topic/>"))
    assert [line.split(": ")[0].removeprefix(f"{tmp_path}/") for line in found] == [
        "f.xml:2",
        "g.xml:2",
        "p.xml:2",
        "p.xml:2",
    ]


def test_an_escaped_href_is_a_file_name(tmp_path: Path) -> None:
    write(tmp_path / "a b.xml", f"<profile>{topic('x')}</profile>")
    assert names(read(policy(tmp_path, include("a%20b.xml")))) == ["/x"]


def test_xml_base_is_honoured_or_refused_but_not_passed_over(tmp_path: Path) -> None:  # XInclude 4.2.1: base URI
    write(tmp_path / "node.xml", f"<profile>{topic('wrong')}</profile>")
    write(tmp_path / "common" / "node.xml", f"<profile>{topic('right')}</profile>")
    file = policy(tmp_path, include("node.xml", f'{CHILDREN} xml:base="common/"'))
    try:
        assert names(read(file)) == ["/right"]
    except InputErrors as error:
        assert "base" in str(error)  # noqa: PT017 - either will do


# ---------------------------------------------------------------- hostile: out of the root


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "root").mkdir()
    write(tmp_path / "outside" / "secret.xml", HIDDEN)
    return tmp_path / "root"


@pytest.fixture
def guarded(root: Path) -> Iterator[None]:
    """Nothing outside of the root is opened, by Python or by libxml2."""
    with FUZZ["Guard"](root.parent / "outside") as guard:
        yield
        assert guard.check() == []


@pytest.mark.usefixtures("guarded")
@pytest.mark.parametrize(
    "href",
    [
        "../outside/secret.xml",
        "down/../../outside/secret.xml",
        "%2e%2e/outside/secret.xml",
        "..%2Foutside%2Fsecret.xml",
        "{outside}/secret.xml",  # absolute
        "file://{outside}/secret.xml",
        "FILE:{outside}/secret.xml",
        "//localhost{outside}/secret.xml",
        "link.xml",  # a symbolic link to the file
        "away/secret.xml",  # … to its folder
        "away/../outside/secret.xml",
        "link-to-link.xml",
        "/proc/self/cwd/secret.xml",
        "/proc/self/environ",
        "/etc/passwd",
        "c:secret.xml",
        "\\\\server\\secret.xml",
    ],
)
def test_an_include_out_of_the_root_reads_nothing(root: Path, href: str) -> None:
    outside = root.parent / "outside"
    (root / "down").mkdir()
    (root / "link.xml").symlink_to(outside / "secret.xml")
    (root / "away").symlink_to(outside)
    (root / "link-to-link.xml").symlink_to("link.xml")
    (line,) = refused(policy(root, f"\n{include(href.format(outside=outside))}"))
    assert line.startswith(f"{root}/p.xml:2: ")


def test_a_refused_include_says_how_to_widen(root: Path) -> None:
    (line,) = refused(policy(root, include("../outside/secret.xml")))
    assert f"include of '../outside/secret.xml' leaves the folder {root}; " in line
    assert "--include-root" in line


@pytest.mark.usefixtures("guarded")
def test_a_fallback_does_not_hide_an_include_out_of_the_root(root: Path) -> None:
    text = f'<xi:include xmlns:xi="{NEW}" href="../outside/none.xml"><xi:fallback/></xi:include>'
    assert "leaves the folder" in refused(policy(root, text))[0]


@pytest.mark.usefixtures("guarded")
def test_an_include_of_itself_does_not_follow_a_link_that_only_looks_like_it(root: Path) -> None:
    # link/../x.xml is a/x.xml to the system, but x.xml by its text: an empty href must not read the latter
    (root / "a" / "b").mkdir(parents=True)
    (root / "link").symlink_to("a/b")
    (root / "x.xml").symlink_to(root.parent / "outside" / "secret.xml")
    itself = include("", 'xpointer="xpointer(/*/*)"')
    write(root / "a" / "x.xml", f"<profile>{itself}</profile>")
    file = policy(root, include("link/../x.xml"))
    try:
        assert "/secret" not in names(read(file))
    except InputErrors as error:
        assert all(LINE.fullmatch(line) for line in str(error).split("\n"))  # noqa: PT017 - either will do


def test_the_file_that_is_shown_is_the_file_that_was_read(root: Path) -> None:
    (root / "a" / "b").mkdir(parents=True)
    (root / "link").symlink_to("a/b")
    write(root / "x.xml", f"<profile>{topic('above')}</profile>")
    write(root / "a" / "x.xml", f"<profile>{topic('below')}</profile>")
    (grant,) = read(policy(root, include("link/../x.xml"))).grants
    assert grant.name.strip("/") in Path(grant.place.file).read_text()


def test_the_policy_itself_may_be_a_link(root: Path) -> None:  # the user named it
    write(root / "node.xml", f"<profile>{topic('x')}</profile>")
    policy(root.parent / "outside", include("node.xml"), name="real.xml")
    (root / "p.xml").symlink_to(root.parent / "outside" / "real.xml")
    assert names(read(root / "p.xml")) == ["/x"]


def test_the_root_can_be_widened(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>{topic('x')}</profile>")
    file = policy(tmp_path / "robot", include("../common/node.xml"))
    assert "leaves the folder" in refused(file)[0]
    result = read(file, include_root=str(tmp_path))
    assert (names(result), places(result, tmp_path)) == (["/x"], ["common/node.xml:1"])


def test_the_root_can_be_narrowed(tmp_path: Path) -> None:
    write(tmp_path / "node.xml", f"<profile>{topic('x')}</profile>")
    assert (
        "leaves the folder" in refused(policy(tmp_path, include("node.xml")), include_root=str(tmp_path / "robot"))[0]
    )


def test_relative_paths_work_from_where_the_user_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>{topic('x')}</profile>")
    policy(tmp_path / "robot", include("../common/node.xml"))
    monkeypatch.chdir(tmp_path / "robot")
    (grant,) = read_policy("p.xml", include_root="..").grants
    assert str(grant.place) == "../common/node.xml:1"


# ---------------------------------------------------------------- hostile: network, text, DTD, entities


@pytest.fixture
def port() -> Iterator[int]:
    """A port to which nothing connects while a test runs."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        yield server.getsockname()[1]
        with pytest.raises(BlockingIOError):
            server.accept()


@pytest.mark.parametrize(
    "body",
    [
        include("http://127.0.0.1:{port}/node.xml"),
        include("ftp://127.0.0.1:{port}/node.xml"),
        include("//127.0.0.1:{port}/node.xml"),
        include("http%3A//127.0.0.1:{port}/node.xml"),
        include("http://127.0.0.1:{port}/x", 'parse="text"'),
        f'<xi:include xmlns:xi="{NEW}" href="http://127.0.0.1:{{port}}/x"><xi:fallback/></xi:include>',
    ],
)
def test_an_include_from_the_network_is_refused_without_asking(tmp_path: Path, port: int, body: str) -> None:
    (line,) = refused(policy(tmp_path, body.format(port=port)))
    assert line.startswith(f"{tmp_path}/p.xml:1: ")


@pytest.mark.parametrize(
    "doctype",
    [
        "<!DOCTYPE policy>",
        "<!DOCTYPE policy []>",
        '<!DOCTYPE policy SYSTEM "http://127.0.0.1:{port}/p.dtd">',
        '<!DOCTYPE policy PUBLIC "-//x" "http://127.0.0.1:{port}/p.dtd">',
        '<!DOCTYPE policy SYSTEM "{outside}/secret.xml">',
        '<!DOCTYPE policy [<!ENTITY x "y">]>',
        '<!DOCTYPE policy [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE policy [<!ENTITY x SYSTEM "http://127.0.0.1:{port}/x">]>',
        '<!DOCTYPE policy [<!ENTITY x SYSTEM "{outside}/secret.xml">]>',
        '<!DOCTYPE policy [<!ENTITY % x SYSTEM "{outside}/secret.xml"> %x;]>',
        '<!DOCTYPE policy [<!ENTITY % x SYSTEM "http://127.0.0.1:{port}/x"> %x;]>',
        '<!DOCTYPE policy [<!ATTLIST topics publish CDATA "ALLOW">]>',  # a grant by default
    ],
)
@pytest.mark.parametrize("body", ["{text}", "&x;"])
@pytest.mark.usefixtures("guarded")
def test_a_document_type_is_refused_and_nothing_that_it_names_is_read(
    root: Path, port: int, doctype: str, body: str
) -> None:
    text = policy(root, f'<topics publish="ALLOW"><topic>{body}</topic></topics>').read_text()
    file = write(root / "p.xml", doctype.format(port=port, outside=root.parent / "outside") + text)
    for line in refused(file):
        assert line.startswith(f"{root}/p.xml:")


def test_a_document_type_in_an_included_file_is_refused_too(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f'<!DOCTYPE profile [<!ENTITY x "y">]>{HIDDEN}')
    (line,) = refused(policy(tmp_path, include("f.xml")))
    assert line.startswith(f"{tmp_path}/f.xml:1: a document type (DTD) is not read")


@pytest.mark.parametrize("used", ["<topics publish='ALLOW'><topic>&j;</topic></topics>", "<topics publish='&j;'/>"])
def test_an_entity_bomb_is_refused_at_once(tmp_path: Path, used: str) -> None:
    entities = '<!ENTITY a "aaaaaaaaaa">' + "".join(
        f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(9)
    )
    text = f"<!DOCTYPE policy [{entities}]>{policy(tmp_path, used).read_text()}"
    refused(write(tmp_path / "p.xml", text))


@pytest.mark.usefixtures("guarded")
@pytest.mark.parametrize("parse", ["text", "TEXT", "", " xml", "html"])
@pytest.mark.parametrize("href", ["../outside/secret.xml", "node.xml"])
def test_text_is_never_included(root: Path, parse: str, href: str) -> None:  # sros2 lets a file's text into a name
    write(root / "node.xml", HIDDEN)
    (line,) = refused(policy(root, topic(include(href, f'parse="{parse}"')), ""))[:1]
    assert f"include with parse='{parse}'" in line


def test_nothing_is_included_into_a_name(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    assert any("inside <topic>" in line for line in refused(policy(tmp_path, topic(include("f.xml")))))


# ---------------------------------------------------------------- hostile: loops and bombs


@pytest.mark.parametrize("href", ["p.xml", "./p.xml", "down/../p.xml", ""])
@pytest.mark.parametrize("rest", ["", 'xpointer="xpointer(/policy/enclaves/enclave/profiles/profile/*)"'])
def test_a_file_that_includes_itself_is_a_loop(tmp_path: Path, href: str, rest: str) -> None:
    found = refused(policy(tmp_path, include(href, rest)))
    assert any("include loop" in line or "nested deeper" in line for line in found)
    assert all(line.startswith(f"{tmp_path}/p.xml:1: ") for line in found)


def test_two_files_that_include_each_other_are_a_loop(tmp_path: Path) -> None:
    write(tmp_path / "a.xml", f"<profile>\n{include('b.xml')}</profile>")
    write(tmp_path / "b.xml", f"<profile>\n\n{include('a.xml')}</profile>")
    (line,) = refused(policy(tmp_path, include("a.xml")))
    assert line.startswith(f"{tmp_path}/b.xml:3: include loop: ")


def test_a_loop_of_links_is_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "a.xml").symlink_to("b.xml")
    (tmp_path / "b.xml").symlink_to("a.xml")
    (line,) = refused(policy(tmp_path, include("a.xml")))
    assert line.startswith(f"{tmp_path}/p.xml:1: ")


def chain(folder: Path, length: int, times: int = 1) -> None:
    """0.xml includes 1.xml, which includes 2.xml, …, each some times."""
    for i in range(length):
        write(folder / f"{i}.xml", f"<profile>{include(f'{i + 1}.xml') * times}</profile>")
    write(folder / f"{length}.xml", f"<profile>{topic('x')}</profile>")


def test_includes_may_be_nested(tmp_path: Path) -> None:
    chain(tmp_path, 20)
    assert names(read(policy(tmp_path, include("0.xml")))) == ["/x"]


def test_depth_is_bounded(tmp_path: Path) -> None:
    chain(tmp_path, 200)
    (line,) = refused(policy(tmp_path, include("0.xml")))
    assert "includes nested deeper than" in line


def test_a_bomb_that_doubles_at_each_step_is_bounded_by_its_bytes(tmp_path: Path) -> None:
    chain(tmp_path, 30, times=2)
    found = refused(policy(tmp_path, include("0.xml")), max_bytes=200_000)
    assert any("more than 200000 bytes with all includes; allow more with --max-bytes" in line for line in found)
    assert len(found) <= 31  # one per place, however often it is reached


def test_fallbacks_nested_in_fallbacks_are_bounded_too(tmp_path: Path) -> None:
    missing = f'<xi:include xmlns:xi="{NEW}" href="none.xml"><xi:fallback>'
    for i in range(10):
        inner = include(f"{i + 1}.xml") if i < 9 else topic("x")
        write(tmp_path / f"{i}.xml", f"<profile>{missing * 100}{inner}{'</xi:fallback></xi:include>' * 100}</profile>")
    try:
        assert names(read(policy(tmp_path, include("0.xml")))) == ["/x"]
    except InputErrors as error:
        assert "deep" in str(error)  # noqa: PT017 - either will do


def test_a_file_that_is_too_large_is_refused_by_its_size(tmp_path: Path) -> None:
    file = policy(tmp_path, topic("x"))
    size = file.stat().st_size
    assert names(read(file, max_bytes=size)) == ["/x"]
    (line,) = refused(file, max_bytes=size - 1)
    assert f"more than {size - 1} bytes" in line


def test_an_included_file_counts_each_time(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f"<profile>{topic('x')}</profile>")
    file = policy(tmp_path, *[include("f.xml")] * 3)
    size = file.stat().st_size + 3 * (tmp_path / "f.xml").stat().st_size
    assert len(read(file, max_bytes=size).grants) == 3
    assert "more than" in refused(file, max_bytes=size - 1)[0]


@pytest.mark.parametrize("href", [".", "down", "down/", "pipe", "./"])
def test_an_include_of_what_is_no_regular_file_is_refused_and_does_not_wait(tmp_path: Path, href: str) -> None:
    (tmp_path / "down").mkdir()
    os.mkfifo(tmp_path / "pipe")
    (line,) = refused(policy(tmp_path, include(href)))
    assert "is not a regular file" in line


def test_an_endless_device_is_refused(tmp_path: Path) -> None:
    assert "is not a regular file" in refused(Path("/dev/zero"))[0]
    file = policy(tmp_path, include("/dev/zero"))
    assert "leaves the folder" in refused(file)[0]
    assert "is not a regular file" in refused(file, include_root="/")[0]


def test_a_policy_that_is_no_regular_file_is_refused_and_does_not_wait(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert "is not a regular file" in refused(tmp_path / "pipe")[0]
    assert "is not a regular file" in refused(tmp_path)[0]


@pytest.mark.parametrize(
    "href",
    [
        "a" * 300,
        "a%00.xml",
        "%ff.xml",
        "a/" * 2500,
        "p.xml/x.xml",
        "a#b",
        "#",
        "?",
        "%",
        " ",
        "&#10;",
        "~/x",
        "\u202e.xml",
    ],
)
def test_a_strange_href_is_a_problem_of_the_include(tmp_path: Path, href: str) -> None:
    (line,) = refused(policy(tmp_path, include(href)))
    assert line.startswith(f"{tmp_path}/p.xml:1: ")
    assert len(line) < 1000
