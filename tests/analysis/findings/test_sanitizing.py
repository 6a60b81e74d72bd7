"""Who cleans, what passes beside, who makes one kind of another: against brute force, and on the care home."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, given

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.sanitizing import cleanings, makings
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.model import Method, Place, Statement
from tests.helpers.graphs import care_home, factory
from tests.helpers.systems import HIERARCHY, index, systems

if TYPE_CHECKING:
    from tests.helpers.systems import System


@given(systems())
def test_what_passes_beside_a_sanitizer_is_what_others_read_from_its_channels(system: System) -> None:
    try:
        analysis = system.analyse()
    except InputErrors:
        assume(False)
    brute, number = system.brute(), index(system)
    brute.spread(brute.sources())
    for cleaning in cleanings(analysis.spread, analysis.emitted):
        vertex, category = number[cleaning.element], cleaning.category
        read = {a for a, b, (c, _) in brute.along if b == vertex and c == category and a >= system.nodes}  # channels
        readers = {b for a, b, (c, _) in brute.along if a in read and c == category and b != vertex}
        beside = {b for b in readers if not brute.has(b, "sanitizer", category)}
        assert {number[element] for element in cleaning.neighbours} == beside
        sent = {data for a, _, data in brute.along if a == vertex}
        assert {c for c, hidden in sent if not hidden} <= set(cleaning.leaves)
        assert {c for c, hidden in sent if hidden} <= set(cleaning.pseudonymised)
        assert cleaning.reached == any(b == vertex and c == category for _, b, (c, _) in brute.along)


@given(systems())
def test_whoever_makes_another_kind_is_named_once(system: System) -> None:
    try:
        analysis = system.analyse()
    except InputErrors:
        assume(False)
    rows = makings(analysis.spread, analysis.emitted)
    assert len(set(rows)) == len(rows)
    assert all(row.target != row.made_of and row.target in analysis.emitted for row in rows)


def test_the_care_homes_sanitizers() -> None:
    analysis = care_home().analysis
    rows = {(c.element.name, c.category): c for c in cleanings(analysis.spread, analysis.emitted)}
    assert {key: row.method for key, row in rows.items() if row.reached} == {
        ("/blur", "Video"): "pseudonymise",
        ("/face_recognizer", "Video"): "drop",
        ("/uplink", "Video"): "aggregate",
    }
    assert rows["/blur", "Video"].pseudonymised == ("Video",)  # it is still personal data (recital 26)
    assert rows["/face_recognizer", "Video"].leaves == ("FaceTemplate",)  # it drops the picture and says who it was
    assert not any(row.neighbours for row in rows.values())  # whoever reads the picture cleans it


def test_the_emergency_stop_reads_beside_the_filter() -> None:
    """The factory after its change: the filter cleans the safety video, one node still needs it as it is."""
    analysis = factory(5).analysis
    (row,) = cleanings(analysis.spread, analysis.emitted)
    assert (row.element.name, [element.name for element in row.neighbours]) == ("/filter", ["/emergency_stop"])


def test_a_category_that_is_not_asked_for_is_left_out() -> None:
    analysis = care_home().analysis
    assert cleanings(analysis.spread, ["Voice"]) == ()
    assert [(row.element.name, row.made_of, row.target) for row in makings(analysis.spread, ["FaceTemplate"])] == [
        ("/face_recognizer", "Video", "FaceTemplate")
    ]


@pytest.mark.parametrize("stated", [True, False])
def test_whether_a_method_is_stated_is_as_the_statement_says_that_decides(*, stated: bool) -> None:
    """Rule S7. The case that differed: the CNIL's record asked the highest rank, the document any statement."""
    high, low = (
        Statement("sanitizer", ("Face",), (rank, 0), Place("labels", rank), Method.PSEUDONYMISE, stated=told)
        for rank, told in ((2, stated), (1, not stated))
    )
    assert facts("/n0", [low, high], "Face", HIERARCHY).unstated is not stated
    assert facts("/n0", [high, low], "Face", HIERARCHY).unstated is not stated
