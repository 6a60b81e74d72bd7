"""A policy in a folder beside one that it may not read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

from tests.fuzzing.mutations import Guard
from tests.helpers.includes import HIDDEN, write


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "root").mkdir()
    write(tmp_path / "outside" / "secret.xml", HIDDEN)
    return tmp_path / "root"


@pytest.fixture
def guarded(root: Path) -> Iterator[None]:
    """Nothing outside of the root is opened, by Python or by libxml2."""
    with Guard(root.parent / "outside") as guard:
        yield
        assert guard.check() == []
