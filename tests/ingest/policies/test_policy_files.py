"""What the user names: files, folders and globs, each read once, in an order of its own (S14)."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from itertools import permutations
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_files import read_policies

if TYPE_CHECKING:
    from collections.abc import Iterator

LINE = re.compile(r"[^;]+: .+; .+")
FRAGMENT = '<profile>\n<topics publish="ALLOW"><topic>x</topic></topics></profile>'


def write(file: Path, text: str) -> str:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return str(file)


def policy(file: Path, node: str = "a", body: str = "") -> str:
    profiles = f'<profiles><profile ns="/" node="{node}">{body}</profile></profiles>'
    return write(
        file, f'<policy version="0.2.0">\n<enclaves><enclave path="/e">{profiles}</enclave></enclaves></policy>'
    )


def read(*arguments: str) -> list[str]:
    """The files that were read."""
    policies, _ = read_policies(arguments)
    return [policy.file for policy in policies]


def refused(*arguments: str) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read_policies(arguments)
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    return lines


# ---------------------------------------------------------------- files


def test_a_file_keeps_the_name_that_the_user_gave(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    policy(tmp_path / "robot" / "p.xml")
    monkeypatch.chdir(tmp_path)
    assert read("robot/p.xml") == ["robot/p.xml"]
    assert read(str(tmp_path / "robot" / "p.xml")) == [str(tmp_path / "robot" / "p.xml")]


def test_a_file_named_need_not_end_in_xml(tmp_path: Path) -> None:
    assert len(read(policy(tmp_path / "policy.sros2"))) == 1


@pytest.mark.parametrize("again", ["p.xml", "./p.xml", "../{folder}/p.xml", "{path}/p.xml", ".", "*.xml"])
def test_a_file_named_twice_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, again: str) -> None:
    policy(tmp_path / "p.xml")
    monkeypatch.chdir(tmp_path)
    assert len(read("p.xml", again.format(folder=tmp_path.name, path=tmp_path))) == 1


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    (line,) = refused(str(tmp_path / "none.xml"))
    assert line.startswith(f"{tmp_path}/none.xml: ")
    assert "not found; correct the path" in line


def test_a_file_that_was_named_is_read_or_refused_never_passed_over(tmp_path: Path) -> None:
    good, fragment = policy(tmp_path / "good.xml"), write(tmp_path / "node.xml", FRAGMENT)
    (line,) = refused(good, fragment)
    assert line.startswith(f"{fragment}:1: the root element is <profile>, not <policy>")


def test_a_name_that_no_file_can_have_is_refused() -> None:  # the system says ENAMETOOLONG
    refused("a" * 5000)


def test_a_name_with_a_null_character_is_refused() -> None:
    refused("a\0b")


def test_an_empty_name_is_refused_not_taken_as_the_current_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    policy(tmp_path / "p.xml")  # as "$POLICY" would, if the variable is not set
    monkeypatch.chdir(tmp_path)
    refused("")


def test_without_any_name_there_is_nothing_to_read() -> None:
    assert len(refused()) == 1


@contextmanager
def no_right_to(path: Path, below: Path) -> Iterator[None]:
    """Take the right to read a file or to enter a folder; root, who has every right, becomes nobody for a while."""
    user, nobody = os.geteuid(), 65534
    above = below.parents[:3] if user == 0 else ()
    modes = {place: place.stat().st_mode for place in (path, below, *above)}
    for place, mode in modes.items():
        place.chmod(mode | 0o055)
    path.chmod(0)
    if user == 0:
        os.seteuid(nobody)
    try:
        yield
    finally:
        os.seteuid(user)
        for place, mode in modes.items():
            place.chmod(mode)


@pytest.mark.xdist_group("nobody")  # folders that all workers share are opened for a while
@pytest.mark.parametrize("forbidden", ["down/p.xml", "down"])
def test_a_policy_that_may_not_be_read_is_refused(tmp_path: Path, forbidden: str) -> None:
    file = policy(tmp_path / "down" / "p.xml")
    assert read(file) == [file]
    with no_right_to(tmp_path / forbidden, tmp_path):
        (line,) = refused(file)
    assert line.startswith(f"{file}: ")


@pytest.mark.xdist_group("nobody")  # folders that all workers share are opened for a while
@pytest.mark.parametrize("forbidden", ["down/node.xml", "down"])
def test_an_include_that_may_not_be_read_is_refused(tmp_path: Path, forbidden: str) -> None:
    write(tmp_path / "down" / "node.xml", FRAGMENT)
    xi = 'xmlns:xi="http://www.w3.org/2001/XInclude" xpointer="xpointer(/profile/*)"'
    file = policy(tmp_path / "p.xml", body=f'<xi:include href="down/node.xml" {xi}/>')
    assert read(file) == [file]
    with no_right_to(tmp_path / forbidden, tmp_path):
        (line,) = refused(file)
    assert line.startswith(f"{file}:2: ")


# ---------------------------------------------------------------- folders


def test_a_folder_is_read_with_all_below_it(tmp_path: Path) -> None:
    files = [policy(tmp_path / name) for name in ("b.xml", "a.xml", "deep/er/c.policy.xml", "deep/a.xml")]
    assert read(str(tmp_path)) == sorted(files)


def test_a_folder_passes_over_what_does_not_end_in_xml(tmp_path: Path) -> None:
    policy(tmp_path / "p.xml")
    write(tmp_path / "README.md", "# not XML")
    (tmp_path / "folder.xml").mkdir()
    assert read(str(tmp_path)) == [str(tmp_path / "p.xml")]


def test_fragments_and_other_xml_of_a_folder_are_told(tmp_path: Path) -> None:
    policy(tmp_path / "p.xml")
    write(tmp_path / "common" / "node.xml", f"<!-- x -->\n{FRAGMENT}")
    write(tmp_path / "package.xml", "<package/>")
    policies, notices = read_policies([str(tmp_path)])
    assert [Path(policy.file).name for policy in policies] == ["p.xml"]
    hint = "name the policy that does, or remove it"
    unknown = f"no policy read here includes it, so what it grants is not known; {hint}"
    shown = [(str(n.severity), str(n.place).removeprefix(f"{tmp_path}/"), n.message) for n in notices]
    assert shown == [
        (
            "warning",
            "common/node.xml:2",
            f"not read: the root element is <profile>, not <policy>, and {unknown}",
        ),
        ("notice", "package.xml:1", "not read by itself: the root element is <package>, not <policy>"),
    ]


def test_an_unreadable_file_of_a_folder_is_not_passed_over(tmp_path: Path) -> None:
    policy(tmp_path / "p.xml")
    write(tmp_path / "q.xml", "<policy")
    (line,) = refused(str(tmp_path))
    assert line.startswith(f"{tmp_path}/q.xml:1: not well-formed XML")


def test_a_folder_without_xml_is_refused(tmp_path: Path) -> None:
    write(tmp_path / "README.md", "")
    assert refused(str(tmp_path)) == [f"{tmp_path}: a folder with no .xml file; name a policy"]


def test_a_folder_without_policies_is_refused(tmp_path: Path) -> None:
    write(tmp_path / "node.xml", FRAGMENT)
    (line,) = refused(str(tmp_path))
    assert line.startswith(f"{tmp_path}: no SROS 2 policy found; ")


def test_a_folder_without_policies_is_refused_beside_one_that_has_some(tmp_path: Path) -> None:
    good = policy(tmp_path / "good" / "p.xml")  # 'a folder without any policy is an error' (files.py)
    write(tmp_path / "common" / "node.xml", FRAGMENT)
    assert read(good) == [good]
    (line,) = refused(good, str(tmp_path / "common"))
    assert line.startswith(f"{tmp_path / 'common'}: ")


def test_a_folder_that_links_to_itself_is_read_once(tmp_path: Path) -> None:
    file = policy(tmp_path / "p.xml")
    (tmp_path / "again").symlink_to(tmp_path)
    assert read(str(tmp_path)) == [file]


def test_a_dangling_link_in_a_folder_is_an_error(tmp_path: Path) -> None:  # rule S11
    policy(tmp_path / "p.xml")
    (tmp_path / "q.xml").symlink_to("none.xml")
    (tmp_path / "r.xml").symlink_to("r.xml")
    assert refused(str(tmp_path)) == [
        f"{tmp_path}/q.xml: a link to nothing: none.xml; correct the link, or remove it",
        f"{tmp_path}/r.xml: a link to nothing: r.xml; correct the link, or remove it",
    ]


# ---------------------------------------------------------------- globs


@pytest.mark.parametrize(
    ("pattern", "names"),
    [
        ("*.xml", ["a.xml", "b.xml"]),
        ("?.xml", ["a.xml", "b.xml"]),
        ("[b-z].xml", ["b.xml"]),
        ("**/*.xml", ["a.xml", "b.xml", "down/c.xml"]),
        ("*/c.xml", ["down/c.xml"]),
    ],
)
def test_a_glob_is_read(tmp_path: Path, pattern: str, names: list[str]) -> None:
    for name in ("a.xml", "b.xml", "down/c.xml"):
        policy(tmp_path / name)
    assert [file.removeprefix(f"{tmp_path}/") for file in read(f"{tmp_path}/{pattern}")] == names


def test_a_glob_passes_over_fragments_with_a_notice(tmp_path: Path) -> None:
    policy(tmp_path / "p.xml")
    write(tmp_path / "node.xml", FRAGMENT)
    policies, notices = read_policies([f"{tmp_path}/*.xml"])
    assert (len(policies), len(notices)) == (1, 1)


def test_a_glob_that_matches_nothing_is_refused(tmp_path: Path) -> None:
    assert refused(f"{tmp_path}/*.xml") == [f"{tmp_path}/*.xml: no file matches; correct the pattern"]


def test_a_file_whose_name_looks_like_a_glob_is_a_file(tmp_path: Path) -> None:
    file = policy(tmp_path / "p[1].xml")
    policy(tmp_path / "p1.xml")
    assert read(file) == [file]


# ---------------------------------------------------------------- all at once


def test_problems_of_all_files_are_reported_at_once(tmp_path: Path) -> None:
    arguments = [
        policy(tmp_path / "good.xml"),
        policy(tmp_path / "bad.xml", node=""),
        write(tmp_path / "broken.xml", "<policy>\n"),
        str(tmp_path / "none.xml"),
        str(tmp_path / "*.yaml"),
    ]
    found = [line.removeprefix(f"{tmp_path}/").split(": ")[0] for line in refused(*arguments)]
    assert found == ["*.yaml", "bad.xml:2", "broken.xml:2", "none.xml"]


def test_order_does_not_matter(tmp_path: Path) -> None:
    arguments = [policy(tmp_path / f"{node}.xml", node) for node in "cab"]
    results = [read_policies(order) for order in permutations(arguments)]
    assert all(result == results[0] for result in results)
    assert [policy.file for policy in results[0][0]] == sorted(arguments)


def test_arguments_may_come_from_a_generator(tmp_path: Path) -> None:  # Iterable[str]
    with pytest.raises(InputErrors, match=re.escape(f"{tmp_path}: ")):
        read_policies(iter([str(tmp_path)]))
    write(tmp_path / "node.xml", FRAGMENT)
    with pytest.raises(InputErrors, match=re.escape(f"{tmp_path}: ")):
        read_policies(iter([str(tmp_path)]))


def test_progress_sees_every_file_once(tmp_path: Path) -> None:
    seen: list[str] = []

    def progress(files: object) -> list[str]:
        assert isinstance(files, list)
        seen.extend(files)
        return files

    policy(tmp_path / "a.xml")
    policy(tmp_path / "b.xml")
    read_policies([str(tmp_path)], progress=progress)
    assert seen == [str(tmp_path / "a.xml"), str(tmp_path / "b.xml")]


def test_include_root_and_bounds_hold_for_every_file(tmp_path: Path) -> None:
    write(tmp_path / "common" / "node.xml", FRAGMENT)
    xi = 'xmlns:xi="http://www.w3.org/2001/XInclude" xpointer="xpointer(/profile/*)"'
    file = policy(tmp_path / "robot" / "p.xml", body=f'<xi:include href="../common/node.xml" {xi}/>')
    policies, _ = read_policies([file], include_root=str(tmp_path))
    assert [grant.name for grant in policies[0].grants] == ["/x"]
    with pytest.raises(InputErrors, match="leaves the folder"):
        read_policies([file])
    with pytest.raises(InputErrors, match="more than the bound of 10"):
        read_policies([file], bounds=Bounds(policy_bytes=10))
