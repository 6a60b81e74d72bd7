"""A page with more paths than a browser opens tells the first of each kind, and says how many more there are (S11)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from lxml import html as lxml_html

import rosprivacy
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.page.assessment import Answers
from rosprivacy.report.page.finding_entries import BOUND, share
from rosprivacy.report.page.html import html
from tests.helpers.daily import one_in
from tests.helpers.pages import LANGUAGES, texts, texts_of, told
from tests.helpers.reports import care, policy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.page.outline import Outline

SIDE = 46
VIDEO, VOICE = SIDE * SIDE, SIDE  # findings of each kind


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """2,116 paths of video, 46 of voice, and a sanitizer that none of them passes."""
    return _many(tmp_path_factory.mktemp("many"))


@pytest.fixture(scope="module")
def report(many: dict[str, Any]) -> Outline:
    return told(many)


@pytest.fixture(scope="module")
def root(report: Outline) -> Any:
    return lxml_html.document_fromstring(html(report))


def _many(folder: Path) -> dict[str, Any]:
    profiles: dict[str, tuple[list[str], list[str]]] = {f"camera{i:02}": (["t"], []) for i in range(SIDE)}
    profiles |= {f"cloud{i:02}": ([], ["t"]) for i in range(SIDE)}
    profiles |= {"blur": ([], ["t"])}
    (folder / "p.xml").write_text(policy(profiles), "utf-8")
    (folder / "l.yaml").write_text(
        "labels: 1\nnodes:\n"
        "  /camera*: {source: [Video]}\n"
        "  /camera07: {source: [Video, Voice]}\n"
        "  /cloud*: {leak: [Video, Voice]}\n"
        "  /blur: {sanitizer: {Video: anonymise}}\n",
        "utf-8",
    )
    result = rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml"))
    assert len(result.findings) == VIDEO + VOICE
    return result.document()


def test_the_share_of_a_kind_is_what_the_others_leave() -> None:
    assert share([]) == 0
    assert share([3, 5]) == 5
    for numbers in ([BOUND, BOUND], [1, 2, 3 * BOUND], [700, 700, 700], [BOUND + 1], [1] * (BOUND + 1)):
        each = share(numbers)
        shown = sum(min(number, each) for number in numbers)
        assert BOUND - len(numbers) < shown <= max(BOUND, len(numbers))


@pytest.mark.slow
def test_the_first_paths_of_each_kind_are_told_and_all_are_counted(report: Outline, root: Any) -> None:
    shown = {
        kind: root.xpath(f"count(//article[@class='way'][@data-category='{kind}'])") for kind in ("Video", "Voice")
    }
    assert shown == {"Video": BOUND - VOICE, "Voice": VOICE}
    assert report.opening.headline == f"You have to decide {VIDEO + VOICE:,} things"
    assert {kind.name: (kind.to_assess, kind.not_detailed) for kind in report.kinds} == {
        "Video": (VIDEO, VIDEO - BOUND + VOICE),
        "Voice": (VOICE, 0),
    }
    assert len(report.assessment.risks) == BOUND
    assert report.assessment.unlisted == VIDEO + VOICE - BOUND


@pytest.mark.slow
@pytest.mark.parametrize("language", one_in(3, LANGUAGES))
def test_the_page_says_how_many_it_leaves_out_and_where_they_are(
    many: dict[str, Any], report: Outline, language: str
) -> None:
    words = Words(language)
    left = VIDEO + VOICE - BOUND
    for text in texts_of(report if language == "en" else told(many, language)):
        assert text.count(plain(words.count(left, "entry.left"))) == 2  # at the beginning, and at their kind
        assert plain(words.count(left, "risk.left")) in text


def test_every_link_of_the_page_leads_somewhere(root: Any) -> None:
    there = set(root.xpath("//@id"))
    assert {link for link in root.xpath("//a/@href") if link.startswith("#")} <= {f"#{name}" for name in there}


def test_a_sanitizer_names_the_first_paths_past_it_and_counts_the_others(report: Outline) -> None:
    (row,) = report.inventory.cleanings
    assert [number for _, number in row.past] == list(range(1, 101))
    assert row.remainder == f"and {VIDEO - 100:,} more"


def test_what_a_person_has_answered_is_not_left_out(many: dict[str, Any], report: Outline) -> None:
    last = [entry for entry in report.entries if not entry.detailed][-1]
    answers = Answers({f"risk.{last.id}.measures": "none yet"}, "answers.json", "0" * 64)
    assessment = told(many, answers=answers).assessment
    assert assessment.unmatched == ()
    assert [risk.flow.entries[0].id for risk in assessment.risks if risk.fields[3].text] == [last.id]
    assert len(assessment.risks) == BOUND + 1


def test_a_page_of_few_paths_leaves_nothing_out() -> None:
    assert all(entry.detailed for entry in told(care()).entries)
    assert all("--format json" not in text for text in texts(care()))
