"""How an answer grows with its findings: each of ten times as many takes at most 1.5 times as much time and memory.

1,000, 10,000 and 100,000 findings (the last in the full form only), by the command itself, in a fresh process. Two
shapes: all sources and leaks around one topic, and islands of 25 findings each. From processor time and peak memory
those of a tiny policy in the same format are taken away, which are the start of the program.
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

from measure import Measured, Row
from worst_case import node, policy, topics

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

BOUND = 1.5
SIZES = (1_000, 10_000, 100_000)
ROUNDS = 3  # of the smaller sizes; of the largest, which takes a minute, one
SIDE = 5  # sources of an island, and leaks
LABELS = "labels: 1\nnodes:\n  /s*: {source: [Video]}\n  /l*: {leak: [Video]}\n"
COMMANDS = {"text": "analyze", "json": "analyze", "sarif": "analyze", "html": "report"}
EXITS = {"analyze": 1, "report": 0}


@dataclass(frozen=True, slots=True)
class Cost:
    """Seconds and MB: of a run, or for each finding."""

    seconds: float
    megabytes: float


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    sizes = SIZES[:2] if quick else SIZES
    for shape, (made, formats) in SHAPES.items():
        for form in formats[: 2 if quick else None]:
            for few, many in pairwise(sizes):
                ours = f"each of {many:,} findings {shape}, {form}"
                measure = partial(_beside, made, form, many, few, quick=quick)
                yield Row(ours, f"of {few:,}", measure, bound=BOUND)


def _beside(made: Callable[[int], tuple[str, int]], form: str, many: int, few: int, *, quick: bool) -> Measured:
    """Compare what each of many findings costs with what each of few does; the worse of time and memory counts."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        start = _cost(folder, hub(1)[0], form, ROUNDS)
        each = []
        for size in (many, few):
            text, number = made(size)
            whole = _cost(folder, text, form, 1 if size == SIZES[-1] or (quick and size == many) else ROUNDS)
            each.append(Cost((whole.seconds - start.seconds) / number, (whole.megabytes - start.megabytes) / number))
    ours, other = each
    time, space = ours.seconds / other.seconds, ours.megabytes / other.megabytes
    note = f"time {time:.2f}; memory {space:.2f}, {ours.megabytes * 1e3:.1f} kB / {other.megabytes * 1e3:.1f} kB"
    return Measured(f"{ours.seconds * 1e6:,.0f} us", f"{other.seconds * 1e6:,.0f} us", max(time, space), note)


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


def _cost(folder: Path, text: str, form: str, rounds: int) -> Cost:
    """Return what an answer costs, the median of some rounds.

    Raises
    ------
    SystemExit
        If the command ends otherwise than it has to: then there is nothing to compare.
    """
    (folder / "p.xml").write_text(text, "utf-8")
    (folder / "l.yaml").write_text(LABELS, "utf-8")
    name = COMMANDS[form]
    command = [sys.executable, "-m", "rosprivacy", name, "p.xml", "-l", "l.yaml", "-f", form, "-o", f"answer.{form}"]
    costs = []
    for _ in range(rounds):
        with Popen(command, cwd=folder, stdout=DEVNULL) as process:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != EXITS[name]:
            sys.exit(f"{' '.join(command)} ended with {process.returncode}")
        costs.append(Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024))
    return Cost(median(one.seconds for one in costs), median(one.megabytes for one in costs))
