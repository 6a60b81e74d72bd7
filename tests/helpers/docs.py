"""The pages of the documentation, as tests read them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

CATEGORIES = ROOT / "docs" / "categories.md"


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text("utf-8"), re.DOTALL)


def hand_written(text: str) -> str:
    """A page without what stands between the marks of ``python -m tests.test_docs``."""
    return re.sub(r"<!-- \w+: written by python -m tests.test_docs -->.*?<!-- end -->", "", text, flags=re.DOTALL)
