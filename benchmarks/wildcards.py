"""How the flow graph of a policy grows with its wildcards: twice the names, at most 3 times the time, in one run.

Shapes of names, as many written as read, 10,000 of each (4,000 in the quick form) beside half of them: the flow graph,
and where each meets each the size of what is kept of it, and the whole analysis.
"""

from __future__ import annotations

import pickle
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Measured, Row, timed_or_counted

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.api import analyze
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.analysis.model import Policy

BOUND = 3.0  # a step for each pair would take 4
BOUNDS = Bounds(comparisons=10**9, flows=10**7)
OVERLAP = "/robot*/s7* on both sides: each meets each"
LABELS = "labels: 1\nnodes:\n  /writer: {source: [Video]}\n  /reader: {leak: [Video]}\n"
SHAPES: dict[str, tuple[Callable[[int], str], Callable[[int], str]]] = {
    "/ns7/part/* on both sides": (lambda i: f"/ns{i}/part/*", lambda i: f"/ns{i}/part/*"),
    "/robot*/part7/image on both sides": (lambda i: f"/robot*/part{i}/image", lambda i: f"/robot*/part{i}/image"),
    "*/part7/image on both sides": (lambda i: f"*/part{i}/image", lambda i: f"*/part{i}/image"),
    OVERLAP: (lambda i: f"/robot*/s{i}*", lambda i: f"/robot*/s{i}*"),
    "/robot7/*, read as */image7: each meets each": (lambda i: f"/robot{i}/*", lambda i: f"*/image{i}"),
    "plain names, read as /robot*/part7/*": (lambda i: f"/robot/part{i}/image", lambda i: f"/robot*/part{i}/*"),
    "plain names, read as /robot*/image7": (lambda i: f"/robot/part/image{i}", lambda i: f"/robot*/image{i}"),
}


def policy(names: int, shape: str, folder: Path) -> Policy:
    """Return a policy of two nodes: one writes so many names of a shape, one reads as many."""
    written, read = SHAPES[shape]
    profiles = [
        f'<profile ns="/" node="{node}"><topics {role}="ALLOW">'
        + "".join(f"<topic>{name(number)}</topic>" for number in range(names))
        + "</topics></profile>"
        for node, role, name in (("writer", "publish", written), ("reader", "subscribe", read))
    ]
    file = folder / "policy.xml"
    opening = '<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>'
    file.write_text(f"{opening}{''.join(profiles)}</profiles></enclave></enclaves></policy>", "utf-8")
    return read_policy(str(file))


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    most = 4_000 if quick else 10_000
    for shape in SHAPES:
        ours = f"{most:,} names: {shape}"
        yield Row(ours, "half of them", partial(twice, most, shape, quick=quick), BOUND, counts=quick)
    yield Row(f"{most:,} names: {OVERLAP}: size", "half of them", partial(size_of_twice, most), BOUND, counts=True)
    analysis = partial(analysis_of_twice, most, quick=quick)
    yield Row(f"{most:,} names: {OVERLAP}: analysis", "half of them", analysis, BOUND, counts=quick)


def twice(most: int, shape: str, *, quick: bool) -> Measured:
    """Compare the graph of so many names with that of half of them."""
    with TemporaryDirectory() as folder:
        large, small = (policy(names, shape, Path(folder)) for names in (most, most // 2))
    graphs = (lambda: build([large], bounds=BOUNDS)), (lambda: build([small], bounds=BOUNDS))
    return timed_or_counted(3, *graphs, quick=quick)


def size_of_twice(most: int) -> Measured:
    """Compare what is kept of the graph of so many names, each of which meets each, with that of half of them."""
    with TemporaryDirectory() as folder:
        policies = [policy(names, OVERLAP, Path(folder)) for names in (most, most // 2)]
    large, small = (len(pickle.dumps(build([one], bounds=BOUNDS))) for one in policies)
    return Measured(f"{large / 1e6:.1f} MB", f"{small / 1e6:.1f} MB", large / small)


def analysis_of_twice(most: int, *, quick: bool) -> Measured:
    """Compare files to findings, with the number of paths, of names of which each meets each, against half of them."""
    with TemporaryDirectory() as large, TemporaryDirectory() as small:
        for names, folder in ((most, Path(large)), (most // 2, Path(small))):
            policy(names, OVERLAP, folder)
            (folder / "labels.yaml").write_text(LABELS, "utf-8")
        analyses = (
            partial(analyze, Path(folder, "policy.xml"), Path(folder, "labels.yaml")) for folder in (large, small)
        )
        return timed_or_counted(3, *analyses, quick=quick)
