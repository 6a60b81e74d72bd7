"""The tables of persons and recipients, what storages, decisions and fleets add, and rights of persons."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report import naming
from rosprivacy.report.catalogs.words import Words, plain
from tests.helpers.abroad import abroad
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, texts, told
from tests.helpers.reports import care, fleet, with_decisions, with_outside

if TYPE_CHECKING:
    from pathlib import Path


def cells(table: Any) -> dict[str, dict[str, str]]:
    return {
        row.name: {column: cell.text for column, cell in zip(table.columns, row.cells, strict=True)}
        for row in table.rows
    }


def test_who_gets_which_kind() -> None:
    """All cells are in the golden set."""
    who = cells(told(care()).persons.recipients)
    assert who["/recorder"]["video of persons"] == "1 path to assess, pseudonymised"
    assert who["/recorder"]["voice"] == "–"
    assert who["/uplink"]["voice"] == "1 path to assess"


def test_a_recipient_that_nothing_reaches_is_a_row_all_the_same() -> None:
    document = care() | {"findings": []}
    assert set(cells(told(document).persons.recipients)) == {"/recorder", "/uplink"}


def test_tables_are_cut_into_parts_that_fit_a_page() -> None:
    document = care()
    document["categories"] = [{**document["categories"][0], "name": f"K{i}", "title": f"k{i}"} for i in range(14)]
    document["categories"][3]["name"] = "Video"
    document |= {"findings": [], "roles": [row for row in document["roles"] if row["category"] == "Video"]}
    document |= {"derivations": [], "sanitizers": [], "carries": [], "open": []}
    parts = list(told(document).persons.recipients.parts())
    assert [len(part.columns) for part in parts] == [6, 6, 2]
    assert all(len(row.cells) == len(part.columns) for part in parts for row in part.rows)


def test_storages_are_told_with_their_retention_and_what_is_missing() -> None:
    for text in texts(with_outside(care())):
        assert "video of persons: 30 days; voice: 1 year" in text  # what is stated of everything holds for it
        assert "yes, for how long is not stated" in text
        assert "country: not stated" in text
        assert "US (adequacy decision for some recipients)" in text
        assert "standard contractual clauses" in text
        assert "Speech Inc." in text
        assert "is kept at archive: without a stated end, or too long" in text
        assert "Reason: no retention is stated" in text
        assert "Members of the EEA and adequacy decisions as of 2026-06-30" in text


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_time_is_told_of_the_kinds_that_are_there_not_of_a_name_of_the_label_file(
    language: str, tmp_path: Path
) -> None:
    """``PersonalData: P1Y`` is what the store keeps voice for; on its card one time stands without a name."""
    report = told(abroad(tmp_path), language)
    words, titles = report.words, {kind["name"]: kind for kind in abroad(tmp_path)["categories"]}
    (store,) = [one for one in report.inventory.outside if one.name == "store"]
    assert {part.count(": ") for part in plain(store.retention).split("; ")} == {1}
    for name, time in (("Video", "P90D"), ("Voice", "P1Y")):
        (part,) = [one for one in store.retention.split("; ") if naming.text(titles[name], "title", language) in one]
        assert part.endswith(words.duration(time))
    cards = {card.place: dict(card.facts) for card in report.opening.cards}
    assert cards["store"][words("opening.retention")] == words.duration("P90D")
    assert not [text for text in texts(abroad(tmp_path), language) if "PersonalData" in text]


def test_a_time_of_data_that_do_not_get_there_is_told_too() -> None:
    document = with_outside(care())
    document["outside"][1]["retention"] = {"Video": "P30D", "every": "P1Y", "PersonalData": "P5Y"}
    (archive,) = [one for one in told(document).inventory.outside if one.name == "archive"]
    assert archive.retention == "video of persons: 30 days; voice: 1 year; personal data: 5 years"
    document["register"] = []  # an older document
    (archive,) = [one for one in told(document).inventory.outside if one.name == "archive"]
    assert archive.retention.startswith("video of persons: 30 days")


@pytest.mark.parametrize("language", LANGUAGES)
def test_who_meets_an_objection_finds_where_the_data_lie(language: str) -> None:
    intro = Words(language)("rights.intro")
    assert all(re.search(rf"\b{article}\b", intro) for article in (15, 17, 20, 21))  # Article 21(1) names 6(1)(e), (f)
    assert all(plain(intro) in text for text in texts(care(), language))


def test_decisions_stand_beside_their_way_with_what_they_lack() -> None:
    document = with_decisions(care())
    report = told(document)
    assert [entry.state for entry in report.entries] == ["open", "decided", "accepted"]  # what waits for somebody first
    for text in texts(document):
        assert "staff has to know" in text
        assert "6(1)(c)" in text
        assert "no exception of Article 9(2) is recorded" in text  # Article 6 alone does not do for a special category
        assert "to be mitigated" in text
        assert "matches no path any more" in text
        assert "1 path to assess accepted by a person's decision; section 3 shows each" in text
    assert {what: number for number, what in report.summary.numbers}["paths to assess or accepted"] == 3


def test_findings_that_differ_only_in_the_robot_are_one_with_its_robots_listed() -> None:  # S10
    robots = [f"robot{number:02}" for number in range(20)]
    document = fleet(care(), robots)
    report = told(document)
    assert len(document["findings"]) == 60
    assert [len(entry.robots) for entry in report.entries] == [20, 20, 20]
    assert [row.name for row in report.persons.recipients.rows] == ["/recorder (20 robots)", "/uplink (20 robots)"]
    for text in texts(document):
        assert all(robot in text for robot in robots)
        assert "/uplink (20 robots)" in text
    assert {item.robots for item in report.inventory.items} == {20}


def test_a_way_from_robot_to_robot_is_another_pattern_than_one_inside_a_robot() -> None:
    document = fleet(care(), ["a", "b"])
    document["findings"][0]["leak"]["robot"] = "b"
    assert sorted(len(entry.robots) for entry in told(document).entries) == [0, 0, 2, 2]


def test_each_group_that_labels_name_has_its_places() -> None:
    groups = {group.name: {place.name: place for place in group.places} for group in told(care()).persons.rights}
    assert set(groups) == {"residents", "staff", "visitors", "persons not stated"}
    assert set(groups["residents"]) == {"/recorder", "/uplink"}
    assert groups["visitors"]["/uplink"].data == "face template"  # the microphone is not about visitors
    assert groups["residents"]["/uplink"].data == "face template, voice"
    assert (groups["staff"]["/uplink"].retention, groups["staff"]["/uplink"].recipient) == ("not known", "not known")


def test_a_storage_stands_first_with_how_long_it_keeps_what() -> None:
    residents, _, visitors, _ = told(with_outside(care())).persons.rights
    assert residents.places[0].name == "archive"
    assert residents.places[0].data.startswith("video of persons")
    assert residents.places[0].retention.startswith("30 days")
    speech = next(place for place in residents.places if place.name == "speech service")
    assert speech.recipient.startswith("Speech Inc.")
    assert "US: standard contractual clauses" in speech.recipient
    assert "speech service" not in {place.name for place in visitors.places}  # it gets voices only


def test_every_finding_of_a_group_is_at_one_of_its_places() -> None:
    for document in (care(), with_outside(care()), dict(hospital().document())):
        report = told(document)
        told_places = {place.name for group in report.persons.rights for place in group.places}
        for finding in document["findings"]:
            name = finding["leak"]["name"]
            assert any(name in place for place in told_places), name


def test_who_has_no_place_is_told_so_and_what_is_not_known_is_said() -> None:
    document = care()
    rows = [row | {"places": []} for row in document["register"]]
    for text in texts(document | {"findings": [], "register": rows, "verdict": "no-leak-found"}):
        assert "Data about residents: no path to a storage or recipient was found under the labels given." in text
        assert "What nodes, logs and recipients keep besides is not known to the program." in text
