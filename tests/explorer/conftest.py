"""What tests of sessions and of their page share."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def hospital(tmp_path: Path) -> Path:
    """The fleet file of a copy of the example."""
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    return tmp_path / "fleet" / "fleet.yaml"
