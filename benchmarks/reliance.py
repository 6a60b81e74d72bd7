"""What it costs to say what the answer hangs on, beside the analysis that it tells of, in one run (less than twice).

    python benchmarks/reliance.py

TurtleBot3 of the corpus with the paper's labels for one kind of data, for 4 and for 24, and the care home of the
examples. Prints medians and ratios; ends with 1 if the bound is missed.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from ledger import EXAMPLES, KINDS
from measure import compared, corpus, print_header, print_line, side_by_side
from turtlebot import POLICY, chosen_categories, labels_of

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.reliance import reliances
from rosprivacy.robot_system import answer_robot
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from measure import Line

BOUND = 2


def measured(what: str, policy: str, labels: str, bound: float | None = BOUND) -> Line:
    """Time what one answer hangs on against its analysis, both from the graph on."""
    result = answer_robot((policy,), (labels,), Settings())
    graph, labels_bound, hierarchy = result.analysis.graph, result.bound, result.vocabulary.hierarchy
    rows = reliances(result.analysis, labels_bound, hierarchy)
    seconds = side_by_side(
        9, lambda: reliances(result.analysis, labels_bound, hierarchy), lambda: analyse(graph, labels_bound, hierarchy)
    )
    found = sum(bool(row.findings) for row in rows)
    note = f"{len(rows)} statements on which something hangs, {found} of them findings"
    return compared(f"what it hangs on / analysis, {what}", seconds, bound=bound, note=note)


def main() -> int:
    """Print the table; return the exit code."""
    policies = corpus()
    print_header()
    missed = 0
    with TemporaryDirectory() as folder:
        for names in (KINDS[:1], KINDS, chosen_categories(24)[0]):
            file = labels_of(names, Path(folder))
            what = f"TurtleBot3, {len(names)} kinds of data"
            missed += not print_line(measured(what, str(policies / POLICY), str(file))).met
    os.chdir(EXAMPLES / "care-home")
    print_line(measured("care home", "care-home.policy.xml", "care-home.labels.yaml", None))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
