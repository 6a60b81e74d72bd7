"""Fleets: how the cost grows with the robots, how much memory they take, pairs against searches, and Spark.

    python benchmarks/fleet.py [--quick]

Prints medians and ratios with their bounds; ends with 1 if a bound is missed. ``--quick`` takes a tenth of the robots
and repeats less.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import fleet_kernel
import fleet_robots
import fleet_spark
from measure import print_header, print_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Line


def lines(folder: Path, *, quick: bool) -> Iterator[Line]:
    yield from fleet_robots.compare(folder, quick=quick)
    yield from fleet_kernel.compare(quick=quick)
    yield from fleet_spark.compare(folder, quick=quick)


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description="Measured claims about fleets, as ratios.")
    parser.add_argument("--quick", action="store_true", help="a tenth of the robots, fewer repetitions")
    quick = parser.parse_args().quick
    print_header()
    with TemporaryDirectory() as folder:
        measured = [print_line(line) for line in lines(Path(folder), quick=quick)]
    missed = [line for line in measured if not line.met and not line.goal]
    print(f"\n{len(missed)} bounds missed" if missed else "\nall bounds met")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
