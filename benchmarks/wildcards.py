"""How the flow graph of a policy grows with its wildcards: twice the names, at most 3 times the time, in one run.

Four shapes of names, as many written as read, 10,000 of each (4,000 in the quick form) beside half of them.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Row, timed

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from measure import Measured

    from rosprivacy.analysis.model import Policy

BOUND = 3.0  # a step for each pair would take 4
BOUNDS = Bounds(comparisons=10**9, flows=10**7)
SHAPES: dict[str, tuple[Callable[[int], str], Callable[[int], str]]] = {
    "/ns7/part/* on both sides": (lambda i: f"/ns{i}/part/*", lambda i: f"/ns{i}/part/*"),
    "/robot*/part7/image on both sides": (lambda i: f"/robot*/part{i}/image", lambda i: f"/robot*/part{i}/image"),
    "*/part7/image on both sides": (lambda i: f"*/part{i}/image", lambda i: f"*/part{i}/image"),
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
        yield Row(ours, "half of them", partial(twice, most, shape), bound=BOUND)


def twice(most: int, shape: str) -> Measured:
    """Time the graph of so many names against that of half of them."""
    with TemporaryDirectory() as folder:
        large, small = (policy(names, shape, Path(folder)) for names in (most, most // 2))
    return timed(3, lambda: build([large], bounds=BOUNDS), lambda: build([small], bounds=BOUNDS))
