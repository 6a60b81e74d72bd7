"""What the user names: files, folders and globs, each read once, in an order of its own (S14)."""

from __future__ import annotations

import os
from contextlib import contextmanager
from itertools import permutations
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import NOT_READ, UNREAD_FILE
from rosprivacy.ingest.policies.policy_files import read_policies
from tests.helpers.includes import LINE, include

if TYPE_CHECKING:
    from collections.abc import Iterator

FRAGMENT = '<profile>\n<topics publish="ALLOW"><topic>x</topic></topics></profile>'


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def write(file: str, text: str = FRAGMENT) -> str:
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    Path(file).write_text(text)
    return file


def policy(file: str, node: str = "a", body: str = "") -> str:
    profiles = f'<profiles><profile ns="/" node="{node}">{body}</profile></profiles>'
    return write(
        file, f'<policy version="0.2.0">\n<enclaves><enclave path="/e">{profiles}</enclave></enclaves></policy>'
    )


def read(*arguments: str) -> list[str]:
    """The files that were read."""
    policies, _ = read_policies(arguments)
    return [policy.file for policy in policies]


def refused(*arguments: str) -> list[str]:
    """Where each problem is; every message is one line that says what to do."""
    with pytest.raises(InputErrors) as caught:
        read_policies(iter(arguments))
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    return [line.split(": ")[0] for line in lines]


class TestFiles:
    def test_a_file_keeps_the_name_that_the_user_gave_and_need_not_end_in_xml(self, tmp_path: Path) -> None:
        policy("robot/p.sros2")
        for file in ("robot/p.sros2", str(tmp_path / "robot" / "p.sros2")):
            assert read(file) == [file]

    @pytest.mark.parametrize("again", ["p.xml", "./p.xml", "../{folder}/p.xml", "{path}/p.xml", ".", "*.xml"])
    def test_a_file_named_twice_is_read_once(self, tmp_path: Path, again: str) -> None:
        policy("p.xml")
        assert len(read("p.xml", again.format(folder=tmp_path.name, path=tmp_path))) == 1

    @pytest.mark.parametrize("name", ["none.xml", "a" * 5000, "a\0b"])
    def test_a_name_that_no_file_has_is_refused(self, name: str) -> None:
        assert len(refused(name)) == 1

    def test_an_empty_name_is_refused_and_not_taken_as_the_current_folder(self) -> None:
        policy("p.xml")  # as "$POLICY" would, if the variable is not set
        assert refused("") == ["''"]

    def test_without_any_name_there_is_nothing_to_read(self) -> None:
        assert refused() == ["nothing"]

    def test_a_fragment_that_was_named_is_not_passed_over(self) -> None:
        assert refused(policy("good.xml"), write("node.xml")) == ["node.xml:1"]


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
@pytest.mark.parametrize("forbidden", ["down/{}", "down"])
@pytest.mark.parametrize(
    ("name", "place"),
    [("p.xml", "{}/down/p.xml"), ("node.xml", "{}/p.xml:2")],
    ids=["a policy", "an include"],
)
def test_what_may_not_be_read_is_refused(tmp_path: Path, forbidden: str, name: str, place: str) -> None:
    write("down/node.xml")
    including = policy(f"{tmp_path}/p.xml", body=include("down/node.xml"))
    file = policy(f"{tmp_path}/down/p.xml") if name == "p.xml" else including
    assert read(file) == [file]
    with no_right_to(tmp_path / forbidden.format(name), tmp_path):
        assert refused(file) == [place.format(tmp_path)]


class TestFolders:
    def test_a_folder_is_read_with_all_xml_below_it_once(self, tmp_path: Path) -> None:
        files = [policy(f"{tmp_path}/{name}") for name in ("b.xml", "a.xml", "deep/er/c.policy.xml", "deep/a.xml")]
        write("README.md", "# not XML")
        Path("folder.xml").mkdir()
        Path("again").symlink_to(tmp_path)
        assert read(str(tmp_path)) == sorted(files)

    def test_xml_counts_in_any_case_and_linked_folders_are_read_once(self) -> None:
        policy("d/P.XML")
        policy("e/q.xml")
        Path("d/e").symlink_to("../e")
        Path("e/back").symlink_to("../d")
        assert read("d") == ["d/P.XML", "d/e/q.xml"]

    @pytest.mark.parametrize("argument", [".", "**/*.xml"])
    def test_fragments_and_other_xml_are_told(self, argument: str) -> None:
        policy("p.xml")
        write("common/node.xml", f"<!-- x -->\n{FRAGMENT}")
        write("package.xml", "<package/>")
        policies, diagnostics = read_policies([argument])
        assert [policy.file for policy in policies] == ["p.xml"]
        assert [(d.code, str(d.severity), str(d.place)) for d in diagnostics] == [
            (UNREAD_FILE, "warning", "common/node.xml:2"),
            (NOT_READ, "notice", "package.xml:1"),
        ]
        assert diagnostics[0].message.startswith("not read: ")  # and not: not read whole

    def test_an_unreadable_file_is_not_passed_over(self) -> None:
        policy("p.xml")
        write("q.xml", "<policy")
        assert refused(".") == ["q.xml:1"]

    @pytest.mark.parametrize("name", ["README.md", "node.xml"])
    def test_a_folder_without_policies_is_refused_even_beside_one_that_has_some(self, name: str) -> None:
        write(f"common/{name}")
        assert refused("common") == ["common"]
        assert refused(policy("good/p.xml"), "common") == ["common"]

    def test_a_dangling_link_is_an_error(self) -> None:
        """Rule S11."""
        policy("p.xml")
        Path("q.xml").symlink_to("none.xml")
        Path("r.xml").symlink_to("r.xml")
        assert refused(".") == ["q.xml", "r.xml"]


class TestGlobs:
    @pytest.mark.parametrize(
        ("pattern", "names"),
        [
            ("*.xml", ["a.xml", "b.xml"]),
            ("?.xml", ["a.xml", "b.xml"]),
            ("[b-z].xml", ["b.xml"]),
            ("**/*.xml", ["a.xml", "b.xml", "down/c.xml"]),
            ("*/c.xml", ["down/c.xml"]),
            ("d*", ["down/c.xml"]),  # a folder
        ],
    )
    def test_it_is_read(self, pattern: str, names: list[str]) -> None:
        for name in ("a.xml", "b.xml", "down/c.xml"):
            policy(name)
        assert read(pattern) == names

    def test_one_that_matches_nothing_is_refused(self) -> None:
        assert refused("*.xml") == ["*.xml"]

    def test_a_file_whose_name_looks_like_one_is_a_file(self) -> None:
        policy("p1.xml")
        assert read(policy("p[1].xml")) == ["p[1].xml"]


class TestAllAtOnce:
    def test_problems_of_all_files_are_reported(self) -> None:
        files = [policy("good.xml"), policy("bad.xml", node=""), write("broken.xml", "<policy>\n"), "none.xml"]
        assert refused(*files, "*.yaml") == ["*.yaml", "bad.xml:2", "broken.xml:2", "none.xml"]

    def test_order_does_not_matter(self) -> None:
        arguments = [policy(f"{node}.xml", node) for node in "cab"]
        results = [read_policies(order) for order in permutations(arguments)]
        assert all(result == results[0] for result in results)
        assert [policy.file for policy in results[0][0]] == sorted(arguments)

    def test_progress_sees_every_file_once(self) -> None:
        arguments = [policy("a.xml"), policy("b.xml")]
        seen: list[str] = []
        read_policies(["."], progress=lambda files: [file for file in files if not seen.append(file)])  # type: ignore[func-returns-value]
        assert seen == arguments

    def test_include_root_and_bounds_hold_for_every_file(self) -> None:
        write("common/node.xml")
        file = policy("robot/p.xml", body=include("../common/node.xml"))
        policies, _ = read_policies([file], include_root=".")
        assert [grant.name for grant in policies[0].grants] == ["/x"]
        with pytest.raises(InputErrors, match="leaves the folder"):
            read_policies([file])
        with pytest.raises(InputErrors, match="more than the bound of 10"):
            read_policies([file], bounds=Bounds(policy_bytes=10))
