"""What closes the paths to decide stands in the report: the proposals of ``mitigate``, or why there are none."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.formats import Style, written
from rosprivacy.mitigation import run_mitigation
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page.closing import closing
from rosprivacy.report.page.index import Index
from tests.helpers.pages import told
from tests.helpers.paths import ROOT
from tests.helpers.reports import care

if TYPE_CHECKING:
    from rosprivacy.result import Result

HOME = "examples/care-home/care-home.policy.xml", "examples/care-home/care-home.labels.yaml"


def home() -> Result:
    return rosprivacy.analyze(*(ROOT / name for name in HOME))


@pytest.mark.slow
def test_the_report_tells_each_change_of_the_last_proposal_with_its_policy_lines() -> None:
    result = home()
    last = run_mitigation(result).document()["proposals"][-1]
    assert len(last["steps"]) == 3
    for form in ("html", "markdown"):
        text = str(written(result, form))
        assert "What closes these paths" in text
        for step in last["steps"]:
            assert all(f"{grant['file']}:{grant['line']}" in text for grant in step["policy"])
    assert "between /audio and /uplink" in str(written(result, "html"))


def test_a_redacted_report_names_nobody_in_it() -> None:
    text = str(written(home(), "markdown", Style(redact=True)))
    assert "filter between /topic-" in text
    assert "/audio" not in text
    assert "care-home.policy.xml" not in text


def test_of_a_fleet_and_of_a_document_alone_it_says_why_nothing_is_proposed() -> None:
    fleet = rosprivacy.analyze_fleet(ROOT / "examples" / "fleet" / "fleet.yaml")
    assert "Changes are proposed for the policies of one robot" in str(written(fleet, "html"))
    alone = told(care()).closing
    assert alone
    assert alone.sentences == (
        "No change can be proposed here: the policies behind this report are not at hand.",
    )  # fmt: skip


def test_too_many_findings_are_left_to_mitigate(monkeypatch: Any) -> None:
    monkeypatch.setattr("rosprivacy.mitigation.REPORTED", 2)
    assert "There are too many paths to propose changes here" in str(written(home(), "html"))


def test_what_is_not_proven_is_not_proposed_and_what_stays_is_named() -> None:
    document = care()
    proposals: dict[str, Any] = copy.deepcopy({**run_mitigation(home()).document()})
    last = proposals["proposals"][-1]
    last["proven"] = False
    index = Index(document, Words("en"))
    report = closing(index, told(document).entries, proposals)
    assert report
    assert (report.sentences, report.changes) == (("No change that can be proposed removes these paths.",), ())
    last["keeps"] = [{"finding": document["findings"][0]["id"], "kind": "disclosure", "category": "Voice"}]
    report = closing(index, told(document).entries, proposals)
    assert report
    assert [entry.id for entry in report.stays] == [document["findings"][0]["id"]]


def test_without_a_path_there_is_nothing_to_close() -> None:
    assert told(care() | {"findings": [], "verdict": "no-leak-found"}).closing is None
