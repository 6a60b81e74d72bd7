"""A second middleware as judge of what we say of a keystore: Cyclone DDS 0.10 of Debian with its security plugins."""

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
DIFFERING = [name for name, row in ROWS.items() if row.cyclone != row.fast_dds]


@pytest.fixture(scope="module")
def outcomes(cyclone_judge: Judge) -> dict[str, Outcome]:
    return cyclone_judge(TRIALS)


@pytest.mark.parametrize("name", ROWS)
def test_data_come_as_far_as_is_written(outcomes: dict[str, Outcome], name: str) -> None:
    print(
        f"{name}: Cyclone DDS: {outcomes[name].said(CHATTER)}; Fast DDS: {ROWS[name].fast_dds}; we: {ROWS[name].ours}"
    )
    assert outcomes[name].said(CHATTER) == ROWS[name].cyclone


@pytest.mark.parametrize("name", DIFFERING)
def test_where_it_differs_from_fast_dds_we_say_what_passes_with_either(
    cli: Cli, outcomes: dict[str, Outcome], name: str
) -> None:
    outcome = outcomes[name]
    assert ours(cli, outcome.keystore, outcome.domain) == ROWS[name].ours
    if ROWS[name].cyclone == ARRIVES:
        assert enforced(cli, outcome.keystore, outcome.domain) == FLOW


def test_no_row_calls_no_flow_what_passes() -> None:
    assert {row.ours for row in ROWS.values() if row.cyclone == ARRIVES} == {FLOW, TOLD}


@pytest.mark.parametrize("name", STRANGERS)
def test_who_has_no_security_meets_also_whom_governance_opens_to_it(outcomes: dict[str, Outcome], name: str) -> None:
    assert outcomes[name].said(CHATTER) == STRANGERS[name][2]


def test_of_several_topics_of_one_pair_those_arrive_that_both_may(outcomes: dict[str, Outcome]) -> None:
    several = outcomes["several"]
    assert several.writers == {"rt/a", "rt/ab", "rt/b"}
    assert several.readers == {"rt/a", "rt/ab", "rt/abc", "rt/c"}
    assert several.arrived == {"rt/a", "rt/ab"}
