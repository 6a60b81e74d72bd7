"""What statements of one element come to, their order, and what is told of those that do not hold (rules S7, S14)."""

from __future__ import annotations

from itertools import permutations

import pytest

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.example import factory
from rosprivacy.analysis.kernel.overruled import overruled
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.model import Method, Place, Statement
from tests.helpers.systems import HIERARCHY


def said(role: str, *categories: str, line: int = 1, rank: int = 0, through: tuple[str, ...] = ()) -> Statement:
    return Statement(role, categories, (1, rank), Place("labels", line), through=through)


def test_whatever_the_order_of_statements_roles_and_reviewers_stand_in_one_order() -> None:
    cleans = said("sanitizer", "Face", line=9)._replace(method=Method.DROP)
    some = (said("leak", "Face", line=5), cleans, said("derivation", "Face", line=2)._replace(to="Bio"))
    reviews = [said("conduit", "Loc", line=line) for line in (8, 3, 6)]
    assert {facts("/n", order, "Face", HIERARCHY).roles for order in permutations(some)} == {
        ("derivation", "leak", "sanitizer")
    }
    for order in permutations(reviews):
        assert [one.place.line for one in facts("/n", order, "Loc", HIERARCHY).reviewers] == [3, 6, 8]


def test_only_and_never_of_one_kind_contradict_and_of_two_kinds_do_not() -> None:
    with pytest.raises(LabelError, match="never"):
        facts("/t", (said("only", "Face"), said("never", "Face", line=2)), "Face", HIERARCHY)
    assert facts("/t", (said("only", "Face"), said("never", "Loc", line=2)), "Loc", HIERARCHY).closers


def test_only_and_mundane_contradict_for_every_kind() -> None:
    with pytest.raises(LabelError, match="for every category here"):
        facts("/t", (said("only", "Face"), said("mundane", line=2)), "Face", HIERARCHY)


def test_a_source_that_a_higher_one_states_again_is_not_taken_away() -> None:
    """``none`` between the two is outdone itself."""
    graph, *_ = factory()
    again = (said("source", "Face", through=("/t",)), said("no-source", rank=1))
    for through, gone in ((("/t",), 0), (("/u",), 1), (("/t", "/u"), 0), ((), 0)):
        every = (*again, said("source", "Face", rank=2, through=through))
        assert len(overruled({0: {"Face": facts("/n", every, "Face", HIERARCHY)}}, graph.elements)) == gone


def test_elements_stand_in_the_order_of_their_names() -> None:
    graph, *_ = factory()
    away = facts("/*", (said("leak", "Face"), said("no-leak", rank=1, line=2)), "Face", HIERARCHY)
    (row,) = overruled({vertex: {"Face": away} for vertex in reversed(range(len(graph.elements)))}, graph.elements)
    assert list(row.names) == sorted({element.name for element in graph.elements})
