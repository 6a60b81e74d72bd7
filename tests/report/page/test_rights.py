"""For each group of persons, where data about them can lie (Articles 15, 17 and 20 GDPR)."""

from __future__ import annotations

from tests.helpers.graphs import hospital
from tests.helpers.pages import texts, told
from tests.helpers.reports import care, with_outside


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
    assert residents.places[0].retention.startswith("video of persons: 30 days")
    speech = next(place for place in residents.places if place.name == "speech service")
    assert speech.recipient == "Speech Inc., US (adequacy decision for some recipients)"
    assert "speech service" not in {place.name for place in visitors.places}  # it gets voices only


def test_every_finding_of_a_group_is_at_one_of_its_places() -> None:
    for document in (care(), with_outside(care()), dict(hospital().document())):
        report = told(document)
        told_places = {place.name for group in report.persons.rights for place in group.places}
        for finding in document["findings"]:
            name = finding["leak"]["name"]
            assert any(name in place for place in told_places), name


def test_who_has_no_place_is_told_so_and_what_is_not_known_is_said() -> None:
    for text in texts(care() | {"findings": [], "verdict": "no-leak-found"}):
        assert "Data about residents: no path to a storage or recipient was found under the labels given." in text
        assert "What nodes, logs and recipients keep besides is not known to the program." in text
