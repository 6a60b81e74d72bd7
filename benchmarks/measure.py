"""What the benchmarks share: a row of the table, timing side by side, medians.

Only ratios count: a single number of seconds says more about the machine and its other users than about the program.
So the sides of a comparison take turns, each round gives one ratio, and the median of these is reported. Seconds are
those of the processor, in this process and in those that it starts and waits for, so that other load matters little.
It still matters: on a busy machine one ratio was 1.5 and then 2.5. So what fails CI is counted, and not timed: bytes,
and calls of functions, which are the same at any load.

A script declares its rows in ``rows(quick=…)``, a generator. What a row needs is made ready before it, and its
measurement is called before the generator goes on, so that nothing is kept or made ready in vain.
"""

from __future__ import annotations

import cProfile
import gc
import os
import pstats
import resource
import subprocess
import sys
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

REPOSITORY = Path(__file__).resolve().parent.parent


class NotMeasured(Exception):  # noqa: N818 - no error
    """What a benchmark needs is not there, or takes too long for the quick form; its text says which."""


@dataclass(frozen=True, slots=True)
class Measured:
    """What one measurement gave.

    Attributes
    ----------
    ours, against
        Both sides, with their unit: medians.
    ratio
        Ours / the other; None where there is nothing to compare with.
    note
        What the reader has to know beside it.
    """

    ours: str
    against: str = ""
    ratio: float | None = None
    note: str = ""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of the table.

    Attributes
    ----------
    ours, against
        What is compared with what.
    measure
        Measures it; called again where the bound was missed.
    bound
        What the ratio may be at most; None where it is only reported.
    goal
        Whether the bound is a goal: to be below it is hoped for and reported, not demanded.
    counts
        Whether the ratio is one of counts, not of times: in the quick form only such a bound is demanded.
    """

    ours: str
    against: str
    measure: Callable[[], Measured]
    bound: float | None = None
    goal: bool = False
    counts: bool = False


def processor() -> float:
    """Return the processor's seconds so far, of this process and of those that it has waited for."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def wall() -> float:
    """Return the time, for what a server does that nobody waits for."""
    return time.perf_counter()


def side_by_side(
    rounds: int, *sides: Callable[[], object], clock: Callable[[], float] = processor
) -> list[list[float]]:
    """Return the seconds of each side in each round; they take turns, and each round another one begins.

    The first round warms files and caches up and does not count.
    """
    seconds: list[list[float]] = [[0.0] * rounds for _ in sides]
    for number in range(-1, rounds):
        for shift in range(len(sides)):
            side = (number + shift) % len(sides)
            gc.collect()  # else what one side leaves is counted with the next
            begin = clock()
            sides[side]()
            if number >= 0:
                seconds[side][number] = clock() - begin
    return seconds


def compared(seconds: Sequence[Sequence[float]], note: str = "") -> Measured:
    """Compare our seconds with the other side's, round by round; the ratio is the median of the rounds'."""
    ours, other = seconds
    ratio = median(a / b for a, b in zip(ours, other, strict=True))
    return Measured(shown(ours), shown(other), ratio, note)


def timed(
    rounds: int,
    ours: Callable[[], object],
    against: Callable[[], object],
    *,
    clock: Callable[[], float] = processor,
    note: str = "",
) -> Measured:
    """Time both sides in turns and compare them."""
    return compared(side_by_side(rounds, ours, against, clock=clock), note)


def calls(work: Callable[[], object]) -> int:
    """Return how many functions some work calls, of Python and of C: the same number at any load."""
    profile = cProfile.Profile()
    profile.enable()
    try:
        work()
    finally:
        profile.disable()
    return sum(entry.callcount for entry in profile.getstats())


def calls_of(*arguments: str | Path) -> int:
    """Return how many functions ``rosprivacy`` calls, in a fresh process in which sets have the same order each time.

    Raises
    ------
    SystemExit
        If it writes no profile: then there is nothing to compare.
    """
    _remember()
    with TemporaryDirectory() as folder:
        file = Path(folder) / "profile"
        words = [sys.executable, "-m", "cProfile", "-o", str(file), "-m", "rosprivacy", *map(str, arguments)]
        done = subprocess.run(
            words, capture_output=True, text=True, check=False, env={**os.environ, "PYTHONHASHSEED": "0"}
        )
        if not file.is_file():
            sys.exit(f"{' '.join(words)} ended with {done.returncode}:\n{done.stderr}")
        return int(vars(pstats.Stats(str(file)))["total_calls"])


@cache
def _remember() -> None:
    """Parse the ontology once, of which each process after that finds what it remembers."""
    run(sys.executable, "-m", "rosprivacy", "categories")


def counted(ours: int, against: int, note: str = "") -> Measured:
    """Compare two numbers of calls."""
    return Measured(f"{ours:,} calls", f"{against:,} calls", ours / against, note)


def timed_or_counted(
    rounds: int, ours: Callable[[], object], against: Callable[[], object], *, quick: bool, note: str = ""
) -> Measured:
    """Time both sides in turns; in the quick form count their calls, once what both remember is there."""
    if not quick:
        return timed(rounds, ours, against, note=note)
    for work in (ours, against):
        work()
    return counted(calls(ours), calls(against), note)


def per_robot(seconds: Sequence[Sequence[float]], robots: tuple[int, int], note: str = "") -> Measured:
    """Compare what one robot costs in a large fleet and in a small one, round by round."""
    each = [[one / count for one in some] for some, count in zip(seconds, robots, strict=True)]
    ratio = median(a / b for a, b in zip(*each, strict=True))
    ours, other = (f"{median(some) * 1e6:,.0f} us" for some in each)
    return Measured(ours, other, ratio, note)


def calls_per_robot(large: Callable[[], object], small: Callable[[], object], robots: tuple[int, int]) -> Measured:
    """Compare how many calls one robot costs in a large fleet and in a small one."""
    large(), small()
    ours, other = (calls(work) / count for work, count in zip((large, small), robots, strict=True))
    return Measured(f"{ours:,.0f} calls", f"{other:,.0f} calls", ours / other)


def shown(seconds: Sequence[float]) -> str:
    """Return the median of some seconds, for people."""
    middle = median(seconds)
    return f"{middle * 1000:.1f} ms" if middle < 1 else f"{middle:.2f} s"


def run(*command: str | Path) -> None:
    """Run a command in a fresh process, to its end; its output is read and thrown away, as by a pipe.

    Python may keep what it compiles, as an installation does: else ours alone would be compiled anew in each process.

    Raises
    ------
    SystemExit
        If it fails: then there is nothing to compare.
    """
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    words = [str(part) for part in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr}")


def run_each(commands: Iterable[Sequence[str | Path]]) -> None:
    """Run commands one after the other, each in a fresh process."""
    for command in commands:
        run(*command)


def corpus() -> Path:
    """Return the folder of the public policies.

    Raises
    ------
    NotMeasured
        If it is not there.
    """
    folder = Path(os.environ.get("ROSPRIVACY_CORPUS", REPOSITORY.parent / "shared" / "corpus"))
    if not folder.is_dir():
        raise NotMeasured(f"no corpus at {folder}; set ROSPRIVACY_CORPUS")
    return folder.resolve()
