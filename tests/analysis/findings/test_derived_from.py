"""Where what a node makes of other data comes from (rules S8, S10)."""

from __future__ import annotations

from rosprivacy.analysis.findings.derived_from import origins
from tests.helpers.systems import System, statement


def test_made_past_no_leak_although_it_also_arrives_ready_made_through_one() -> None:
    """/n0 sends faces to /n1, which makes Bio of them, is a leak of it, and sends both on to /n2."""
    makes, leak = statement("derivation", "Face", to="Bio"), statement("leak", "Bio")
    said = {0: [statement("source", "Face")], 1: [makes, leak], 2: [makes, leak]}
    edges = [(0, 3), (3, 1), (1, 4), (4, 2)]
    made = {(o.maker, o.category): o for o in origins(System(3, 2, edges, said, {}).analyse().spread)}
    assert set(made) == {(1, "Bio"), (2, "Bio")}
    assert made[2, "Bio"].path == (0, 3, 1, 4, 2)
    assert made[2, "Bio"].flows == tuple(range(len(edges)))
    assert not made[2, "Bio"].past_leak  # up to /n2 there are faces only


def test_made_past_no_leak_although_every_search_finds_it_ready_made() -> None:
    """/n0 sends Any and Track to /n1, a leak of Any, which sends both on to /n2; there Any is made of Track, too."""
    said = {
        0: [statement("source", "Any"), statement("source", "Track")],
        1: [statement("leak", "Any")],
        2: [statement("derivation", "Track", to="Any"), statement("leak", "Any")],
    }
    edges = [(0, 3), (3, 1), (1, 4), (4, 2)]
    (origin,) = origins(System(3, 2, edges, said, {}).analyse().spread)
    assert (origin.maker, origin.category, origin.path) == (2, "Any", (0, 3, 1, 4, 2))
    assert not origin.past_leak
