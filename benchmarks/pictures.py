"""Pictures: a system of the size of Autoware, whole, and every finding of it by itself.

The system is made up: 1,900 elements besides the standard channels, in modules along a pipeline, as in a car that
drives itself.
"""

from __future__ import annotations

import random
import sys
import time
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Measured, Row, run, timed

import rosprivacy
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.report.page.figures import pictures_of
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.graphviz import Graphviz, drawn
from rosprivacy.report.pictures.narrow import folded
from rosprivacy.report.pictures.views import PER_BOX, FindingViews, bounded, ros_view

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.report.pictures.picture import Picture

MODULES = ("sensing", "perception", "localization", "map", "planning", "control", "vehicle", "system", "api", "tools")
NODES, TOPICS, SERVICES, ACTIONS = 300, 1230, 340, 30
WHOLE, ONE = 60.0, 1.0  # seconds that are promised
MOST = 60  # boxes of one finding
PARAMETERS = ("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters", "set_parameters")


def write_system(folder: Path, seed: int = 7) -> tuple[str, str]:
    """Write the policy and the labels; return their names.

    A topic goes to one to three nodes, mostly of the next modules; a logger and a monitor read many.
    """
    chance = random.Random(seed)  # noqa: S311 - to be the same each time
    nodes = [f"/{MODULES[i * len(MODULES) // NODES]}/node_{i}" for i in range(NODES)]
    grants: dict[str, list[tuple[str, str, str]]] = {node: [] for node in nodes}

    def near(place: int) -> int:
        step = int(chance.expovariate(1 / 25)) + 1
        return place + step if place + step < NODES else chance.randrange(NODES)

    for i in range(TOPICS):
        writer = chance.randrange(NODES)
        name = f"{nodes[writer].rpartition('/')[0]}/output/topic_{i}"
        grants[nodes[writer]].append(("topics", "publish", name))
        for reader in {near(writer) for _ in range(chance.randint(1, 3))}:
            grants[nodes[reader]].append(("topics", "subscribe", name))
        if chance.random() < 0.1:
            grants[nodes[-1 - i % 2]].append(("topics", "subscribe", name))
    for kind, count, asks, answers in (
        ("services", SERVICES, "request", "reply"),
        ("actions", ACTIONS, "call", "execute"),
    ):
        for i in range(count):
            server = chance.randrange(NODES)
            grants[nodes[server]].append((kind, answers, f"{nodes[server]}/{kind[:-1]}_{i}"))
            grants[nodes[near(server)]].append((kind, asks, f"{nodes[server]}/{kind[:-1]}_{i}"))
    policy, labels = folder / "car.policy.xml", folder / "car.labels.yaml"
    policy.write_text(_policy(grants), "utf-8")
    labels.write_text(_labels(nodes), "utf-8")
    return str(policy), str(labels)


def _policy(grants: dict[str, list[tuple[str, str, str]]]) -> str:
    profiles = []
    for node, own in grants.items():
        space, _, name = node.rpartition("/")
        rows = [("topics", "publish", "/rosout"), *(("services", "reply", f"~/{p}") for p in PARAMETERS), *own]
        lines = [f'<{kind} {role}="ALLOW"><{kind[:-1]}>{name}</{kind[:-1]}></{kind}>' for kind, role, name in rows]
        profiles.append(f'<profile ns="{space}" node="{name}">\n{chr(10).join(lines)}\n</profile>')
    inside = "\n".join(profiles)
    return (
        '<policy version="0.2.0"><enclaves><enclave path="/car"><profiles>\n'
        f"{inside}\n</profiles></enclave></enclaves></policy>\n"
    )


def _labels(nodes: list[str]) -> str:
    rows = [f"  {node}: {{source: [Video]}}" for node in nodes[:4]]
    rows += [f"  {node}: {{source: [Location]}}" for node in nodes[60:62]]
    rows += [f"  {node}: {{leak: [Video, Location]}}" for node in nodes[-10:]]
    return "\n".join(["labels: 1", "nodes:", *rows, ""])


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: each promise once, the longest of many counts where there are many.

    The quick form measures the layout only.
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        policy, labels = write_system(folder)
        analysis = rosprivacy.analyze([policy], [labels]).analysis
        whole = ros_view(analysis)
        size = f"{len(whole.boxes):,} elements, {len(whole.lines):,} lines, {len(analysis.findings)} findings"
        command = [sys.executable, "-m", "rosprivacy", "graph", "--all", policy, "--labels", labels]
        bare = _bare(whole, folder)
        drawing: list[str | Path] = [*command, "--show", "ros", "--output", folder / "ros.svg"]
        rounds = 1 if quick else 5
        what, against = "rosprivacy graph --show ros, SVG", "Graphviz's bare sfdp of the same"
        yield Row(
            what, against, lambda: timed(rounds, partial(run, *drawing), partial(run, *bare), note=size), bound=10
        )
        if quick:
            return
        for show in ("ros", "privacy"):
            for options in ((), ("--fold", "--cluster", "namespace")):
                asked = [*command, "--show", show, *options, "--output", folder / f"{show}.svg"]
                what = f"rosprivacy graph --show {' '.join((show, *options))}, SVG"
                yield Row(what, f"{WHOLE:g} s", partial(_within, partial(run, *asked), WHOLE, size), bound=1)
        yield Row("the privacy view of one finding, SVG", f"{ONE:g} s", lambda: _each(analysis), bound=1)
        what = "the picture of one finding for a report, on average"
        yield Row(what, f"{ONE:g} s", lambda: _for_a_report(analysis), bound=1)


def _bare(picture: Picture, folder: Path) -> list[str | Path]:
    """Return the command that lays a picture out by sfdp alone, boxes on each other, in a fresh process too."""
    graph = folder / "whole.dot"
    graph.write_text(dot(picture), "utf-8")
    code = (
        "import sys, pygraphviz; pygraphviz.AGraph(sys.argv[1]).draw(sys.argv[2], prog='sfdp', args='-Goverlap=true')"
    )
    return [sys.executable, "-c", code, graph, folder / "bare.svg"]


def _each(analysis: Analysis) -> Measured:
    slowest = max(_seconds(partial(_one, analysis, finding)) for finding in analysis.findings)
    note = f"the slowest of {len(analysis.findings)}, of up to {MOST} elements, with the start of Graphviz"
    return _against(slowest, ONE, note)


def _for_a_report(analysis: Analysis) -> Measured:
    made: list[int] = []
    with Graphviz() as graphviz:
        pictures = pictures_of(graphviz, PathsToLeaks(analysis), analysis.findings)
        took = _seconds(lambda: made.extend(len(one.svg) for one in pictures if one))
    return _against(took / len(made), ONE, f"{max(made) / 1000:.0f} kB the largest; all one after the other")


def _one(analysis: Analysis, finding: Finding) -> None:
    drawn(bounded(folded(FindingViews(PathsToLeaks(analysis)).of(finding, PER_BOX * MOST)), MOST), "svg")


def _seconds(what: Callable[[], object]) -> float:
    begin = time.perf_counter()
    what()
    return time.perf_counter() - begin


def _within(what: Callable[[], object], limit: float, note: str) -> Measured:
    return _against(_seconds(what), limit, note)


def _against(seconds: float, limit: float, note: str) -> Measured:
    return Measured(f"{seconds:.2f} s", f"{limit:g} s", seconds / limit, note)
