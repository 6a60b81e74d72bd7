"""No hint names a package that is not on the index, and each fits how the program was installed."""

from __future__ import annotations

import re
import shlex
import sys

import pytest

from rosprivacy.analysis.installing import command_for, packages
from tests.helpers.paths import ROOT

EXTRAS = ("local", "ontology", "spark", "views")


@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_is_named_by_its_packages(extra: str) -> None:
    names = packages(extra)
    assert names
    declared = (ROOT / "pyproject.toml").read_text("utf-8")
    assert all(f'"{re.match("[A-Za-z0-9_.-]+", name)[0]}' in declared for name in names)  # type: ignore[index] # or fails
    assert shlex.split(command_for(extra)) == [sys.executable, "-m", "pip", "install", *names]


@pytest.mark.parametrize(
    ("prefix", "begins"),
    [
        ("/home/me/pipx/venvs/rosprivacy", "pipx inject rosprivacy "),
        (
            "/home/me/uv/tools/rosprivacy",
            "uv pip install --python /home/me/uv/tools/rosprivacy ",
        ),
    ],
)
def test_a_tool_of_its_own_is_told_how(monkeypatch: pytest.MonkeyPatch, prefix: str, begins: str) -> None:
    monkeypatch.setattr(sys, "prefix", prefix)
    assert command_for("views").startswith(begins)


def test_no_text_asks_for_the_name_of_the_program() -> None:
    for room in ("analysis", "ingest", "ontology", "queries", "report", "src/rosprivacy/cli", "docs"):
        for file in [*(ROOT / room).rglob("*.py"), *(ROOT / room).rglob("*.md")]:
            assert not re.search(r"(pip|pipx|uv)[^\n]* install '?\"?rosprivacy", file.read_text("utf-8")), file
