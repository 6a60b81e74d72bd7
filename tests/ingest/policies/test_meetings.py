"""Literal ends tell which wildcards meet, as the table of all tokens does (rule S4); each pair is told once."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Element
from rosprivacy.ingest.policies.names import overlaps
from rosprivacy.ingest.policies.wildcards import literal_ends, meetings

SIGNS = ("a", "b", "/", "[ab]", "[b-a]", "[!a]", "?", "*", "*", "[", "]")
WRITTEN = st.lists(st.sampled_from(SIGNS), max_size=7).map("".join)


@given(st.sets(WRITTEN, max_size=12), st.sets(WRITTEN, max_size=12))
def test_each_pair_that_meets_is_in_one_group(written: set[str], read: set[str]) -> None:
    writing, reading = (
        {Element("topic", name, side=side): ends for name in sorted(names) if (ends := literal_ends(name))}
        for names, side in ((written, "write"), (read, "read"))
    )
    placed: list[int] = []
    pairs = [
        (writer.name, reader.name)
        for writers, readers in meetings(writing, reading, lambda _, groups: placed.append(groups))
        for writer in writers
        for reader in readers
    ]
    assert len(pairs) == len(set(pairs))
    assert set(pairs) == {(a.name, b.name) for a in writing for b in reading if overlaps(a.name, b.name)}
    assert len(placed) == len(writing) + len(reading)


@pytest.mark.slow
def test_ends_tell_the_same_as_the_table_for_200000_random_pairs() -> None:
    random = Random(18)  # noqa: S311 - no secret
    names = ["".join(random.choices(SIGNS, k=random.randint(1, 7))) for _ in range(2_000)]
    told = [(name, ends) for name in dict.fromkeys(names) if (ends := literal_ends(name))]
    asked = met = 0
    while asked < 200_000:
        (one, ours), (other, theirs) = random.choices(told, k=2)
        both = all(a.startswith(b) or b.startswith(a) for a, b in zip(ours, theirs, strict=True))
        assert overlaps(one, other) == both, (one, other)
        asked, met = asked + 1, met + both
    assert 10_000 < met < 190_000  # neither always nor never
