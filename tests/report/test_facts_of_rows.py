"""A cell of the Article 30 record states what lies on a path of its row, or is to be completed (property).

Random systems, and the paths of each row followed on sets by ``brute``: persons of the sources whose data get there as
this kind, the time limit of this very place, sanitizers whose work the data of this row have behind them.
"""

from __future__ import annotations

import csv
import io
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.legal import recognises
from rosprivacy.documents import document_of
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.cnil.pia import cnil_pia
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.document.contents import IN_JSON, RELIANCE
from rosprivacy.report.page import article30
from tests.helpers.answers import answer_of
from tests.helpers.systems import analysed, systems

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from tests.helpers.brute import Brute, Data
    from tests.helpers.systems import System

VOCABULARY = load()
KINDS = ("PersonalData", "Biometric", "FaceTemplate", "Video", "Voice")
TITLES = {VOCABULARY.categories[name].title: name for name in KINDS}
WORDS = Words("en")
OPEN = WORDS("record.open")
REST: dict[str, Any] = {"rosprivacy": "1", "policies": [], "labels": [], "standard_channels": None}
DROPPED = re.compile(r"(/?n\d+) \(([^)]+)\): ")


class Case(NamedTuple):
    system: System
    persons: Mapping[int, tuple[str, ...]]  # of nodes, as labels state them


@st.composite
def cases(draw: st.DrawFn) -> Case:
    system = replace(draw(systems(KINDS)), hierarchy=VOCABULARY.hierarchy)
    named = draw(st.sets(st.integers(0, system.nodes - 1)))
    return Case(system, {vertex: (f"group-{vertex}",) for vertex in named})


def arrivals(brute: Brute) -> dict[tuple[int, Data], set[tuple[int, Data]]]:
    """What arrives somewhere -> what that becomes at the next elements."""
    brute.spread(brute.sources())
    after: dict[tuple[int, Data], set[tuple[int, Data]]] = {(b, data): set() for _, b, data in brute.along}
    for vertex, data in after:
        leaving = brute.made(vertex, data)
        if not brute.kills(vertex, data[0]) or (data[1] and brute.only_hides(vertex, data[0])):
            leaving |= {data}
        after[vertex, data] = {(b, one) for a, b, one in brute.along if a == vertex and one in leaving}
    return after


def cleaned_before(place: int, kind: str, brute: Brute) -> Iterator[tuple[int, str]]:
    """(Sanitizer, kind that arrives there) on the ways of a kind to a place."""
    after = arrivals(brute)
    for vertex, data in after:
        seen = {(vertex, data)}
        waiting = [(vertex, data)]
        while waiting:
            new = after[waiting.pop()] - seen
            seen |= new
            waiting += new
        here = {one for v, arrived in seen if v == place for one in (arrived, *brute.made(place, arrived))}
        makes = {s.to for s in brute.said.get(vertex, ()) if s.role == "derivation"}
        protects = brute.has(vertex, "sanitizer", data[0]) and not any(map(recognised, makes))
        if protects and vertex != place and kind in {name for name, _ in here}:
            yield vertex, data[0]


def recognised(kind: str) -> bool:
    return recognises(VOCABULARY.categories[kind])


def persons_of(kind: str, place: int | None, case: Case, brute: Brute) -> set[tuple[str, ...]]:
    """The groups of each source whose data get to a place, or are anywhere, as a kind; () of one that is not named."""
    reached = {source: brute.spread([source]) for source in brute.sources()}
    return {
        case.persons.get(source, ())
        for source, there in reached.items()
        if any(name == kind and place in (None, vertex) for vertex, (name, _) in there)
    }


@given(cases())
@settings(deadline=None)
def test_each_fact_of_a_cell_lies_on_a_path_of_its_row(case: Case) -> None:
    check(case)


def check(case: Case) -> None:
    analysis = analysed(case.system)
    if analysis is None:
        return
    brute = case.system.brute()
    bound = replace(case.system.bound(), subjects=case.persons)
    answer = answer_of(analysis, VOCABULARY, REST, bound=bound)
    columns = {WORDS(f"record.{name}"): name for name in article30.RecordEntry.__dataclass_fields__}
    text = article30.record(json_document(document_of(answer, (*IN_JSON, RELIANCE))), "en").removeprefix("\ufeff")
    vertices = {element.name: vertex for vertex, element in enumerate(case.system.graph().elements)}
    for cells in csv.DictReader(io.StringIO(text)):
        row = {columns[column]: cell for column, cell in cells.items()}
        if not row["category"]:
            continue  # the last row tells the verdict
        kind, place = TITLES[row["category"]], vertices.get(row["exit"])
        check_persons(row["subjects"], row["complete"], persons_of(kind, place, case, brute))
        check_kept(row, kind, place, brute)
        named = {(vertices[name], TITLES[title]) for name, title in DROPPED.findall(row["measures"])}
        if place is not None:
            assert named == set(cleaned_before(place, kind, brute))
        for name, title in DROPPED.findall(row["measures"]) if place is None else ():
            assert title == row["category"]
            assert not any(recognised(s.to) for s in brute.said[vertices[name]] if s.role == "derivation")
    answers = {
        one["reference_to"]: one["data"]["text"] for one in cnil_pia(document_of(answer), "2026-01-01")["answers"]
    }
    for part in re.split(r"<p><strong>", answers[121])[1:]:
        title = next(title for title in sorted(TITLES, key=len, reverse=True) if part.startswith(title))
        groups = persons_of(TITLES[title], None, case, brute)
        assert set(re.findall(r"group-\d+", part)) == {one for group in groups for one in group}


def check_persons(cell: str, complete: str, groups: set[tuple[str, ...]]) -> None:
    assert set(re.findall(r"group-\d+", cell)) == {one for group in groups for one in group}
    assert (OPEN in cell) == ("30(1)(c)" in complete) == (() in groups or not groups)


def check_kept(row: Mapping[str, str], kind: str, place: int | None, brute: Brute) -> None:
    facts = brute.outside.get(-1 if place is None else place, ("", None))[1]
    stated = brute.nearest(facts.retention, kind) if facts else []
    assert set(re.findall(r"(/?n\d+): ", row["retention"])) == ({row["exit"]} if stated else set())
    told = WORDS.duration(stated[0]) in row["retention"] if len(stated) == 1 else True
    assert told
    whole = bool(stated) and facts is not None and facts.backups is not True
    assert (OPEN in row["retention"]) == ("30(1)(f)" in row["complete"]) == (not whole)
