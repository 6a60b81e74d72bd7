"""``docs/`` can be read: each page that people write keeps to a number of words, and all together to a limit.

What the program writes does not count: ``docs/reference/``, and what stands between marks on other pages.
``python -m tests.test_docs_length`` prints the words of each page.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers import reference
from tests.helpers.docs import hand_written
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

DOCS = ROOT / "docs"
IN_ALL = 30_000
EACH = 1_050
PAGES = sorted(page for page in DOCS.rglob("*.md") if not page.is_relative_to(reference.FOLDER))
AT_MOST = {  # pages of another length than EACH; a new one needs a reason as good as theirs
    "database.md": 1_930,
    "decisions.md": 1_850,
    "labels.md": 2_250,
    "linked-data.md": 1_750,
    "method.md": 1_550,
}


def words(page: Path) -> int:
    """Words of a page that people write, its examples among them."""
    return len(hand_written(page.read_text("utf-8")).split())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.name))
def test_a_page_can_be_read(page: Path) -> None:
    limit = AT_MOST.get(page.name, EACH)
    assert words(page) <= limit, f"{page.name}: {words(page)} words; shorten it, or link what stands elsewhere"


def test_all_pages_together() -> None:
    assert sum(words(page) for page in PAGES) <= IN_ALL


def test_the_table_names_pages() -> None:
    assert AT_MOST.keys() <= {page.name for page in PAGES}


def test_the_reference_is_written_by_the_program_alone() -> None:
    assert {file for file in reference.FOLDER.rglob("*") if file.is_file()} == reference.pages().keys()


if __name__ == "__main__":
    print(*(f"{words(page):6} {page.relative_to(DOCS)}" for page in PAGES), sep="\n")
    print(f"{sum(map(words, PAGES)):6} in all")
