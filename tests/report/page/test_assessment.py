"""What only a person can say: fields of Article 35(7), saved by the page and filled into the next report."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page.assessment import FORMAT, Answers, criteria, read_answers
from rosprivacy.report.page.index import Index
from tests.helpers.fleet_files import policy
from tests.helpers.graphs import hospital
from tests.helpers.pages import page, texts, told
from tests.helpers.paths import ROOT
from tests.helpers.reports import care, with_decisions

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

SYSTEM = ["examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml"]


def keys(document: dict[str, Any]) -> list[str]:
    return [area.get("data-field") for area in page(document).iter("textarea")]


def saved(folder: Path, value: object) -> str:
    file = folder / "assessment.json"
    file.write_text(value if isinstance(value, str) else json.dumps(value), "utf-8")
    return str(file)


def test_every_flow_that_is_not_dismissed_has_its_risks_and_all_that_article_35_asks_for_is_a_field() -> None:
    document = with_decisions(care())
    there = keys(document)
    assert len(there) == len(set(there))
    for finding in document["findings"]:  # also those that are accepted
        for what in ("likelihood", "severity", "whom", "measures", "residual", "decision"):
            assert f"risk.{finding['id']}.{what}" in there
    for what in ("purpose", "necessity", "risks", "measures", "residual", "advice", "views", "consultation"):
        assert f"sign.{what}" in there
    assert {f"criterion.{number}" for number in range(1, 10)} <= set(there)


def test_what_tells_where_persons_are_monitors_them_as_what_sees_them_does(tmp_path: Path) -> None:
    """WP 248, criterion 3: a lidar, and what collects identifiers of passing devices; keys that are typed do not."""
    kinds = {"camera": "Video", "lidar": "LaserScan", "wifi": "WirelessDeviceId", "keys": "OperatorInput"}
    (tmp_path / "p.xml").write_text(policy(*(f"{name}>/{name}<" for name in kinds)), "utf-8")
    nodes = ", ".join(f"/{name}: {{source: [{kind}]}}" for name, kind in kinds.items())
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes: {{{nodes}}}\n", "utf-8")
    index = Index(rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml").document(), Words("en"))
    third = criteria(index)[2].shows
    assert [name for name in kinds if f"/{name}" in third] == ["camera", "lidar", "wifi"]


@pytest.mark.parametrize(
    ("stated", "vulnerable", "others"),
    [
        ("[children, staff, passers-by]", "children, staff", "passers-by"),
        ("[Kinder]", "Kinder", ""),
        ("[residents]", "", "residents"),
    ],
)
def test_known_groups_are_vulnerable_and_of_others_a_person_has_to_say(
    tmp_path: Path, stated: str, vulnerable: str, others: str
) -> None:
    """WP 248, criterion 7; children point at recital 38 and Article 6(1)(f), in the law of the kinds about them."""
    (tmp_path / "p.xml").write_text(policy("camera>/image<", "mic>/audio<"), "utf-8")
    nodes = f"/camera: {{source: [Video], subjects: {stated}}}, /mic: {{source: [Voice]}}"
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes: {{{nodes}}}\n", "utf-8")
    document = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml").document()
    words = Words("en")
    said = {"criterion.vulnerable": vulnerable, "criterion.subjects": others}
    assert criteria(Index(document, words))[6].shows == "; ".join(words(k, names=n) for k, n in said.items() if n)
    law = {row["provision"]: row["categories"] for row in document["look_at"]}
    children = any(group["name"] == "Children" for group in document["persons"])
    for provision in ("GDPR Recital 38", "GDPR Art. 6(1)(f) legitimate interests"):
        assert law.get(provision) == (["Video"] if children else None)


def test_of_a_fleet_the_key_is_the_pattern_which_decisions_name_too() -> None:
    document = dict(hospital().document())
    first = told(document).opening.rows[0].entries[0]
    assert first.pattern
    assert f"risk.{first.pattern}.likelihood" in keys(document)


def test_answers_stand_in_the_page_and_in_the_text_and_on_paper() -> None:
    finding = care()["findings"][0]["id"]
    answers = Answers({"sign.purpose": "care\nat night", f"risk.{finding}.severity": "high <b>", "criterion.5": "no"})
    for text in texts(care(), answers=answers):
        assert "high <b>" in text.replace("&lt;", "<").replace("&gt;", ">")
    root = page(care(), answers=answers)
    areas = {area.get("data-field"): area for area in root.iter("textarea")}
    assert areas["sign.purpose"].text.split() == ["care", "at", "night"]
    assert areas["sign.purpose"].getnext().text == "care\nat night"  # what is printed
    assert areas["criterion.5"].text == "no"


def test_an_answer_stays_with_its_flow_whichever_of_its_findings_it_was_given_to() -> None:
    document = dict(hospital().document())
    flow = next(row for row in told(document).opening.rows if row.leak == "hospital:fleet cloud")
    second = flow.entries[1]
    report = told(document, answers=Answers({f"risk.{second.id}.whom": "staff"}))
    (risk,) = (risk for risk in report.assessment.risks if risk.flow.leak == "hospital:fleet cloud")
    assert [field.text for field in risk.fields if field.key.endswith("whom")] == ["staff"]
    assert not report.assessment.unmatched


def test_what_matches_nothing_any_more_is_told_and_kept() -> None:
    answers = Answers({"risk.0123456789abcdef.severity": "was low", "sign.gone": "x"})
    for text in texts(care(), answers=answers):
        assert "Answers that match nothing any more" in text
        assert "risk.0123456789abcdef.severity" in text
        assert "was low" in text
    there = [area.get("data-field") for area in page(care(), answers=answers).iter("textarea")]
    assert "risk.0123456789abcdef.severity" in there  # so the next file has it too


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("{", "not JSON"),
        ({"format": FORMAT}, "the document lacks answers"),
        ({"format": "rosprivacy.assessment/9", "answers": {}}, 'format is not "rosprivacy.assessment/1"'),
        ({"format": FORMAT, "answers": {"a": 1}}, "answers.a is a number, not text"),
        ({"format": FORMAT, "answers": [], "more": 1}, "answers is a list, not an object"),
    ],
)
def test_a_bad_file_gets_a_line_for_each_problem(tmp_path: Path, value: object, said: str) -> None:
    with pytest.raises((InputError, InputErrors)) as caught:
        read_answers(saved(tmp_path, value))
    assert said in str(caught.value)
    assert all(line.startswith(str(tmp_path)) for line in str(caught.value).splitlines())


def test_all_problems_are_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(InputErrors) as caught:
        read_answers(saved(tmp_path, {"format": FORMAT, "answers": {"a": 1, "b": None}}))
    assert len(str(caught.value).splitlines()) == 2


def test_controls_in_an_answer_are_spelt_out(tmp_path: Path) -> None:
    file = saved(tmp_path, {"format": FORMAT, "answers": {"sign.name": "Ada\u202e\nB", "sign.date": "  "}})
    assert read_answers(file).texts == {"sign.name": "Ada\\u202e\nB"}


@pytest.mark.slow
def test_the_command_line_fills_the_answers_in(cli: Cli, tmp_path: Path) -> None:
    file = saved(tmp_path, {"format": FORMAT, "answers": {"sign.purpose": "night care"}})
    text = cli("report", *SYSTEM, "--assessment", file, "-f", "markdown", cwd=ROOT).stdout
    assert "night care" in text
    assert "The answers come from" in text
    hidden = cli("report", *SYSTEM, "--assessment", file, "--redact", "-f", "markdown", cwd=ROOT).stdout
    assert "night care" not in hidden
    refused = cli("report", *SYSTEM, "--assessment", str(tmp_path / "none.json"), "-f", "markdown", cwd=ROOT)
    assert (refused.returncode, refused.stderr.count("\n")) == (2, 1)
