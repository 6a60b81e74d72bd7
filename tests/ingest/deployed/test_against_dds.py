"""Real middlewares as judges of what we say of a keystore: Fast DDS 2.9 and Cyclone DDS 0.10 of Debian, secured."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.helpers.secured_rows import ARRIVES, CHATTER, FLOW, ROWS, STRANGERS, TOLD, TRIALS, enforced, ours

if TYPE_CHECKING:
    from tests.helpers.command import Cli
    from tests.helpers.secured_dds import Outcome

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("dds")]


class Judged(NamedTuple):
    middleware: str  # a column of ROWS
    outcomes: dict[str, Outcome]


@pytest.fixture(scope="module", params=[("fast_dds", "judge"), ("cyclone", "cyclone_judge")], ids=lambda one: one[0])
def judged(request: pytest.FixtureRequest) -> Judged:
    middleware, judge = request.param
    return Judged(middleware, request.getfixturevalue(judge)(TRIALS))


@pytest.mark.parametrize("name", ROWS)
def test_what_passes_is_what_we_say_or_more(cli: Cli, judged: Judged, name: str) -> None:
    row, outcome = ROWS[name], judged.outcomes[name]
    arrived, said = outcome.said(CHATTER), ours(cli, outcome.keystore, outcome.domain)
    print(f"{name}: {judged.middleware}: {arrived}; we: {said} {row.why}")
    assert (arrived, said) == (getattr(row, judged.middleware), row.ours)
    if arrived == ARRIVES:  # on the control topic, too, so the other way round says nothing
        assert enforced(cli, outcome.keystore, outcome.domain) == FLOW


def test_no_row_calls_no_flow_what_passes_and_each_that_says_more_says_why() -> None:
    assert {row.ours for row in ROWS.values() if ARRIVES in (row.fast_dds, row.cyclone)} == {FLOW, TOLD}
    assert all(row.why for row in ROWS.values() if row.fast_dds != ARRIVES and row.ours == FLOW)


@pytest.mark.parametrize("name", STRANGERS)
def test_who_has_no_security_meets_its_like_and_with_cyclone_dds_whom_governance_opens(
    judged: Judged, name: str
) -> None:
    of_fast_dds, of_cyclone = STRANGERS[name][1:3]
    assert judged.outcomes[name].said(CHATTER) == (of_fast_dds if judged.middleware == "fast_dds" else of_cyclone)


def test_of_several_topics_of_one_pair_those_arrive_that_both_may(judged: Judged) -> None:
    several = judged.outcomes["several"]
    assert several.writers == {"rt/a", "rt/ab", "rt/b"}
    assert several.readers == {"rt/a", "rt/ab", "rt/abc", "rt/c"}
    assert several.arrived == {"rt/a", "rt/ab"}
