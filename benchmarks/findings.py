"""How an answer grows with its findings: time and memory for each of many, at most 1.5 times those for each of few.

    python benchmarks/findings.py [--quick]

1,000, 10,000 and 100,000 findings (without the last with --quick), through the command itself, a fresh process each.
Two shapes: all sources and leaks around one topic, and islands of 25 findings each. From CPU seconds and peak memory
those of a tiny policy in the same format are taken away, which are the start of the program. Ends with 1 if a bound is
missed.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from math import isqrt
from pathlib import Path
from statistics import median
from subprocess import DEVNULL, Popen
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Line, print_header, print_line
from worst_case import node, policy, topics

if TYPE_CHECKING:
    from collections.abc import Callable

BOUND = 1.5
SIZES = (1_000, 10_000, 100_000)
ROUNDS = {1_000: 3, 10_000: 3, 100_000: 1}
SIDE = 5  # sources of an island, and leaks
LABELS = "labels: 1\nnodes:\n  /s*: {source: [Video]}\n  /l*: {leak: [Video]}\n"
FORMATS = {
    "text": ("analyze", 1),
    "json": ("analyze", 1),
    "sarif": ("analyze", 1),
    "html": ("report", 0),
}  # command, exit code


@dataclass(frozen=True, slots=True)
class Cost:
    """CPU seconds and MB of a run; of a median."""

    seconds: float
    megabytes: float


def hub(findings: int) -> tuple[str, int]:
    """Return a policy in which each source reaches each leak by one topic, and how many findings that makes."""
    side = isqrt(findings)
    return policy(*_ends("0", side)), side * side


def islands(findings: int) -> tuple[str, int]:
    """Return a policy of topics by themselves, each with five sources and five leaks."""
    number = findings // SIDE**2
    return policy(*(end for island in range(number) for end in _ends(str(island), SIDE))), number * SIDE**2


def _ends(topic: str, side: int) -> list[str]:
    roles = (("s", "publish"), ("l", "subscribe"))
    return [node(f"{end}{topic}_{i}", topics(role, [f"/t{topic}"])) for end, role in roles for i in range(side)]


SHAPES: dict[str, tuple[Callable[[int], tuple[str, int]], tuple[str, ...]]] = {
    "around one topic": (hub, tuple(FORMATS)),
    "in islands": (islands, ("json",)),
}


def cost(folder: Path, text: str, form: str, rounds: int) -> Cost:
    """Return what an answer costs, the median of some rounds.

    Raises
    ------
    SystemExit
        If the command ends otherwise than it has to: then there is nothing to compare.
    """
    (folder / "p.xml").write_text(text, "utf-8")
    (folder / "l.yaml").write_text(LABELS, "utf-8")
    name, code = FORMATS[form]
    command = [sys.executable, "-m", "rosprivacy", name, "p.xml", "-l", "l.yaml", "-f", form, "-o", f"answer.{form}"]
    costs = []
    for _ in range(rounds):
        with Popen(command, cwd=folder, stdout=DEVNULL) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != code:
            sys.exit(f"{' '.join(command)} ended with {process.returncode}")
        costs.append(Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024))
    return Cost(median(one.seconds for one in costs), median(one.megabytes for one in costs))


def main() -> int:
    """Print the table; return the exit code."""
    sizes = SIZES[:2] if "--quick" in sys.argv else SIZES
    print_header()
    missed = 0
    with TemporaryDirectory() as folder:
        for shape, (made, formats) in SHAPES.items():
            for form in formats:
                start = cost(Path(folder), hub(1)[0], form, ROUNDS[SIZES[0]])
                before: tuple[float, float, int] | None = None
                for size in sizes:
                    text, number = made(size)
                    whole = cost(Path(folder), text, form, ROUNDS[size])
                    time = (whole.seconds - start.seconds) / number
                    space = (whole.megabytes - start.megabytes) / number
                    if before:
                        for line in _lines(f"{form}, {shape}", (time, space, number), before):
                            missed += not print_line(line).met
                    before = time, space, number
    return 1 if missed else 0


def _lines(what: str, many: tuple[float, float, int], few: tuple[float, float, int]) -> list[Line]:
    numbers = f"each of {many[2]:,} / of {few[2]:,} findings, {what}"
    return [
        Line(f"{unit}: {numbers}", f"{a * scale:.3g} {of}", f"{b * scale:.3g} {of}", a / b, BOUND)
        for unit, of, scale, a, b in (
            ("CPU", "us", 1e6, many[0], few[0]),
            ("memory", "kB", 1e3, many[1], few[1]),
        )
    ]


if __name__ == "__main__":
    sys.exit(main())
