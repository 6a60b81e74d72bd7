"""How an answer grows with its findings: each further one takes at most 1.5 times what each took before.

1,000, 10,000 and 100,000 findings (1,000, 4,000 and 16,000 in the quick form), by the command itself, in a fresh
process. Two shapes: all sources and leaks around one topic, and islands of 25 findings each. What the findings from
10,000 to 100,000 take in processor time and in peak memory, for each, is compared with what those from 1,000 to 10,000
take: the start of the program, which has memory to spare, is in neither. In the quick form calls of functions stand in
place of the time.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import isqrt
from pathlib import Path
from statistics import median
from subprocess import DEVNULL, Popen
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Measured, Row, calls_of
from worst_case import node, policy, topics

from rosprivacy.analysis.python_311 import chdir

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

BOUND = 1.5
SIZES, QUICK = (1_000, 10_000, 100_000), (1_000, 4_000, 16_000)
ROUNDS = 3  # of all but the largest size
SIDE = 5  # sources of an island, and leaks
LABELS = "labels: 1\nnodes:\n  /s*: {source: [Video]}\n  /l*: {leak: [Video]}\n"
COMMANDS = {"text": "analyze", "json": "analyze", "sarif": "analyze", "html": "report"}
EXITS = {"analyze": 1, "report": 0}


@dataclass(frozen=True, slots=True)
class Cost:
    """Of a run: findings, CPU seconds or calls, MB at the most."""

    findings: int
    work: float
    megabytes: float


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    sizes = QUICK if quick else SIZES
    for shape, (made, formats) in SHAPES.items():
        for form in formats[: 2 if quick else None]:
            ours = f"each from {sizes[1]:,} to {sizes[2]:,} findings {shape}, {form}"
            yield Row(
                ours, f"from {sizes[0]:,} on", partial(_beside, made, form, sizes, quick=quick), BOUND, counts=quick
            )


def _beside(made: Callable[[int], tuple[str, int]], form: str, sizes: tuple[int, ...], *, quick: bool) -> Measured:
    """Compare what each further finding costs with what each before did; the worse of work and memory counts."""
    with TemporaryDirectory() as folder:
        rounds = 0 if quick else ROUNDS
        costs = [
            _cost(Path(folder), made(size), form, min(rounds, 1) if size == sizes[-1] else rounds) for size in sizes
        ]
    (other, other_space), (ours, space) = (_each(few, many) for few, many in pairwise(costs))
    memory = f"{space * 1e3:.1f} kB / {other_space * 1e3:.1f} kB"
    note = f"{'calls' if quick else 'time'} {ours / other:.2f}; memory {space / other_space:.2f}, {memory}"
    first, second = (f"{one:,.0f} calls" if quick else f"{one * 1e6:,.0f} us" for one in (ours, other))
    return Measured(first, second, max(ours / other, space / other_space), note)


def _each(few: Cost, many: Cost) -> tuple[float, float]:
    """Work and MB for each further finding."""
    more = many.findings - few.findings
    return (many.work - few.work) / more, (many.megabytes - few.megabytes) / more


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
    "around one topic": (hub, ("json", "sarif", "text", "html")),
    "in islands": (islands, ("json",)),
}


def _cost(folder: Path, system: tuple[str, int], form: str, rounds: int) -> Cost:
    """Return what an answer costs, the median of some rounds; without any its calls in place of seconds.

    Raises
    ------
    SystemExit
        If the command ends otherwise than it has to: then there is nothing to compare.
    """
    text, findings = system
    (folder / "p.xml").write_text(text, "utf-8")
    (folder / "l.yaml").write_text(LABELS, "utf-8")
    name = COMMANDS[form]
    command = [sys.executable, "-m", "rosprivacy", name, "p.xml", "-l", "l.yaml", "-f", form, "-o", f"answer.{form}"]
    costs = []
    for _ in range(max(rounds, 1)):
        with Popen(command, cwd=folder, stdout=DEVNULL) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != EXITS[name]:
            sys.exit(f"{' '.join(command)} ended with {process.returncode}")
        costs.append((used.ru_utime + used.ru_stime, used.ru_maxrss / 1024))
    seconds, megabytes = map(median, zip(*costs, strict=True))
    if rounds:
        return Cost(findings, seconds, megabytes)
    with chdir(folder):
        return Cost(findings, calls_of(*command[3:]), megabytes)
