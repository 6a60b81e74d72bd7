"""Includes that mean harm: out of the root, network, text, document types, loops and bombs."""

from __future__ import annotations

import os
import socket
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.includes import HIDDEN, LINE, NEW, include, names, places, policy, read, refused, topic, write

if TYPE_CHECKING:
    from collections.abc import Iterator

FRAGMENT = f"<profile>{topic('x')}</profile>"
ITSELF = 'xpointer="xpointer(/policy/enclaves/enclave/profiles/profile/*)"'


@pytest.fixture
def port() -> Iterator[int]:
    """A port to which nothing connects while a test runs."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        yield server.getsockname()[1]
        with pytest.raises(BlockingIOError):
            server.accept()


class TestOutOfTheRoot:
    """Includes stay below the root; links are followed before it is judged."""

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
    def test_it_reads_nothing(self, root: Path, href: str) -> None:
        outside = root.parent / "outside"
        (root / "down").mkdir()
        (root / "link.xml").symlink_to(outside / "secret.xml")
        (root / "away").symlink_to(outside)
        (root / "link-to-link.xml").symlink_to("link.xml")
        (line,) = refused(policy(root, f"\n{include(href.format(outside=outside))}"))
        assert line.startswith(f"{root}/p.xml:2: ")

    @pytest.mark.usefixtures("guarded")
    def test_a_fallback_does_not_hide_it(self, root: Path) -> None:
        text = f'<xi:include xmlns:xi="{NEW}" href="../outside/none.xml"><xi:fallback/></xi:include>'
        (line,) = refused(policy(root, text))
        assert f"'../outside/none.xml' leaves the folder {root}" in line
        assert "--include-root" in line

    @pytest.mark.usefixtures("guarded")
    def test_an_include_of_itself_does_not_follow_a_link_that_only_looks_like_it(self, root: Path) -> None:
        """link/../x.xml is a/x.xml to the system, but x.xml by its text: an empty href must not read the latter."""
        (root / "a" / "b").mkdir(parents=True)
        (root / "link").symlink_to("a/b")
        (root / "x.xml").symlink_to(root.parent / "outside" / "secret.xml")
        itself = include("", 'xpointer="xpointer(/*/*)"')
        write(root / "a" / "x.xml", f"<profile>{itself}</profile>")
        try:
            assert "/secret" not in names(read(policy(root, include("link/../x.xml"))))
        except InputErrors as error:
            assert all(LINE.fullmatch(line) for line in str(error).split("\n"))  # noqa: PT017 - either will do

    def test_the_file_that_is_shown_is_the_file_that_was_read(self, root: Path) -> None:
        (root / "a" / "b").mkdir(parents=True)
        (root / "link").symlink_to("a/b")
        write(root / "x.xml", f"<profile>{topic('above')}</profile>")
        write(root / "a" / "x.xml", f"<profile>{topic('below')}</profile>")
        (grant,) = read(policy(root, include("link/../x.xml"))).grants
        assert grant.name.strip("/") in Path(grant.place.file).read_text()

    def test_the_policy_itself_may_be_a_link(self, root: Path) -> None:
        """The user named it."""
        write(root / "node.xml", FRAGMENT)
        policy(root.parent / "outside", include("node.xml"), name="real.xml")
        (root / "p.xml").symlink_to(root.parent / "outside" / "real.xml")
        assert names(read(root / "p.xml")) == ["/x"]

    def test_the_root_can_be_widened_and_narrowed(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        write(tmp_path / "common" / "node.xml", FRAGMENT)
        file = policy(tmp_path / "robot", include("../common/node.xml"))
        assert "leaves the folder" in refused(file)[0]
        assert places(read(file, include_root=str(tmp_path)), tmp_path) == ["common/node.xml:1"]
        monkeypatch.chdir(tmp_path / "robot")
        assert str(read_policy("p.xml", include_root="..").grants[0].place) == "../common/node.xml:1"
        inside = policy(tmp_path, include("common/node.xml"))
        assert "leaves the folder" in refused(inside, include_root=str(tmp_path / "robot"))[0]


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
@pytest.mark.parametrize("name", ["x", "&x;"])
@pytest.mark.usefixtures("guarded")
def test_a_document_type_is_refused_and_nothing_that_it_names_is_read(
    root: Path, port: int, doctype: str, name: str
) -> None:
    text = doctype.format(port=port, outside=root.parent / "outside") + policy(root, topic(name)).read_text()
    assert all(line.startswith(f"{root}/p.xml:") for line in refused(write(root / "p.xml", text)))


def test_a_document_type_in_an_included_file_is_refused_too(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", f'<!DOCTYPE profile [<!ENTITY x "y">]>{HIDDEN}')
    (line,) = refused(policy(tmp_path, include("f.xml")))
    assert line.startswith(f"{tmp_path}/f.xml:1: a document type (DTD) is not read")


@pytest.mark.parametrize("used", ["<topics publish='ALLOW'><topic>&j;</topic></topics>", "<topics publish='&j;'/>"])
def test_an_entity_bomb_is_refused_at_once(tmp_path: Path, used: str) -> None:
    entities = "".join(f'<!ENTITY {after} "{f"&{one};" * 10}">' for one, after in pairwise("abcdefghij"))
    text = f'<!DOCTYPE policy [<!ENTITY a "aaaaaaaaaa">{entities}]>{policy(tmp_path, used).read_text()}'
    refused(write(tmp_path / "p.xml", text))


@pytest.mark.usefixtures("guarded")
@pytest.mark.parametrize("parse", ["text", "TEXT", "", " xml", "html"])
@pytest.mark.parametrize("href", ["../outside/secret.xml", "node.xml"])
def test_text_is_never_included(root: Path, parse: str, href: str) -> None:
    """sros2 lets a file's text into a name."""
    write(root / "node.xml", HIDDEN)
    line = refused(policy(root, topic(include(href, f'parse="{parse}"')), ""))[0]
    assert f"include with parse='{parse}'" in line


def test_nothing_is_included_into_a_name(tmp_path: Path) -> None:
    write(tmp_path / "f.xml", HIDDEN)
    assert any("inside <topic>" in line for line in refused(policy(tmp_path, topic(include("f.xml")))))


@pytest.mark.parametrize("href", ["p.xml", "./p.xml", "down/../p.xml", ""])
@pytest.mark.parametrize("rest", ["", ITSELF])
def test_a_file_that_includes_itself_is_a_loop(tmp_path: Path, href: str, rest: str) -> None:
    for line in refused(policy(tmp_path, include(href, rest))):
        assert line.startswith(f"{tmp_path}/p.xml:1: include")


def test_two_files_that_include_each_other_are_a_loop(tmp_path: Path) -> None:
    write(tmp_path / "a.xml", f"<profile>\n{include('b.xml')}</profile>")
    write(tmp_path / "b.xml", f"<profile>\n\n{include('a.xml')}</profile>")
    (line,) = refused(policy(tmp_path, include("a.xml")))
    assert line.startswith(f"{tmp_path}/b.xml:3: include loop: ")


class TestBounds:
    def chain(self, folder: Path, length: int, times: int = 1) -> Path:
        """0.xml includes 1.xml, which includes 2.xml, …, each some times."""
        for i in range(length):
            write(folder / f"{i}.xml", f"<profile>{include(f'{i + 1}.xml') * times}</profile>")
        write(folder / f"{length}.xml", FRAGMENT)
        return policy(folder, include("0.xml"))

    def test_of_depth(self, tmp_path: Path) -> None:
        assert names(read(self.chain(tmp_path, 20))) == ["/x"]
        (line,) = refused(self.chain(tmp_path, 200))
        assert "includes nested deeper than" in line

    def test_of_bytes_of_a_bomb_that_doubles_at_each_step(self, tmp_path: Path) -> None:
        lines = refused(self.chain(tmp_path, 30, times=2), bounds=Bounds(policy_bytes=200_000))
        assert any("raise it with --bound policy_bytes=N" in line for line in lines)
        assert len(lines) <= 31  # one per place, however often it is reached

    def test_of_fallbacks_nested_in_fallbacks(self, tmp_path: Path) -> None:
        begin = f'<xi:include xmlns:xi="{NEW}" href="none.xml"><xi:fallback>' * 100
        end = "</xi:fallback></xi:include>" * 100
        for i in range(10):
            inner = include(f"{i + 1}.xml") if i < 9 else topic("x")
            write(tmp_path / f"{i}.xml", f"<profile>{begin}{inner}{end}</profile>")
        assert "deep" in refused(policy(tmp_path, include("0.xml")))[0]

    def test_of_bytes_where_an_included_file_counts_each_time(self, tmp_path: Path) -> None:
        write(tmp_path / "f.xml", FRAGMENT)
        for times in (0, 3):
            file = policy(tmp_path, topic("x"), *[include("f.xml")] * times)
            size = file.stat().st_size + times * len(FRAGMENT)
            assert len(read(file, bounds=Bounds(policy_bytes=size)).grants) == 1 + times
            assert f"more than the bound of {size - 1}" in refused(file, bounds=Bounds(policy_bytes=size - 1))[0]


@pytest.mark.parametrize("href", [".", "down", "down/", "pipe", "./"])
def test_what_is_no_regular_file_is_refused_and_does_not_wait(tmp_path: Path, href: str) -> None:
    (tmp_path / "down").mkdir()
    os.mkfifo(tmp_path / "pipe")
    assert "is not a regular file" in refused(policy(tmp_path, include(href)))[0]
    assert "is not a regular file" in refused(tmp_path / href)[0]


def test_an_endless_device_is_refused(tmp_path: Path) -> None:
    assert "is not a regular file" in refused(Path("/dev/zero"))[0]
    assert "is not a regular file" in refused(policy(tmp_path, include("/dev/zero")), include_root="/")[0]


@pytest.mark.parametrize(
    "href",
    [
        "a" * 300, "a%00.xml", "%ff.xml", "a/" * 2500, "p.xml/x.xml", "a#b", "#", "?", "%", " ", "&#10;", "~/x",
        "\u202e.xml", "ring.xml",
    ],
)  # fmt: skip
def test_a_strange_href_is_a_problem_of_the_include(tmp_path: Path, href: str) -> None:
    (tmp_path / "ring.xml").symlink_to("ring2.xml")
    (tmp_path / "ring2.xml").symlink_to("ring.xml")
    (line,) = refused(policy(tmp_path, include(href)))
    assert line.startswith(f"{tmp_path}/p.xml:1: ")
    assert len(line) < 1000
