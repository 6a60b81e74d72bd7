"""Includes stay below the root; links are followed before it is judged."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.includes import LINE, NEW, include, names, places, policy, read, refused, topic, write


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
