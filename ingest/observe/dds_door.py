"""A DDS domain, looked at from the inside: read-only, as one participant more that is no ROS node.

In: the domain. Out: observations, as things change.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from rosprivacy.analysis.errors import ObservationError
from rosprivacy.ingest.observe.dds_graph import (
    DOOR,
    DdsGraph,
    observation,
)
from rosprivacy.ingest.observe.observation import Observation, moment
from rosprivacy.ingest.policies.observed_metadata import STILL_CHANGING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SETTLED = 3.0
"""What came within so many seconds of the end makes the look one that still changed."""
PATIENCE = 5
"""Seconds in which an endpoint may wait for its node."""
WAITS = (0.25, PATIENCE + 1)
"""Seconds after a change when it is told: when all is quiet, and when no endpoint waits any more."""
POLL = 0.05
MISSING = (
    "install the extra [dds] from where rosprivacy came from; there is no wheel for Linux on ARM and none for Python "
    "3.14: look from another computer in the network, or give the output of `ros2 node info` (--text)"
)


@dataclass(frozen=True, slots=True)
class DdsDoor:
    """A domain to look at.

    Attributes
    ----------
    clock
        Tells the time, as observations hold it.
    domain
        The ROS domain id.
    peers
        Hosts to ask by unicast, beside multicast.
    interface
        Of the network; empty: as Cyclone chooses. ``lo`` looks at this computer only.
    wait
        Waits so many seconds.
    """

    clock: Callable[[], str]
    domain: int
    peers: tuple[str, ...] = ()
    interface: str = ""
    wait: Callable[[float], None] = time.sleep

    def looks(self, seconds: float | None) -> Iterator[Observation]:
        """Tell what is there, each time that it has changed and been quiet for a moment.

        Raises
        ------
        MiddlewareError
            If the domain cannot be joined.
        ObservationError
            If the package that joins it is not installed.
        """
        try:
            from rosprivacy.ingest.observe.dds_participant import joined
        except ImportError as error:
            raise ObservationError(f"--{DOOR}", 0, f"the package cyclonedds is not there ({error})", MISSING) from error
        with joined(self.domain, configuration(self.domain, self.peers, self.interface)) as readers:
            since, end = self.clock(), None if seconds is None else time.monotonic() + seconds
            changed, told, graph = time.monotonic(), len(WAITS), DdsGraph()
            while end is None or time.monotonic() < end:
                if readers.take(graph, self.clock()):
                    changed, told = time.monotonic(), 0
                elif told < len(WAITS) and time.monotonic() - changed > WAITS[told]:
                    told += 1
                    now = self.clock()
                    patience = moment(datetime.fromisoformat(now) - timedelta(seconds=PATIENCE))
                    yield observation(graph, since, now, self.domain, patience)
                self.wait(POLL)
            last = observation(graph, since, self.clock(), self.domain)
            late = time.monotonic() - changed < SETTLED
            yield replace(last, gaps={**last.gaps, STILL_CHANGING: 1}) if late and graph.participants else last


def configuration(domain: int, peers: tuple[str, ...], interface: str) -> str:
    """Return Cyclone's configuration: the user's own (``CYCLONEDDS_URI``), and what options add to it."""
    discovery = "".join(f"<Peer address={quoteattr(peer)}/>" for peer in peers)
    network = f"<Interfaces><NetworkInterface name={quoteattr(interface)}/></Interfaces>" if interface else ""
    if interface == "lo":  # it has no multicast flag, and needs none
        network += "<AllowMulticast>false</AllowMulticast>"
        discovery += '<Peer address="127.0.0.1"/>'
    index = "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>99</MaxAutoParticipantIndex>"
    asked = f"<General>{network}</General>" if network else ""
    asked += f"<Discovery>{index}<Peers>{discovery}</Peers></Discovery>" if discovery else ""
    ours = f'<CycloneDDS><Domain Id="{domain}">{asked}</Domain></CycloneDDS>' if asked else ""
    return ",".join(filter(None, (os.environ.get("CYCLONEDDS_URI"), ours)))
