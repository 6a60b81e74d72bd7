"""The closed list of groups of persons: which words stand for a group, what it is in DPV, which law it points at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from rdflib import RDF, SKOS, Graph, Namespace, URIRef

from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

DPV = Namespace("https://w3id.org/dpv#")
POINTED = load().pointed
GUIDELINES = {  # whom criterion 7 of WP 248 rev.01 names
    "Children", "Employees", "MentallyIllPersons", "AsylumSeekers", "ElderlyPersons", "Patients",
}  # fmt: skip


def test_each_word_stands_for_one_group() -> None:
    words = [word for group in POINTED.groups for word in group.words]
    assert len(words) == len(set(words)) > 60
    for group in POINTED.groups:
        assert all(POINTED.group_of(word) == group for word in group.words)


def test_upper_case_and_spaces_make_no_difference() -> None:
    for written in ("children", "CHILDREN", " Children ", "Minderjährige", "MINDERJÄHRIGE"):
        assert (group := POINTED.group_of(written)) is not None
        assert group.name == "Children"


@pytest.mark.parametrize(
    "stated", ["", "residents", "no children", "children of staff", "staff, patients", "childrens"]
)
def test_a_text_that_is_no_word_of_the_list_stands_for_none(stated: str) -> None:
    """Nobody guesses from a part of it: what is not known is for a person to say."""
    assert POINTED.group_of(stated) is None


def test_the_vulnerable_are_those_whom_the_guidelines_name() -> None:
    assert {group.name for group in POINTED.groups if group.vulnerable} == GUIDELINES


def test_children_call_for_recital_38_and_legitimate_interests() -> None:
    calls = {group.name: group.look_at for group in POINTED.groups if group.look_at}
    assert calls == {"Children": ("GDPR Art. 6(1)(f) legitimate interests", "GDPR Recital 38")}


def test_what_persons_call_for_is_called_for_by_the_kinds_of_data_about_them() -> None:
    kinds = [load().categories[name] for name in ("Video", "Voice")]
    stated = {"Video": ["staff", "Kinder"], "Voice": ["residents"]}
    rows = {pointer.name: (of, where) for pointer, of, where in POINTED.rows(kinds, (), stated)}
    assert rows["GDPR Recital 38"] == (("Video",), ())
    silent = {pointer.name: (of, where) for pointer, of, where in POINTED.rows(kinds, ())}
    assert rows.keys() - silent.keys() == {"GDPR Recital 38", "GDPR Art. 6(1)(f) legitimate interests"}
    assert {name: rows[name] for name in silent} == silent


def test_what_an_earlier_run_has_read_is_the_same_list(tmp_path: Path) -> None:
    assert load(tmp_path).pointed.groups == load(tmp_path).pointed.groups == POINTED.groups


@pytest.mark.slow
def test_each_group_is_one_of_dpv_and_whom_dpv_calls_vulnerable_is_vulnerable_here(corpus: Path) -> None:
    graph = Graph().parse(corpus.parent / "dpv" / "dpv.ttl")
    for group in POINTED.groups:
        assert (URIRef(group.term), RDF.type, DPV.HumanSubject) in graph, group.name
        above = set(graph.transitive_objects(URIRef(group.term), SKOS.broader))
        assert group.vulnerable or DPV.VulnerableHuman not in above, group.name
