"""What it costs to say what the answer hangs on, beside the analysis that it tells of, in one run (less than twice).

TurtleBot3 of the corpus with the paper's labels for one kind of data, for 4 and for 24, and the care home of the
examples.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from ledger import EXAMPLES, KINDS
from measure import Row, corpus, timed_or_counted
from turtlebot import POLICY, chosen_categories, labels_of

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.whatif.reliance import reliances
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Measured

BOUND = 2


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    rounds = 5 if quick else 9
    policy = str(corpus() / POLICY)
    with TemporaryDirectory() as folder:
        for names in (KINDS[:1], KINDS, chosen_categories(24)[0]):
            labels = str(labels_of(names, Path(folder)))
            what = f"what it hangs on, TurtleBot3, {len(names)} kinds of data"
            yield Row(what, "analysis", partial(measured, policy, labels, rounds, quick=quick), BOUND, counts=quick)
    policy, labels = (str(EXAMPLES / "care-home" / f"care-home.{what}") for what in ("policy.xml", "labels.yaml"))
    yield Row("what it hangs on, care home", "analysis", partial(measured, policy, labels, rounds, quick=quick))


def measured(policy: str, labels: str, rounds: int, *, quick: bool) -> Measured:
    """Compare what one answer hangs on with its analysis, both from the graph on."""
    result = answer_robot((policy,), (labels,), Settings())
    graph, bound, hierarchy = result.analysis.graph, result.bound, result.vocabulary.hierarchy
    told = reliances(result.analysis, bound, hierarchy)
    found = sum(bool(row.findings) for row in told)
    return timed_or_counted(
        rounds,
        lambda: reliances(result.analysis, bound, hierarchy),
        lambda: analyse(graph, bound, hierarchy),
        quick=quick,
        note=f"{len(told)} statements on which something hangs, {found} of them findings",
    )
