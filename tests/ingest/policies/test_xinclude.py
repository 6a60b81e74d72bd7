"""XInclude: what policies use."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.analysis.errors import InputErrors
from tests.helpers.includes import (
    CHILDREN,
    HIDDEN,
    NEW,
    OLD,
    include,
    names,
    places,
    policy,
    read,
    refused,
    topic,
    write,
)


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
