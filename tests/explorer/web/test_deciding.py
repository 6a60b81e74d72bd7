"""Decisions from the page: into the file that the command named, at once, and nowhere else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from lxml import html

from rosprivacy.analysis.decisions import Choice
from rosprivacy.ingest.decisions.decisions_file import parse_decisions
from rosprivacy.ontology.vocabulary import load
from tests.helpers.daily import one_in
from tests.helpers.explorers import BARE, FACTORY, Explorer, copied, version
from tests.helpers.full_disk import full_disk

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Explore = Callable[..., Explorer]

SIGNED = {"choice": "accept", "reason": "within the building", "owner": "A. Lee", "expires": "2999-12-31"}


@pytest.fixture
def begun(explore: Explore, tmp_path: Path) -> Explorer:
    return explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), decisions=tmp_path / "d.yaml")


def decide(explorer: Explorer, client: Any, **fields: Any) -> Any:
    said = {"version": version(client), "finding": explorer.session.findings[0].id, **fields}
    return client.post(f"/decide?finding={explorer.session.findings[0].id}", data=said)


def test_a_decision_on_a_full_disk_is_told_and_decides_nothing(begun: Explorer, tmp_path: Path) -> None:
    client = begun.client()
    assert decide(begun, client, **SIGNED).status_code == 303
    before, standing = (tmp_path / "d.yaml").read_bytes(), [f.id for f in begun.session.findings if f.stands]
    with full_disk(10):
        refused = client.post("/decide", data={"version": version(client), "finding": standing[0], **SIGNED})
    assert refused.status_code == 422
    assert "cannot be written" in refused.text
    assert [f.id for f in begun.session.findings if f.stands] == standing
    assert (tmp_path / "d.yaml").read_bytes() == before
    assert sorted(file.name for file in tmp_path.glob("*d.yaml*")) == ["d.yaml"]  # and nothing is left beside it
    again = client.post("/decide", data={"version": version(client), "finding": standing[0], **SIGNED})
    assert again.status_code == 303


def test_a_decision_is_written_at_once_and_shown(begun: Explorer, tmp_path: Path) -> None:
    client = begun.client()
    finding = begun.session.findings[0]
    form = html.fromstring(client.get(f"/?finding={finding.id}").text).get_element_by_id("decide")
    assert [one.get("value") for one in form.xpath(".//button")] == list(Choice)
    answer = decide(begun, client, **SIGNED, legal_basis="6(1)(f); 9(2)(h)", ticket="X-1")
    assert answer.status_code == 303
    there = client.get(answer.headers["location"]).text
    assert "Written to" in there
    assert "within the building" in there
    (entry,) = parse_decisions("d", (tmp_path / "d.yaml").read_text("utf-8"), load(), "2026-01-01").entries
    said = (str(entry.choice), entry.reason, entry.owner, entry.expires, entry.legal_basis, entry.ticket)
    assert said == ("accept", "within the building", "A. Lee", "2999-12-31", ("6(1)(f)", "9(2)(h)"), "X-1")
    assert entry.id == finding.id
    assert sum(one.stands for one in begun.session.findings) == 1
    ways = html.fromstring(client.get("/").text).xpath("//a[@class='way']")
    assert len(ways) == 1  # what is accepted is no way out to assess any more
    assert begun.session.unsaved == 0


@pytest.mark.parametrize(
    "fields",
    one_in(
        3,
        [
            {"choice": "accept"},
            {**SIGNED, "expires": "2020-01-01"},
            {**SIGNED, "expires": "tomorrow"},
            {**SIGNED, "legal_basis": "we want to"},
            {**SIGNED, "choice": "allow"},
            {**SIGNED, "choice": ["accept", "avoid"]},
            {**SIGNED, "finding": "0123456789abcdef"},
            {**SIGNED, "finding": "*"},
            {**SIGNED, "reason": "a\x00b"},
            {**SIGNED, "owner": "x" * 101},
        ],
        in_ci=1,
    ),
)
def test_what_is_no_decision_is_told_and_not_written(begun: Explorer, tmp_path: Path, fields: dict[str, Any]) -> None:
    answer = decide(begun, begun.client(), **fields)
    assert answer.status_code == 422
    assert "This cannot be said" in answer.text
    assert not (tmp_path / "d.yaml").exists()
    assert begun.session.version == 0


def test_no_file_of_the_browser_is_written(begun: Explorer, tmp_path: Path) -> None:
    there = {"decisions": str(tmp_path / "other.yaml"), "file": str(tmp_path / "other.yaml")}
    decide(begun, begun.client(), **SIGNED, **there)
    assert sorted(one.name for one in tmp_path.glob("*.yaml")) == ["d.yaml", "run2.labels.yaml"]


def test_texts_stay_texts_in_the_file(begun: Explorer, tmp_path: Path) -> None:
    evil = 'x" # y: [&a *a] !!python/object <b> - id: 1'
    assert decide(begun, begun.client(), **{**SIGNED, "reason": evil}).status_code == 303
    (entry,) = parse_decisions("d", (tmp_path / "d.yaml").read_text("utf-8"), load(), "2026-01-01").entries
    assert entry.reason == evil


def test_a_full_disk_or_a_closed_folder_is_told(begun: Explorer, tmp_path: Path) -> None:
    (tmp_path / "d.yaml").mkdir()
    answer = decide(begun, begun.client(), **SIGNED)
    assert answer.status_code == 422
    assert "d.yaml" in answer.text
    assert begun.session.version == 0


def test_an_acceptance_without_an_end_is_asked_again_and_then_written(explore: Explore, tmp_path: Path) -> None:
    """What was filled in stays; what else is missing is asked again, too; and it is an entry of a log."""
    log = tmp_path / "d.jsonl"
    begun = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), decisions=log)
    client, endless = begun.client(), {**SIGNED, "expires": ""}
    answer = decide(begun, client, **endless)
    assert (answer.status_code, log.exists()) == (409, False)
    form = html.fromstring(answer.text).get_element_by_id("decide")
    fields = {field.get("name"): field.get("value") for field in form.xpath(".//input")}
    assert (fields["reason"], fields["owner"], fields["lacks"]) == (SIGNED["reason"], SIGNED["owner"], "NO_END")
    assert decide(begun, client, **endless, lacks=fields["lacks"]).status_code == 303
    decided = begun.session.result.decided
    assert decided
    assert decided.decisions.head
    assert len(log.read_text("utf-8").splitlines()) == 1


def test_a_condition_is_confirmed_from_the_page(explore: Explore, tmp_path: Path) -> None:
    begun = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), decisions=tmp_path / "d.jsonl")
    client, finding = begun.client(), begun.session.findings[0]
    fields = {**SIGNED, "choice": "accept-on-condition", "condition": "a contract"}
    assert decide(begun, client, **fields).status_code == 303
    assert finding.id in {each.id for each in begun.session.findings if each.stands}
    form = html.fromstring(client.get(f"/?finding={finding.id}").text).get_element_by_id("decide")
    assert form.xpath(".//button")[0].get("value") == "confirm"
    assert decide(begun, client, choice="confirm", reason="signed", owner="A. Lee").status_code == 303
    assert finding.id not in {each.id for each in begun.session.findings if each.stands}
