"""Key expressions and decisions against the real thing: ``eclipse-zenoh``, a router and sessions on loopback."""

from __future__ import annotations

from collections import Counter
from random import Random
from typing import TYPE_CHECKING

import pytest
import zenoh

from rosprivacy.ingest.zenoh_access.access_decision import Link, passes
from rosprivacy.ingest.zenoh_access.access_file import read_access
from rosprivacy.ingest.zenoh_access.key_expressions import includes, intersects, problem_of
from tests.helpers.access_lists import KEYS, MESSAGES, access_list, expression, heard, text_of
from tests.helpers.zenoh_tokens import router, session

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.zenoh_access.access_file import AccessFile
    from tests.helpers.access_lists import Samples

pytestmark = pytest.mark.xdist_group("zenoh")
LOOPBACK = Link(interfaces=frozenset({"lo"}), link_protocols=frozenset({"tcp"}))


def test_expressions_are_those_that_zenoh_takes() -> None:
    random, taken = Random(20), Counter[bool]()  # noqa: S311 - repeatable
    for _ in range(20_000):
        written = "".join(random.choices("ab/*$@#? ", (3, 3, 4, 4, 2, 1, 1, 1, 1), k=random.randint(0, 7)))
        try:
            zenoh.KeyExpr(written)
        except zenoh.ZError:
            right = False
        else:
            right = True
        assert right == (problem_of(written) is None), written
        taken[right] += 1
    assert min(taken.values()) > 1000


def test_expressions_include_and_intersect_as_those_of_zenoh() -> None:
    random, said = Random(5), Counter[tuple[bool, bool]]()  # noqa: S311 - repeatable
    pool = [expression(random) for _ in range(2000)]
    parsed = {one: zenoh.KeyExpr(one) for one in pool}
    for _ in range(40_000):
        one, other = random.choice(pool), random.choice(pool)
        theirs = parsed[one].includes(parsed[other]), parsed[one].intersects(parsed[other])
        assert (includes(one, other), intersects(one, other)) == theirs, (one, other)
        said[theirs] += 1
    assert all(said[kind] > 200 for kind in ((True, True), (False, True), (False, False)))


def expected(access: AccessFile, flow: str) -> Samples:
    """What passes, as we say it."""
    return {(message, key) for message in MESSAGES for key in KEYS if passes(access, LOOPBACK, flow, message, key)}


def compared(folder: Path, seeds: range) -> Counter[str]:
    """Put access lists to Zenoh; the counts of what passed and what did not, of both directions."""
    said = Counter[str]()
    with router() as where, session(where) as free:
        for seed in seeds:
            written = access_list(Random(seed))  # noqa: S311 - repeatable
            file = folder / f"{seed}.json5"
            file.write_text(text_of(written), "utf-8")
            access = read_access(str(file))
            with session(where, access_control=written) as held:
                for flow, sender, receiver in (("ingress", free, held), ("egress", held, free)):
                    ours = expected(access, flow)
                    assert heard(sender, receiver, ours, f"{seed} {flow}") == ours, (file.read_text("utf-8"), flow)
                    said[f"{flow} passes"] += len(ours)
                    said[f"{flow} does not"] += len(MESSAGES) * len(KEYS) - len(ours)
    return said


def test_what_gets_through_is_what_we_say(tmp_path: Path) -> None:
    assert compared(tmp_path, range(3))


@pytest.mark.slow
def test_what_gets_through_two_hundred_access_lists_is_what_we_say(tmp_path: Path) -> None:
    said = compared(tmp_path, range(100, 300))
    assert len(said) == 4
    assert min(said.values()) > 1000, said
