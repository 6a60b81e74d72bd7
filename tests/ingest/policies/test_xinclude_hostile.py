"""Includes that mean harm: network, text, document types, loops and bombs."""

from __future__ import annotations

import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import InputErrors

if TYPE_CHECKING:
    from collections.abc import Iterator

from tests.helpers.includes import HIDDEN, NEW, include, names, policy, read, refused, topic, write


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
    found = refused(policy(tmp_path, include("0.xml")), bounds=Bounds(policy_bytes=200_000))
    assert any("raise it with --bound policy_bytes=N" in line for line in found)
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
    assert names(read(file, bounds=Bounds(policy_bytes=size))) == ["/x"]
    (line,) = refused(file, bounds=Bounds(policy_bytes=size - 1))
    assert f"more than the bound of {size - 1}" in line


def test_an_included_file_counts_each_time(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f"<profile>{topic('x')}</profile>")
    file = policy(tmp_path, *[include("f.xml")] * 3)
    size = file.stat().st_size + 3 * (tmp_path / "f.xml").stat().st_size
    assert len(read(file, bounds=Bounds(policy_bytes=size)).grants) == 3
    assert "more than" in refused(file, bounds=Bounds(policy_bytes=size - 1))[0]


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
