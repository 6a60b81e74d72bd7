"""The real middleware as judge of what we say of a keystore: Fast DDS 2.9 of Debian, security plugins compiled in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import cli
from tests.helpers.secured_rows import ARRIVES, CHATTER, FLOW, ROWS, STRANGERS, TOLD, TRIALS, enforced, ours

if TYPE_CHECKING:
    from tests.helpers.command import Cli
    from tests.helpers.secured_dds import Judge, Outcome

__all__ = ["cli"]
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def outcomes(judge: Judge) -> dict[str, Outcome]:
    return judge(TRIALS)


@pytest.mark.parametrize("name", ROWS)
def test_what_passes_is_what_we_say_or_more(cli: Cli, outcomes: dict[str, Outcome], name: str) -> None:
    row, outcome = ROWS[name], outcomes[name]
    said = ours(cli, outcome.keystore, outcome.domain)
    print(f"{name}: Fast DDS: {outcome.said(CHATTER)}; we: {said} {row.why}")
    assert (outcome.said(CHATTER), said) == (row.fast_dds, row.ours)
    if row.fast_dds == ARRIVES:  # on the control topic, too, so the other way round says nothing
        assert enforced(cli, outcome.keystore, outcome.domain) == FLOW


def test_no_row_calls_no_flow_what_passes_and_each_that_says_more_says_why() -> None:
    assert {row.ours for row in ROWS.values() if row.fast_dds == ARRIVES} == {FLOW, TOLD}
    assert all(row.why for row in ROWS.values() if row.fast_dds != ARRIVES and row.ours == FLOW)


@pytest.mark.parametrize("name", STRANGERS)
def test_who_has_no_security_meets_only_its_like(outcomes: dict[str, Outcome], name: str) -> None:
    print(f"{name}: Fast DDS: {outcomes[name].said(CHATTER)}")
    assert outcomes[name].said(CHATTER) == STRANGERS[name][1]


def test_of_several_topics_of_one_pair_those_arrive_that_both_may(outcomes: dict[str, Outcome]) -> None:
    several = outcomes["several"]
    assert several.writers == {"rt/a", "rt/ab", "rt/b"}
    assert several.readers == {"rt/a", "rt/ab", "rt/abc", "rt/c"}
    assert several.arrived == {"rt/a", "rt/ab"}
