"""What the ledger costs beside the analysis that it tells of, in one run (at most 1.5 times).

TurtleBot3 of the corpus with the paper's labels for one kind of data and for 24, and the care home of the examples.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Row, corpus, timed_or_counted
from turtlebot import POLICY, labels_of

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.whatif.ledger import ledger
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Measured

BOUND = 1.5
EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
KINDS = ["Video", "Voice", "Location", "HomeMap"]


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    rounds = 5 if quick else 9
    policy = str(corpus() / POLICY)
    with TemporaryDirectory() as folder:
        for count in (1, len(KINDS)):
            labels = str(labels_of(KINDS[:count], Path(folder)))
            what = f"TurtleBot3, {count} kinds of data"
            yield Row(
                f"ledger, {what}",
                "analysis",
                partial(measured, policy, labels, rounds, quick=quick),
                BOUND,
                counts=quick,
            )
    policy, labels = (str(EXAMPLES / "care-home" / f"care-home.{what}") for what in ("policy.xml", "labels.yaml"))
    yield Row(
        "ledger, care home", "analysis", partial(measured, policy, labels, rounds, quick=quick), BOUND, counts=quick
    )


def measured(policy: str, labels: str, rounds: int, *, quick: bool) -> Measured:
    """Compare the ledger of one system with its analysis, both from the graph on."""
    result = answer_robot((policy,), (labels,), Settings())
    graph, bound, hierarchy = result.analysis.graph, result.bound, result.vocabulary.hierarchy
    told = ledger(result.analysis, bound, hierarchy)
    note = f"{len(told)} rows, {sum(row.closes for row in told)} close a path"
    return timed_or_counted(
        rounds,
        lambda: ledger(result.analysis, bound, hierarchy),
        lambda: analyse(graph, bound, hierarchy),
        quick=quick,
        note=note,
    )
