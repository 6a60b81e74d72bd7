"""What differs between two looks of a door: one line for each thing that came or left.

In: what was there before, and what is there now. Out: lines, sorted, fit to be shown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.observe.observation import Observation, ObservedEndpoint

DOES = {
    "publish": "publishes",
    "subscribe": "subscribes to",
    "reply": "serves",
    "request": "calls",
    "execute": "executes",
    "call": "calls",
}


def changed(before: Observation | None, now: Observation) -> Iterator[str]:
    r"""Return what came (``+``) and what left (``-``); all of it if nothing was there before.

    >>> from rosprivacy.ingest.observe.node_info import read_node_info
    >>> look = read_node_info("/cam\n  Publishers:\n    /image: sensor_msgs/msg/Image\n", "2026-11-22T10:00:00Z")
    >>> list(changed(None, look))
    ['+ node /cam', '+ /cam publishes /image (sensor_msgs/msg/Image)']
    """
    for mark, here, there in (("+", now, before), ("-", before, now)):
        known = {node.name for node in there.nodes} if there else set()
        names = {node.name for node in here.nodes} if here else set()
        yield from (f"{mark} node {shown(name)}" for name in sorted(names - known))
        lines = {_line(one) for one in here.endpoints} if here else set()
        yield from (
            f"{mark} {line}" for line in sorted(lines - ({_line(o) for o in there.endpoints} if there else set()))
        )


def _line(one: ObservedEndpoint) -> str:
    who = one.node or f"participant {one.participant}"
    return shown(f"{who} {DOES[one.role]} {one.name}") + (f" ({shown(one.type)})" if one.type else "")
