"""Wildcards that take in a channel whatever it is called: there, a filter has nowhere to keep what it has not cleaned.

In: a graph. Out: per kind of channel the wildcards that cover a new name, chosen so that as few as possible do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import CHANNELS
from rosprivacy.ingest.policies.names import covers, dds_names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import FlowGraph

NAMES = tuple(f"/{first}nfiltered_data/{last}" for first in "uUzZ0_" for last in ("raw", "clean_9"))


def open_ended(graph: FlowGraph) -> dict[str, frozenset[int]]:
    """Return, per kind of channel, the vertices of the wildcards that also cover a new one."""
    patterns = [(v, e) for v, e in enumerate(graph.elements) if e.pattern]
    expressions = {v: dds_names(e.kind, e.name, e.leg) for v, e in patterns}
    found = {}
    for kind in CHANNELS:
        covering = [
            frozenset(
                v for v, own in expressions.items() if any(covers(one, dds) for one in own for dds in _dds(kind, name))
            )
            for name in NAMES
        ]
        found[kind] = min(covering, key=lambda vertices: (len(vertices), sorted(vertices)))
    return found


def _dds(kind: str, name: str) -> Iterator[str]:
    for leg in ("",) if kind == "topic" else ("request", "response"):
        yield from dds_names(kind, name, leg)
