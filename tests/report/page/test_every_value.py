"""A report is short, and leaves out no fact: every value of the document that people have to know stands in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.model import OWN_DOMAINS
from rosprivacy.report.catalogs.words import Words, finding_reason
from rosprivacy.report.finding_facts import looked_at
from rosprivacy.report.naming import line, text
from tests.helpers.abroad import abroad
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, texts
from tests.helpers.reports import care, office, run, with_decisions

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    Values = Iterator[str]

PAGE = 0  # the page is the first of the texts
FEW = 4  # lines that a step shows
SHOWN = 8  # of what hangs on one statement


@pytest.fixture(params=["care", "fleet", "office", "abroad", "factory"])
def system(request: pytest.FixtureRequest, tmp_path: Path) -> dict[str, Any]:
    made = {
        "care": lambda: with_decisions(care()),
        "fleet": lambda: dict(hospital().document()),
        "factory": lambda: run(3),
    }
    written = {"office": office, "abroad": abroad}
    return written[request.param](tmp_path) if request.param in written else made[request.param]()


def named(element: Mapping[str, Any]) -> str:
    return str(element["name"])


def findings(document: Mapping[str, Any], words: Words) -> Values:
    of_fleet = {pattern["finding"] for pattern in document.get("fleet", {}).get("patterns", ())}
    titles = {kind["name"]: text(kind, "title", words.language) for kind in document["categories"]}
    for finding in document["findings"]:
        if of_fleet and finding["id"] not in of_fleet:
            continue
        yield from (finding["id"], named(finding["source"]), named(finding["leak"]), titles[finding["category"]])
        yield from map(named, finding["witness"])
        yield from (line(grant) for step in finding["steps"] for grant in step["policy"][:FEW])
        yield from (one for step in finding["steps"] for grant in step["policy"][:FEW] for one in of_grant(grant))
        yield finding_reason(finding, words, titles.__getitem__) or ""


def of_grant(grant: Mapping[str, Any]) -> Values:
    yield from (grant["enclave"], grant["profile"])


def places(document: Mapping[str, Any], words: Words) -> Values:
    for row in document["outside"]:
        yield named(row["element"])
        yield from (row.get(of, "") for of in ("operator", "country", "contract"))
        yield from (words.duration(kept) for kept in row.get("retention", {}).values())
        yield words(f"recipient.{row['recipient']}") if row.get("recipient") else ""


def provisions(document: Mapping[str, Any], words: Words) -> Values:
    for kind in document["categories"]:
        yield from (text(kind, what, words.language) for what in ("title", "definition", "gdpr"))
        for row in (*kind["law"], *kind.get("in_context", ())):
            yield text(row, "provision", words.language)
    for row in looked_at(document):
        yield from (text(row, what, words.language) for what in ("provision", "title"))
        yield words.date(row["as_of"])
        yield words.date(row["applies_from"]) if row["applies_from"] else ""


def meanings(document: Mapping[str, Any], words: Words) -> Values:
    """What provisions say in full stands in the page; the text has what they are about."""
    of_data = [row for kind in document["categories"] for row in (*kind["law"], *kind.get("in_context", ()))]
    yield from (text(row, "meaning", words.language) for row in (*of_data, *looked_at(document)))


def labels(document: Mapping[str, Any], words: Words) -> Values:
    for row in document.get("hangs_on") or ():
        yield f"{row['file']}:{row['line']}"
        yield from (row["author"], row["why"])
    for row in document.get("taken_away", ()):
        if row["leak"] or row["open"]:
            yield from (f"{place['file']}:{place['line']}" for place in row["places"])
    for row in document.get("processed_for", ()):
        yield from (*row["purposes"], *row["controllers"], *row["officers"], *map(words.basis, row["legal_bases"]))
    yield from (one for row in document["subjects"] for one in row["subjects"])
    said = document["assumptions"]
    yield from (one for of in ("policies", "labels") for row in said[of] for one in (row["file"], row["sha256"]))
    domains = [row["message"] for row in document["diagnostics"] if row.get("code") == OWN_DOMAINS]
    yield from (message.rpartition(": ")[2].partition(" and ")[0] for message in domains)  # in every language
    others = [row["message"] for row in document["diagnostics"] if row["message"] not in domains]
    yield from (part for message in others for part in message.rsplit(", and ", 1))
    yield from (named(row["element"]) for row in document["sanitizers"])
    yield from (named(row["element"]) for row in document["derivations"] if row["reached"])


def decisions(document: Mapping[str, Any], words: Words) -> Values:
    for row in (*(f["decision"] for f in document["findings"] if f.get("decision")), *document.get("decisions", ())):
        yield from (row["reason"], row["owner"], *map(words.basis, row["legal_basis"]))


def doubts(document: Mapping[str, Any], words: Words) -> Values:  # noqa: ARG001 - as the others
    yield from (one for row in document.get("doubts", ()) for one in (row["id"], named(row["element"])))
    yield from (named(row["element"]) for row in document["open"])


def elements(document: Mapping[str, Any], words: Words) -> Values:  # noqa: ARG001 - as the others
    yield from (named(row["element"]) for row in document["carries"])
    for element in document["unreached"]:  # of a parameter service, its node
        yield named(element).rpartition("/")[0] if element["kind"] == "service" else named(element)
    yield from (one for row in document["enclaves"] for one in (row["enclave"], *row["nodes"]))


FACTS = (findings, places, provisions, labels, decisions, doubts, elements)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_value_stands_in_the_page_and_in_the_text(system: dict[str, Any], language: str) -> None:
    words = Words(language)
    expected = {fact.__name__: {" ".join(value.split()) for value in fact(system, words)} for fact in FACTS}
    of_page = {"meanings": {" ".join(value.split()) for value in meanings(system, words)}}
    for number, written in enumerate(texts(system, language)):
        expected |= of_page if number == PAGE else {"meanings": set()}
        plain = " ".join(written.split())
        absent = {name: sorted(value for value in values if value not in plain) for name, values in expected.items()}
        assert not {name: values for name, values in absent.items() if values}


def test_the_systems_have_every_sort_of_fact(tmp_path: Path) -> None:
    """Else the test above could not fail."""
    several = [with_decisions(care()), dict(hospital().document()), abroad(tmp_path)]
    assert {fact.__name__ for fact in FACTS for one in several if any(fact(one, Words("en")))} == {
        fact.__name__ for fact in FACTS
    }
