"""Templates are compiled once, as Python's modules are, and a file that is no such thing is never run."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest
from jinja2 import Environment, FileSystemLoader

from rosprivacy.report.page.spaced_templates import CompiledTemplates

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def _writes_bytecode(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", False)


def rendered(folder: Path, variant: str = "") -> str:
    loader, cache = FileSystemLoader(folder), CompiledTemplates(folder, variant)
    return Environment(loader=loader, bytecode_cache=cache, autoescape=True).get_template("t.j2").render(x="<")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "t.j2").write_text("{{ x }} one")
    return tmp_path


def compiled(folder: Path) -> list[Path]:
    return sorted(folder.glob("__pycache__/*"))


def test_what_is_compiled_is_read_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert rendered(folder) == "&lt; one"
    assert len(compiled(folder)) == 1
    monkeypatch.delattr(Environment, "_generate")  # what compiles
    assert rendered(folder) == "&lt; one"


def test_another_text_of_a_template_is_compiled_anew(folder: Path) -> None:
    rendered(folder)
    (folder / "t.j2").write_text("{{ x }} two")
    assert rendered(folder) == "&lt; two"
    assert len(compiled(folder)) == 1


def test_variants_stand_beside_each_other(folder: Path) -> None:
    assert rendered(folder, "en") == rendered(folder, "fr")
    assert len(compiled(folder)) == 2


def test_a_damaged_file_is_compiled_anew(folder: Path) -> None:
    rendered(folder)
    (file,) = compiled(folder)
    whole = file.read_bytes()
    for damaged in (b"", b"x" + whole, *(whole[:length] for length in range(0, len(whole), 7))):
        file.write_bytes(damaged)
        assert rendered(folder) == "&lt; one"


def test_without_leave_to_write_nothing_is_written(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "__pycache__").write_text("a file stands where the folder would")
    assert rendered(folder) == "&lt; one"
    (folder / "__pycache__").unlink()
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert rendered(folder) == "&lt; one"
    assert compiled(folder) == []
