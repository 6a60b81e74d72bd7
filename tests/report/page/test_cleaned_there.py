"""What reaches an element and is said to be cleaned there is told as exactly that, wherever it is told (rule S8)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.page.outline import outline
from tests.helpers.graphs import care_home

if TYPE_CHECKING:
    from rosprivacy.report.page.outline import Outline

LINE = "care-home.labels.yaml:22"


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return care_home().document()


@pytest.fixture(scope="module")
def told(document: dict[str, Any]) -> Outline:
    return outline(document, "en")


def test_the_table_of_recipients_does_not_say_no_path(told: Outline) -> None:
    """Raw video of residents enters the node that talks to the cloud; one label says that it is aggregated there."""
    (uplink,) = (row for row in told.persons.recipients.rows if row.name == "/uplink")
    cells = dict(zip(told.persons.recipients.columns, (cell.text for cell in uplink.cells), strict=True))
    video = cells["video of persons"]
    assert video.startswith("reaches it; said to be cleaned there: aggregates, ")
    assert video.endswith(LINE)
    assert cells["location"] == "–"  # a sanitizer of it, too, but none of it gets there


def test_all_who_read_beside_a_sanitizer_are_named(told: Outline, document: dict[str, Any]) -> None:
    rows = {row.name: row.other_readers for row in told.inventory.cleanings}
    assert rows["/blur"] == (
        "/face_recognizer",
        "/uplink (said to clean it, too)",
    )  # who recognises faces protects nobody
    (blur,) = (row for row in document["sanitizers"] if row["element"]["name"] == "/blur")
    assert [row["name"] for row in blur["cleaning_beside"]] == ["/face_recognizer", "/uplink"]
    assert [place["line"] for place in blur["places"]] == [12]
