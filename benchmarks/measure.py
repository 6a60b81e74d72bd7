"""What the benchmarks share: timing side by side, medians, a table of ratios with their bounds.

Only ratios count: a single number of seconds says more about the machine and its other users than about the program.
So the sides of a comparison take turns, each round gives one ratio, and the median of these is reported.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

REPOSITORY = Path(__file__).resolve().parent.parent
WIDTH = 62


@dataclass(frozen=True, slots=True)
class Line:
    """One line of the table.

    Attributes
    ----------
    what
        Was measured.
    ours, other
        Medians, with their unit.
    ratio
        Ours / other, the median over the rounds; None where there is nothing to compare with.
    bound
        What the ratio may be at most; None where it is only reported.
    goal
        Whether the bound is a goal: to be below it is hoped for and reported, not demanded.
    note
        What the reader has to know beside it.
    """

    what: str
    ours: str
    other: str = ""
    ratio: float | None = None
    bound: float | None = None
    goal: bool = False
    note: str = ""

    @property
    def met(self) -> bool:
        """Whether the bound or goal is reached, or there is none."""
        return self.ratio is None or self.bound is None or self.ratio <= self.bound

    def text(self) -> str:
        """Return the line for the table, its note below it."""
        ratio = "" if self.ratio is None else f"{self.ratio:.3g}"
        bound = "" if self.bound is None else f"{'goal' if self.goal else 'at most'} {self.bound:g}"
        verdict = "" if self.bound is None else "met" if self.met else "not met" if self.goal else "MISSED"
        columns = f"{self.what:<{WIDTH}} {self.ours:>12} {self.other:>12} {ratio:>8}  {bound:<11} {verdict}".rstrip()
        return f"{columns}\n    {self.note}" if self.note else columns


def print_header() -> None:
    print(f"{'median':<{WIDTH}} {'ours':>12} {'other':>12} {'ratio':>8}  bound")


def print_line(line: Line) -> Line:
    """Print at once, since the whole run takes minutes, and hand the line back."""
    print(line.text(), flush=True)
    return line


def side_by_side(rounds: int, *sides: Callable[[], object]) -> list[list[float]]:
    """Return the seconds of each side in each round; they take turns, and each round another one begins.

    The first round warms files and caches up and does not count.
    """
    seconds: list[list[float]] = [[0.0] * rounds for _ in sides]
    for number in range(-1, rounds):
        for shift in range(len(sides)):
            side = (number + shift) % len(sides)
            begin = time.perf_counter()
            sides[side]()
            if number >= 0:
                seconds[side][number] = time.perf_counter() - begin
    return seconds


def compared(
    what: str, seconds: Sequence[Sequence[float]], bound: float | None = None, *, goal: bool = False, note: str = ""
) -> Line:
    """Return the line for our seconds and the other side's, round by round; its ratio is the median of the rounds'."""
    ours, other = seconds
    ratio = median(a / b for a, b in zip(ours, other, strict=True))
    return Line(what, _shown(ours), _shown(other), ratio, bound, goal=goal, note=note)


def per_robot(
    what: str,
    seconds: Sequence[Sequence[float]],
    robots: tuple[int, int],
    bound: float | None = None,
    *,
    note: str = "",
) -> Line:
    """Return the line for what one robot costs in a large fleet and in a small one, round by round."""
    each = [[one / count for one in some] for some, count in zip(seconds, robots, strict=True)]
    ratio = median(a / b for a, b in zip(*each, strict=True))
    ours, other = (f"{median(some) * 1e6:,.0f} us" for some in each)
    return Line(what, ours, other, ratio, bound, note=note)


def _shown(seconds: Sequence[float]) -> str:
    """Return the median of some seconds, for people."""
    middle = median(seconds)
    return f"{middle * 1000:.1f} ms" if middle < 1 else f"{middle:.2f} s"


def run(*command: str | Path) -> None:
    """Run a command in a fresh process, to its end; its output is read and thrown away, as by a pipe.

    Raises
    ------
    SystemExit
        If it fails: then there is nothing to compare.
    """
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
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
    SystemExit
        If it is not there.
    """
    folder = Path(os.environ.get("ROSPRIVACY_CORPUS", REPOSITORY.parent / "shared" / "corpus"))
    if not folder.is_dir():
        sys.exit(f"{folder}: no corpus; set ROSPRIVACY_CORPUS to its folder")
    return folder.resolve()
