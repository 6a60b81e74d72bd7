"""The figures of many checkouts are those of anybody's folder: of each what its scan gives, added up."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.helpers.checkouts import put_checkout
from tests.scanned.whole_set import main

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def test_a_folder_of_ones_own_is_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("mine", "2lian+Motion-Stack"):  # the second is called as a system of the labelled set
        put_checkout(tmp_path / name)
    main([str(tmp_path), "--jobs", "1"])
    first, second, *rows = capsys.readouterr().out.splitlines()
    assert first.startswith("2 checkouts, 1 of the 236 systems")
    assert second == "2 give a graph; 0 crashes"
    assert any(row.startswith("| ends of channels | 8 | 2 | 4.0 | ") for row in rows), rows  # with two of /rosout


def test_one_checkout_is_enough(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    put_checkout(tmp_path / "mine")
    main([str(tmp_path), "--jobs", "1"])
    assert "1 give a graph" in capsys.readouterr().out
