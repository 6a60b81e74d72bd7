"""All that is claimed about speed and size, in one table: what against what, the ratio, its bound, held or missed.

    python benchmarks/all.py [--quick | --counts] [NAME …]

Ends with 1 if a bound is missed twice in a row: what misses it is measured again. NAMEs are scripts beside this one;
without any all are run. ``--quick`` is the form of each week: what has a bound, in fewer rounds, smaller, no servers.
It fails on counts only, which are the same at any load: bytes, and calls of functions. What is timed there is told.
``--counts`` is the quick form of these alone: what each change is held to.
"""

from __future__ import annotations

import argparse
import gc
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from importlib import import_module
from multiprocessing import get_context
from typing import TYPE_CHECKING

from measure import NotMeasured

from rosprivacy.cli import ENOUGH

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from measure import Measured, Row

# Scripts that declare rows, in the order in which they are run.
BENCHMARKS = (
    "startup",
    "turtlebot",
    "reading",
    "bags",
    "ledger",
    "reliance",
    "suggestions",
    "source_code",
    "scanning",
    "wildcards",
    "views",
    "fleet_flows",
    "fleet_kernel",
    "fleet_robots",
    "fleet_wiring",
    "fleet_questions",
    "fleet_spark",
    "pictures",
    "explorer",
    "report",
    "findings",
    "worst_case",
    "graph_database",
    "carried_kinds",
)
NAME, WHAT, SIDE = 14, 74, 12


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a row: its last measurement, the ratio of the first where that missed a bound that is demanded."""

    row: Row
    measured: Measured
    missed_before: float | None = None
    demanded: bool = True

    @property
    def held(self) -> bool:
        """Whether the bound holds, or there is none."""
        return self.row.bound is None or self.measured.ratio is None or self.measured.ratio <= self.row.bound

    @property
    def failed(self) -> bool:
        """Whether a bound that is demanded is missed."""
        return not self.held and self.demanded

    def text(self, benchmark: str) -> str:
        """Return the line for the table, notes below it."""
        row, got = self.row, self.measured
        ratio = "" if got.ratio is None else f"{got.ratio:.3g}"
        bound = (
            ""
            if row.bound is None
            else f"{'at most' if self.demanded else 'goal' if row.goal else 'told'} {row.bound:.3g}"
        )
        verdict = "" if row.bound is None else "held" if self.held else "MISSED" if self.demanded else "not reached"
        line = line_of(benchmark, what(row), got.ours, got.against, ratio, bound, verdict)
        again = "" if self.missed_before is None else f"measured twice: {self.missed_before:.3g} before"
        return "\n    ".join(filter(None, (line, got.note, again)))


def what(row: Row) -> str:
    return f"{row.ours} / {row.against}" if row.against else row.ours


def line_of(benchmark: str, name: str, ours: str, other: str, ratio: str, bound: str, verdict: str) -> str:
    """Return the columns of the table."""
    sides = f"{ours:>{SIDE}} {other:>{SIDE}} {ratio:>8}"
    return f"{benchmark:<{NAME}} {name:<{WHAT}} {sides}  {bound:<12} {verdict}".rstrip()


def outcome(row: Row, *, quick: bool) -> Outcome:
    """Measure a row, and once more if a bound that is demanded is missed."""
    got = Outcome(row, row.measure(), demanded=not row.goal and (row.counts or not quick))
    return replace(got, measured=row.measure(), missed_before=got.measured.ratio) if got.failed else got


def outcomes(benchmark: str, *, quick: bool, counts: bool) -> Iterator[Outcome | str]:
    """Measure the rows of one script, one after the other; a text says what was not measured, and why."""
    try:
        declared: Iterable[Row] = import_module(benchmark).rows(quick=quick)
        for row in declared:
            if (quick and row.bound is None) or (counts and not row.counts):
                continue
            try:
                yield outcome(row, quick=quick)
            except NotMeasured as why:
                yield f"{what(row)}: not measured: {why}"
    except NotMeasured as why:
        yield f"not measured: {why}"
    except ModuleNotFoundError as error:
        yield f"not measured: {error.name} is missing; pip install '.[dev,bench]'"


def measured(benchmark: str, *, quick: bool, counts: bool) -> list[str]:
    """Print the rows of one script, each as soon as it is measured; return those that fail."""
    gc.set_threshold(ENOUGH)  # as the command does
    failed = []
    for one in outcomes(benchmark, quick=quick, counts=counts):
        print(f"{benchmark:<{NAME}} {one}" if isinstance(one, str) else one.text(benchmark), flush=True)
        if not isinstance(one, str) and one.failed:
            failed.append(f"{benchmark}: {what(one.row)}")
    return failed


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description="All that is claimed about speed and size, as ratios.")
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--quick", action="store_true", help="what has a bound, smaller, without servers")
    forms.add_argument("--counts", action="store_true", help="for CI: of the quick form what is counted, and not timed")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(BENCHMARKS)}")
    asked = parser.parse_args()
    failed = []
    print(line_of("benchmark", "ours / against", "ours", "against", "ratio", "bound", ""), flush=True)
    # Each in a fresh process: what one has loaded is no part of the next one, nor of the memory of what it starts.
    for benchmark in asked.names or BENCHMARKS:
        quick = asked.quick or asked.counts
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            failed += pool.submit(measured, benchmark, quick=quick, counts=asked.counts).result()
    print("\n".join(["", *(f"missed twice: {name}" for name in failed)] if failed else ["", "all bounds held"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
