"""How fast and how large: the analysis against what it is measured by, in one run.

    python benchmarks/analyze.py [--quick]

Prints medians and ratios with their bounds and goals; ends with 1 if a bound is missed. ``--quick`` repeats less and
takes a fleet of 1,000 robots in place of 10,000.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import fleet_flows
import reading
import startup
import turtlebot
from measure import corpus, print_header, print_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Line


def lines(policies: Path, folder: Path, *, quick: bool) -> Iterator[Line]:
    yield from turtlebot.compare(policies, folder, quick=quick)
    yield from fleet_flows.compare(quick=quick)
    yield from reading.compare(policies, quick=quick)
    yield startup.compare(folder, quick=quick)


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description="Measured claims about the analysis, as ratios.")
    parser.add_argument("--quick", action="store_true", help="fewer repetitions, and a fleet of 1,000 robots")
    quick = parser.parse_args().quick
    print_header()
    with TemporaryDirectory() as folder:
        measured = [print_line(line) for line in lines(corpus(), Path(folder), quick=quick)]
    missed = [line for line in measured if not line.met and not line.goal]
    print(f"\n{len(missed)} bounds missed" if missed else "\nall bounds met")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
