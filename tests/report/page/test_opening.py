"""What a report begins with: what there is to decide, the worst first, each flow once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.report.catalogs.words import plain, table
from rosprivacy.report.document.ledger import by_globs
from tests.helpers.abroad import abroad
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, page, texts, told
from tests.helpers.reports import care, decide, fleet, run, with_decisions, with_outside

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.page.flows import ToDecide

FACTS = ["whose", "law", "basis", "owner", "state"]


def flow(row: ToDecide) -> tuple[str, str, str]:
    return row.data, row.source, row.leak


def test_the_report_begins_with_what_is_to_be_decided_the_worst_first() -> None:
    opening = told(care()).opening
    assert told(care()).sections[0] == ("decide", opening.headline)
    assert opening.headline == "You have to decide 3 things"
    assert [flow(row) for row in opening.rows] == [
        ("face template", "/camera", "/uplink"),
        ("voice", "/microphone", "/uplink"),
        ("video of persons (pseudonymised)", "/camera", "/recorder"),
    ]
    assert opening.gist == (
        "Face template, voice can get to /uplink; video of persons (pseudonymised) can get to /recorder."
    )
    first = dict(opening.rows[0].facts)
    assert list(first) == FACTS
    assert first["whose"] == "residents, staff, visitors"
    assert first["law"] == "Article 6; GDPR Art. 9(1) biometric data"
    assert (first["basis"], first["owner"]) == ("", "")
    assert first["state"] == "to assess"


@pytest.mark.parametrize("language", LANGUAGES)
def test_page_one_names_the_controller_and_the_purpose_or_says_that_they_are_missing(
    language: str, tmp_path: Path
) -> None:
    for document, stated in ((abroad(tmp_path), True), (care(), False)):
        report = told(document, language)
        frame = dict(report.opening.frame)
        missing = report.words("record.open")
        assert frame[report.words("column.controllers")] == ("Yard GmbH" if stated else missing)
        assert frame[report.words("opening.purpose")] == ("protection of the yard" if stated else missing)
        for text in texts(document, language):
            before, _, after = text.partition(plain(report.opening.cards[0].data))
            assert after
            assert all(plain(report.words.pair(what, value)) in before for what, value in frame.items())


def test_a_controller_of_some_data_only_is_still_to_be_completed(tmp_path: Path) -> None:
    document = abroad(tmp_path)
    row = document["register"][0]
    row |= {"controllers": [], "to_complete": [*row["to_complete"], "controllers"]}
    assert dict(told(document).opening.frame)["Controller"] == "Yard GmbH; to be completed"


def test_a_page_links_each_line_of_a_card_to_its_paths() -> None:
    root = page(care())
    (first, *_) = root.xpath("//main/section")
    assert first.get("id") == "decide"
    lines = first.xpath(".//ol[@class='decide']/li/ul/li")
    assert [line.xpath(".//a/@href") for line in lines] == [
        [f"#{entry.anchor}" for entry in line.entries] for card in told(care()).opening.cards for line in card.lines
    ]


def test_one_flow_that_is_two_findings_is_decided_once() -> None:
    report = told(hospital().document())
    cloud = [row for row in report.opening.rows if row.leak == "hospital:fleet cloud"]
    assert len(cloud) == 1
    assert cloud[0].kinds == ("disclosure", "transfer to a third country")
    assert len(cloud[0].entries) == 2
    assert dict(cloud[0].facts)["law"] == "Article 6; GDPR Art. 9(1); chapter V (Articles 44 to 49); Article 28"
    assert report.opening.headline == "You have to decide 3 things"


def test_every_finding_that_is_neither_accepted_nor_dismissed_is_in_a_row() -> None:
    for document in (care(), with_outside(care()), with_decisions(care()), hospital().document(), run(2)):
        report = told(dict(document))
        there = {finding for row in report.opening.rows for e in row.entries for finding in (e.id, *e.alike)}
        waiting = {f["id"] for f in document["findings"] if not f["dismissed"] and not f.get("accepted")}
        assert there == waiting
        assert not report.opening.remainder


def test_what_is_decided_stands_last_and_is_not_counted_as_waiting() -> None:
    report = told(with_decisions(care()))
    assert report.opening.headline == "You have to decide 1 thing"
    assert report.opening.sentences[0] == "1 more is decided and not yet carried out."
    assert [(row.data, row.waits) for row in report.opening.rows] == [
        ("voice", True), ("video of persons (pseudonymised)", False),
    ]  # fmt: skip
    facts = dict(report.opening.rows[1].facts)
    assert (facts["state"], facts["owner"]) == ("to be mitigated", "robot team")


def test_a_decision_that_is_over_is_to_be_made_again() -> None:
    document = care()
    decide(document, 0, owner="somebody", legal_basis=["6(1)(c)"], expires="2020-01-01", state="expired")
    row = told(document).opening.rows[0]
    assert row.waits
    assert dict(row.facts)["state"] == "accepted; expired: it no longer counts"


def test_a_decision_about_what_has_changed_since_is_to_be_made_again() -> None:
    document = care()
    decide(document, 0, choice="mitigate", changed=[{"what": "path", "before": "a", "now": "b"}])
    row = told(document).opening.rows[0]
    assert row.waits
    assert dict(row.facts)["state"] == "to be mitigated; changed since"


def test_a_decision_about_one_robot_does_not_decide_for_its_likes() -> None:
    document = {**hospital().document()}
    pattern = next(p for p in document["fleet"]["patterns"] if len(p["robots"]) == 40 and not p["dismissed"])
    number = next(i for i, f in enumerate(document["findings"]) if f["id"] == pattern["finding"])
    document["findings"] = [dict(finding) for finding in document["findings"]]
    decide(document, number, choice="mitigate", owner="me")
    document["decisions"][0]["target"] = {"robot": "carrier_01", "leak": "fleet cloud"}
    row = next(row for row in told(document).opening.rows if row.leak == "hospital:fleet cloud")
    assert row.waits
    assert dict(row.facts)["state"] == "to be mitigated, for carrier_01 only, to assess"


def test_what_nobody_reviewed_is_told_beside_it() -> None:  # S11
    document = run(2)
    assert document["open"]
    report = told(document)
    assert report.opening.sentences[-1].startswith("Not reviewed, though personal data can get there: 4 elements.")
    for text in texts(document):
        assert report.opening.sentences[-1] in text


def test_without_a_finding_it_says_what_is_not_known_and_never_that_there_is_nothing_to_decide() -> None:  # S12
    document = run(2) | {"findings": [], "verdict": "undetermined"}
    opening = told(document).opening
    assert opening.headline.startswith("Not determined")
    assert opening.sentences[-1].startswith("Review first: /")
    for text in texts(document):
        assert "You have to decide" not in text


@pytest.mark.slow
def test_many_are_counted_and_those_below_told() -> None:
    document = fleet(care(), ["a"])
    for number in range(20):
        more = fleet(care(), [f"r{number}"])["findings"][0]
        document["findings"].append(more | {"id": f"{number:016x}", "leak": {**more["leak"], "name": f"/to{number}"}})
    opening = told(document).opening
    assert opening.headline == "You have to decide 23 things"
    assert (len(opening.rows), len(opening.cards), len(opening.shown)) == (23, 22, 12)
    assert opening.remainder == "10 more places where data gets out are listed below, among the paths to assess."
    assert "face template can get to r0:/to0, r1:/to1, r2:/to2, and 17 more;" in opening.gist


def test_a_transfer_that_rests_on_article_6_alone_says_what_it_lacks() -> None:
    document = dict(hospital().document())
    row = next(row for row in told(document).opening.rows if row.leak == "hospital:fleet cloud")
    assert dict(row.facts)["basis"] == "6(1)(e), 9(2)(h), 9(3), none of chapter V"
    (stated,) = [r for r in document["processed_for"] if r["element"]["name"] == "fleet cloud"]
    based = {**stated, "legal_bases": [*stated["legal_bases"], "46(2)(c)"]}
    document["processed_for"] = [based if r is stated else r for r in document["processed_for"]]
    row = next(row for row in told(document).opening.rows if row.leak == "hospital:fleet cloud")
    assert "none of chapter V" not in dict(row.facts)["basis"]


def test_the_view_of_the_report_is_explained_first() -> None:
    for view in ("declared", "enforced"):
        assert told({**care(), "view": view}).summary.glossary[0][0] == view


def test_not_reviewed_is_exact_and_what_only_globs_review_is_counted_beside_it() -> None:
    """'0 elements not reviewed' is not that a person looked at each."""
    numbers = {what: number for number, what in told(care()).summary.numbers}
    assert numbers[table("en")["total.open"]] == 0
    assert numbers["elements that count as reviewed only by a glob, for some data at least"] == 3
    globbed = {row["element"]["name"] for row in by_globs(care())}
    assert globbed == {"/camera/*", "/camera/image", "/camera/blurred"}  # "/camera/*": sensitive
    assert not any("only by a glob" in what for _, what in told(run(2)).summary.numbers)  # no glob in these labels
