"""The factory of the paper, before and after its change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def before(examples: Path) -> Path:
    return examples / "factory" / "before.policy.xml"


@pytest.fixture
def runs(examples: Path) -> list[Path]:
    return sorted((examples / "factory").glob("run*.labels.yaml"))
