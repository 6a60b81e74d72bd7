"""XInclude: what policies use."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.analysis.model import FALLBACK_TAKEN
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

ENCLAVE = '<enclave path="/e"><profiles>{}</profiles></enclave>'
FRAGMENT = f"<profile>{topic('x')}</profile>"


def missing(fallback: str, namespace: str = NEW, href: str = "none.xml") -> str:
    inner = f"<xi:fallback>{fallback}</xi:fallback>"
    return f'<xi:include xmlns:xi="{namespace}" href="{href}" {CHILDREN}>{inner}</xi:include>'


@pytest.mark.parametrize("namespace", [NEW, OLD])
def test_both_namespaces_are_read_with_their_fallback(tmp_path: Path, namespace: str) -> None:
    write(tmp_path / "f.xml", FRAGMENT)
    assert names(read(policy(tmp_path, include("f.xml", namespace=namespace)))) == ["/x"]
    result = read(policy(tmp_path, missing(f"\n{topic('b')}", namespace)))
    assert (names(result), places(result, tmp_path)) == (["/b"], ["p.xml:2"])
    assert [(d.code, d.place.line) for d in result.diagnostics] == [(FALLBACK_TAKEN, 1)]


def test_a_grant_of_an_include_names_its_file_and_line_and_is_of_the_profile_that_includes(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>\n\n{topic('~/state')}</profile>")
    common = include("common/node.xml")
    result = read(policy(tmp_path, topic("x") + common + topic("y"), common))
    assert [f"{grant.node} {grant.name}" for grant in result.grants] == [
        "/a /x", "/a /a/state", "/a /y", "/b /b/state",
    ]  # fmt: skip
    assert places(result, tmp_path) == ["p.xml:1", "common/node.xml:3", "p.xml:1", "common/node.xml:3"]
    assert [Path(file).name for file, _ in result.sources] == ["node.xml", "p.xml"]


def test_hrefs_are_relative_to_the_including_file_and_may_be_escaped(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", f"<profile>{include('node/log%20file.xml')}</profile>")
    write(tmp_path / "common" / "node" / "log file.xml", f"<profile>{include('../time.xml')}{topic('x')}</profile>")
    write(tmp_path / "common" / "time.xml", f"<profile>{topic('clock')}</profile>")
    write(tmp_path / "node" / "log file.xml", HIDDEN)
    result = read(policy(tmp_path, include("common/node.xml")))
    assert places(result, tmp_path) == ["common/time.xml:1", "common/node/log file.xml:1"]


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
    ("xpointer", "around"),
    [
        ("/policy/enclaves/enclave/profiles/*", f"<enclaves>{ENCLAVE}</enclaves>"),
        ("/policy/enclaves/*", "<enclaves>{}</enclaves>"),
        ("/policy/enclaves", "{}"),
    ],
)
def test_the_xpointers_of_public_policies_are_read(tmp_path: Path, xpointer: str, around: str) -> None:
    policy(tmp_path, topic("x"), name="inner.xml")
    pointed = around.format(include("inner.xml", f'xpointer="xpointer({xpointer})"'))
    result = read(write(tmp_path / "p.xml", f'<policy version="0.2.0">{pointed}</policy>'))
    assert names(result) == ["/x"]
    assert [(profile.node, Path(profile.place.file).name) for profile in result.profiles] == [("/a", "inner.xml")]


@pytest.mark.parametrize(
    "xpointer",
    ["profile", "element(/1)", "xpointer(//a)", "xpointer(/a/*)xpointer(/x)", "xpointer(id('a'))", "(", "xpointer()"],
)
def test_another_xpointer_is_refused_by_its_text(tmp_path: Path, xpointer: str) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    (line,) = refused(policy(tmp_path, include("f.xml", f'xpointer="{xpointer}"')))
    assert xpointer in line
    assert "is not supported" in line


def test_an_xpointer_that_selects_nothing_is_a_warning(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    result = read(policy(tmp_path, include("f.xml", 'xpointer="xpointer(/profil/*)"')))
    (diagnostic,) = result.diagnostics
    assert (result.grants, str(diagnostic.severity), diagnostic.place.line) == ((), "warning", 1)


def test_a_fallback_may_include_and_may_be_empty_and_is_not_used_for_a_file_that_is_there(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", FRAGMENT)
    assert names(read(policy(tmp_path, missing(missing(include("f.xml")))))) == ["/x"]
    assert names(read(policy(tmp_path, missing("")))) == []
    assert names(read(policy(tmp_path, missing(topic("b"), href="f.xml")))) == ["/x"]


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        ("\n" + include("none.xml"), "p.xml:2: included file 'none.xml' not found"),
        (include("f.xml", namespace="urn:x"), "p.xml:1: <include> under <profile>"),
        (f'<xi:fallback xmlns:xi="{NEW}"/>', "p.xml:1: <fallback> outside <xi:include>"),
        (missing("rosout"), "p.xml:1: text in <fallback>"),  # it would stand between the elements
        (include("bad.xml") * 5, "bad.xml:2: publish='YES' on <topics>"),  # once, however many include it
        (include("f.xml", f'{CHILDREN} xml:base="common/"'), "p.xml:1: xml:base is not read"),  # XInclude 4.2.1
    ],
)
def test_what_is_refused_is_told_where_it_stands(tmp_path: Path, body: str, problem: str) -> None:
    write(tmp_path / "f.xml", FRAGMENT)
    write(tmp_path / "bad.xml", '<profile>\n<topics publish="YES"><topic>x</topic></topics></profile>')
    (line,) = refused(policy(tmp_path, body))
    assert line.startswith(f"{tmp_path}/{problem}")


def test_problems_of_the_policy_and_its_includes_are_reported_together(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", "<profile>\n<domain/></profile>")
    write(tmp_path / "g.xml", "<profile>\n")
    lines = refused(policy(tmp_path, f"{include('f.xml')}\n{include('g.xml')}{include('none.xml')}<topic/>"))
    places = [line.split(": ")[0].removeprefix(f"{tmp_path}/") for line in lines]
    assert places == ["f.xml:2", "g.xml:2", "p.xml:2", "p.xml:2"]
