"""What the ledger costs beside the analysis that it tells of, in one run (at most 1.5 times).

    python benchmarks/ledger.py

TurtleBot3 of the corpus with the paper's labels for one kind of data and for 24, and the care home of the examples.
Prints medians and ratios; ends with 1 if the bound is missed.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import compared, corpus, print_header, print_line, side_by_side
from turtlebot import POLICY, labels_of

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.ledger import ledger
from rosprivacy.robot_system import answer_robot
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from measure import Line

BOUND = 1.5
EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
KINDS = ["Video", "Voice", "Location", "HomeMap"]


def measured(what: str, policy: str, labels: str) -> Line:
    """Time the ledger of one system against its analysis, both from the graph on."""
    result = answer_robot((policy,), (labels,), Settings())
    graph, bound, hierarchy = result.analysis.graph, result.bound, result.vocabulary.hierarchy
    rows = ledger(result.analysis, bound, hierarchy)
    seconds = side_by_side(
        9, lambda: ledger(result.analysis, bound, hierarchy), lambda: analyse(graph, bound, hierarchy)
    )
    closing = sum(row.closes for row in rows)
    return compared(
        f"ledger / analysis, {what}", seconds, bound=BOUND, note=f"{len(rows)} rows, {closing} close a path"
    )


def main() -> int:
    """Print the table; return the exit code."""
    policies = corpus()
    print_header()
    missed = 0
    with TemporaryDirectory() as folder:
        for count in (1, len(KINDS)):
            file = labels_of(KINDS[:count], Path(folder))
            what = f"TurtleBot3, {count} kinds of data"
            missed += not print_line(measured(what, str(policies / POLICY), str(file))).met
    os.chdir(EXAMPLES / "care-home")
    missed += not print_line(measured("care home", "care-home.policy.xml", "care-home.labels.yaml")).met
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
