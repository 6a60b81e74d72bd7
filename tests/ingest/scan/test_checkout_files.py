"""A checkout is what is built: tests, code of others and what links lead out to are no part of it, and that is said."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.checkout_files import checkout_files, joined_files

if TYPE_CHECKING:
    from pathlib import Path


def put(root: Path, *names: str) -> None:
    for name in names:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text("")


def test_what_is_not_built_is_left_out_and_named(tmp_path: Path) -> None:
    put(tmp_path, "a/x.py", "a/test/t.py", "b/COLCON_IGNORE", "b/y.py", "third_party/z.py", ".git/config", "build/m.py")
    found = checkout_files(tmp_path)
    assert found.files == ("a/x.py",)
    assert found.left_out == ("a/test", "b", "build", "third_party")


def test_a_link_that_leads_out_is_a_gap_and_not_followed(tmp_path: Path) -> None:
    put(tmp_path, "outside/secret.py", "checkout/a.py")
    (tmp_path / "checkout" / "away").symlink_to(tmp_path / "outside")
    (tmp_path / "checkout" / "b.py").symlink_to("a.py")
    found = checkout_files(tmp_path / "checkout")
    assert found.files == ("a.py", "b.py")
    assert [(gap.place.file, gap.sort) for gap in found.gaps] == [("away", "file")]


def test_folders_that_link_to_each_other_end(tmp_path: Path) -> None:
    put(tmp_path, "a/x.py")
    (tmp_path / "a" / "round").symlink_to(tmp_path)
    assert checkout_files(tmp_path).files == ("a/x.py",)


def test_several_folders_are_read_from_the_one_above_them_each_file_once(tmp_path: Path) -> None:
    put(tmp_path, "a/src/x.py", "b/x.py", "b/test/t.py", "c/z.py")
    found = joined_files([str(tmp_path / name) for name in ("b", "a", "a/src")])
    assert (found.root, found.parts) == (str(tmp_path), ("a", "b"))
    assert (found.files, found.left_out) == (("a/src/x.py", "b/x.py"), ("b/test",))


def test_a_folder_and_what_lies_in_it_are_that_folder(tmp_path: Path) -> None:
    put(tmp_path, "a/x.py")
    assert joined_files([str(tmp_path), str(tmp_path / "a")]) == checkout_files(tmp_path)
