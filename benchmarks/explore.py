"""The explorer: what one picture costs after an edit, layout included, against the whole command that it stands for.

Each picture is of another open element and of an analysis that was not seen before, as after an answer, so nothing of
the last picture serves the next; the start of Graphviz is shared out among them.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from itertools import cycle, islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Measured, Row, compared, corpus, run, side_by_side
from pictures import write_system

import rosprivacy
from rosprivacy.report.explorer.pictures import Pictures

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.answer import Analysis

POLICY = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
LABELS = "labels: 1\nnodes: {/turtlebot3_laserscan: {source: [HomeMap]}, /bt_navigator: {leak: [HomeMap]}}\n"
PICTURES = 40
FIFTH = 0.2  # of the command: what a round trip may take with all else


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: what matters, and the whole system, for TurtleBot3 and for a car."""
    rounds = 3 if quick else 9
    with TemporaryDirectory() as name:
        labels = Path(name) / "turtlebot.labels.yaml"
        labels.write_text(LABELS, "utf-8")
        systems = {"TurtleBot3": (str(corpus() / POLICY), str(labels)), "1,900 elements": write_system(Path(name))}
        for system, files in systems.items():
            yield Row(f"a picture of what matters, {system}", "rosprivacy analyze", partial(_one, rounds, files), FIFTH)
            if not quick:
                whole = partial(_one, rounds, files, everything=True)
                yield Row(f"a picture of all, {system}", "rosprivacy analyze", whole, FIFTH, goal=True)


def _one(rounds: int, files: tuple[str, str], *, everything: bool = False) -> Measured:
    policy, labels = files
    analysis = rosprivacy.analyze(policy, labels).analysis
    command = (sys.executable, "-m", "rosprivacy", "analyze", policy, "--labels", labels, "--fail-on", "never")
    ours, whole = side_by_side(rounds, partial(_draw, analysis, everything=everything), partial(run, *command))
    note = f"of {len(analysis.open)} open elements {PICTURES} in turn, with the start of Graphviz"
    return compared([[seconds / PICTURES for seconds in ours], whole], note)


def _draw(analysis: Analysis, *, everything: bool) -> None:
    with Pictures() as pictures:
        for question in islice(cycle(analysis.open), PICTURES):
            fresh = replace(analysis, lacking=analysis.lacking)
            pictures.of(fresh, question.element.identity, everything=everything)
