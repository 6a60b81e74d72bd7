"""The explorer's round trip: an edit, the verdict, what is left to decide, and the picture, against a whole analysis.

One session stays open, as in a browser; each round another element is labelled, so nothing of the last answer serves
the next. The other side is the command in a fresh process, under the labels with which the session began. For the large
systems a fifth is the goal, not reached yet: an edit counts no paths, but searches from each source anew, which is most
of what it takes where every kind gets everywhere.
"""

from __future__ import annotations

import sys
from functools import partial
from itertools import count
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Row, compared, corpus, run, side_by_side

from rosprivacy.explorer.session import Session
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.explorer.pictures import Pictures

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Measured

POLICY = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
TURTLEBOT = """labels: 1
nodes:
  /turtlebot3_laserscan: {source: [HomeMap]}
  /turtlebot3_diff_drive: {source: [Location]}
  /bt_navigator: {leak: [HomeMap]}
  /rviz2: {leak: [Location]}
"""
FIFTH = 0.2  # of a whole analysis (issue 22)
NODES, GROUP, KINDS, EDITS = 800, 40, 24, 5


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: TurtleBot3, and 2,000 elements with 24 kinds of data, gateways between and without."""
    rounds = 3 if quick else 9
    with TemporaryDirectory() as name:
        for what, (policy, labels), goal in (
            ("TurtleBot3", turtlebot(Path(name)), False),
            (f"2,000 elements, {KINDS} kinds", large(Path(name), apart=True), True),
            ("the same, every kind everywhere", large(Path(name), apart=False), True),
        ):
            measure = partial(_measured, policy, labels, rounds)
            yield Row(f"an edit, its effect, the picture, {what}", "the command analyze", measure, FIFTH, goal)


def turtlebot(folder: Path) -> tuple[str, str]:
    """Write labels of TurtleBot3; return the names of its policy and of them."""
    (folder / "tb3.yaml").write_text(TURTLEBOT, "utf-8")
    return str(corpus() / POLICY), str(folder / "tb3.yaml")


def large(folder: Path, *, apart: bool) -> tuple[str, str]:
    """Write a policy of 2,000 elements with 5,000 flows, and labels of 24 kinds.

    Parameters
    ----------
    apart
        Whether a gateway after every 40 nodes lets nothing out: a kind then gets to a twentieth of the system, else
        from one end to the other.
    """
    random = Random(1)  # noqa: S311 - repeatable
    profiles = []
    for node in range(NODES):
        first = node // GROUP * GROUP if apart else max(0, node - 9)
        last = first + GROUP - 1 if apart else node + 9
        writes = "".join(f"<topic>/t{random.randint(first, last)}</topic>" for _ in range(3))
        reads = "".join(f"<topic>/t{random.randint(first, last)}</topic>" for _ in range(3))
        more = f"<topic>/only{node}</topic>" if node % 2 else ""
        if apart and node % GROUP == GROUP - 1:
            more += f"<topic>/t{node + 1}</topic>"  # into the next group
        topics = f'<topics publish="ALLOW">{writes}{more}</topics><topics subscribe="ALLOW">{reads}</topics>'
        profile = f'<profiles><profile ns="/" node="n{node}">{topics}</profile></profiles>'
        profiles.append(f'<enclave path="/e{node}">{profile}</enclave>')
    name = "apart" if apart else "joined"
    policy, labels = folder / f"{name}.xml", folder / f"{name}.yaml"
    policy.write_text(f'<policy version="0.2.0"><enclaves>{"".join(profiles)}</enclaves></policy>', "utf-8")
    kinds = sorted(load().categories)[:KINDS]
    says: dict[int, list[str]] = {}
    for place, kind in enumerate(kinds):
        at = place * (NODES // KINDS)
        says.setdefault(at, []).append(f"source: [{kind}]")
        says.setdefault(at + 3, []).append(f"leak: [{kind}]")
    if apart:
        says |= {node: ["sanitizer: {PersonalData: drop}"] for node in range(GROUP - 1, NODES, GROUP)}
    lines = [f"  /n{node}: {{{', '.join(some)}}}\n" for node, some in sorted(says.items())]
    labels.write_text("labels: 1\nnodes:\n" + "".join(lines), "utf-8")
    return str(policy), str(labels)


def _measured(policy: str, labels: str, rounds: int) -> Measured:
    session = Session.open([policy], [labels])
    elements = len(session.uncounted.analysis.graph.elements)
    number = count()
    with Pictures() as pictures:

        def edits() -> None:
            for _ in range(EDITS):
                # of what the labels say nothing: sources and leaks stay, and so do findings
                asked = [one for one in session.questions() if (one.section, one.name) not in session.entries]
                one = asked[next(number) % len(asked)]
                if one.section == "nodes":
                    session.label(one.name, conduit=True)
                else:
                    session.label(one.name, kind=one.section, sensitive=True)
                pictures.of(session.uncounted.analysis, session.questions()[0].element.identity)

        command = [sys.executable, "-m", "rosprivacy", "analyze", policy, "-l", labels, "--fail-on", "never"]
        ours, other = side_by_side(rounds, edits, partial(run, *command))
    found = len(session.uncounted.analysis.findings)
    note = f"{elements:,} elements, {found} findings; {len(session.edits)} edits in one session; {_memory():.0f} MB"
    return compared(([one / EDITS for one in ours], other), note)


def _memory() -> float:
    """What the process holds now, in MB."""
    pages = int(Path("/proc/self/statm").read_text("ascii").split()[1])
    return pages * 4096 / 2**20
