"""What is left out of a comparison has no name in common (rule S4); and what is left in grows with the names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Element
from rosprivacy.ingest.policies.name_index import Expressions, PlainNames
from rosprivacy.ingest.policies.names import covers, is_pattern, literal_suffix, overlaps

if TYPE_CHECKING:
    from collections.abc import Callable

LAST = chr(0x10FFFF)
WRITTEN = st.text(f"ab/*?[]!-^{LAST}", max_size=8)
PLAIN = st.text(f"ab/-!{LAST}", max_size=7)
SHAPES: dict[str, Callable[[int], str]] = {
    "other beginnings": lambda i: f"/ns{i}/part/*",
    "a star before the part": lambda i: f"/robot*/part{i}/image",
    "a star at the beginning": lambda i: f"*/part{i}/image",
    "a class at the end": lambda i: f"/robot{i}*/image[0-9]",
}


def topic(name: str) -> Element:
    return Element("topic", name)


@given(WRITTEN, PLAIN)
def test_the_literal_suffix_ends_every_name_that_is_covered(pattern: str, name: str) -> None:
    if covers(pattern, name):
        assert name.endswith(literal_suffix(pattern))


@given(WRITTEN, st.lists(WRITTEN, max_size=12))
@example("/a*b", ["/*/b", "*", "/ab", "b", ""])
def test_every_expression_that_shares_a_name_is_near(asked: str, others: list[str]) -> None:
    near = {element.name for element in Expressions((one, topic(one)) for one in others).near(asked)}
    assert {one for one in others if overlaps(asked, one)} <= near <= set(others)


@given(WRITTEN, st.lists(PLAIN, max_size=12, unique=True))
def test_every_name_that_is_covered_is_near(asked: str, names: list[str]) -> None:
    for few, searched in ((0, 64), (0, 0), (16, 0)):  # by what it holds inside, in either way, and by its ends alone
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("rosprivacy.ingest.policies.name_index.FEW", few)
            patch.setattr("rosprivacy.ingest.policies.name_index.SEARCHED", searched)
            near = [name for name, _ in PlainNames(((name, topic(name)) for name in names), [asked]).near(asked)]
        assert len(near) == len(set(near))
        assert {name for name in names if is_pattern(asked) and covers(asked, name)} <= set(near) <= set(names)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_few_of_many_are_near(shape: str) -> None:
    """Each of 1,000 expressions of a kind is compared with some that differ in a number, not with all."""
    written = [SHAPES[shape](number) for number in range(1_000)]
    index = Expressions((one, topic(one)) for one in written)
    compared = sum(len(list(index.near(one))) for one in written)
    assert len(written) <= compared <= 10 * len(written)


def test_names_are_found_by_their_end() -> None:
    names = [(f"/robot{number}/part/image{number}", topic("/x")) for number in range(1_000)]
    index = PlainNames(names)
    assert [name for name, _ in index.near("/robot*/image17")] == [names[17][0]]
    assert len(list(index.near("/robot1*"))) == 111


@pytest.mark.parametrize(
    "shape", [lambda i: f"/robot*/s{i}/*", lambda i: f"/*/part{i}_*", lambda i: f"*image{i}?"], ids=["s", "part", "?"]
)
def test_a_few_of_many_plain_names_are_near(shape: Callable[[int], str]) -> None:
    """What begins and ends alike is told apart by what stands between the wildcards."""
    asked = [shape(number) for number in range(1_000)]
    names = [one.replace("*", "/x").replace("?", "y") for one in asked]
    index = PlainNames(((name, topic(name)) for name in names), asked)
    compared = sum(len(list(index.near(one))) for one in asked)
    assert len(asked) <= compared <= 10 * len(asked)
