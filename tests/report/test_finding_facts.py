"""What a person decides first, in every report."""

from __future__ import annotations

import copy

import rosprivacy
from rosprivacy.report.finding_facts import in_order, strength
from tests.helpers.paths import ROOT
from tests.helpers.reports import care


def test_the_worst_of_a_fleet_stands_first() -> None:
    """One robot lets raw video out that its likes pseudonymise: before what all robots do, and what is dismissed."""
    document = rosprivacy.analyze_fleet(ROOT / "examples" / "fleet" / "fleet.yaml").document()
    order = in_order(document["findings"], document)
    assert [(f["category"], f["source"]["robot"], f["leak"]["name"]) for f in order[:2]] == [
        ("Video", "carrier_lent", "reviewer"),
        ("Video", "carrier_lent", "footage bucket"),
    ]
    assert [f["dismissed"] for f in order] == sorted(f["dismissed"] for f in order)


def test_what_is_special_stands_before_what_is_not_and_data_as_it_is_before_pseudonymised_data() -> None:
    template, video, voice = care()["findings"]
    assert (template["article9"], video["pseudonymised"], voice["pseudonymised"]) == ("conditional", True, False)
    assert in_order([video, voice, template], care()) == [template, voice, video]
    hidden = copy.deepcopy(template) | {"pseudonymised": True}
    assert in_order([voice, hidden, template], care()) == [template, hidden, voice]


def test_data_of_article_10_count_as_special() -> None:
    video, voice = care()["findings"][1:]
    voice["law"] = [{**voice["law"][0], "provision": "GDPR Art. 10", "verdict": "always"}]
    voice["article9"] = "no"
    assert strength(voice) != strength(video)
    assert in_order([{**video, "pseudonymised": False}, voice], care())[0] is voice


def test_what_is_accepted_or_dismissed_waits_for_nobody() -> None:
    template, video, voice = care()["findings"]
    order = in_order([{**template, "dismissed": True}, {**voice, "accepted": True}, video], care())
    assert [f["id"] for f in order] == [video["id"], voice["id"], template["id"]]
