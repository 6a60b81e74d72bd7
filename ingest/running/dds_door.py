"""A DDS domain, looked at from the inside: read-only, as one participant more that is no ROS node.

In: the domain. Out: observations, as things change.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from rosprivacy.analysis.errors import ObservationError
from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.ingest.running.dds_graph import DOOR, DdsGraph, observation
from rosprivacy.ingest.running.doors import Pace, polled
from rosprivacy.ingest.running.observation import moment

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.ingest.running.doors import Wait
    from rosprivacy.ingest.running.observation import Observation

PATIENCE = 5
"""Seconds in which an endpoint may wait for its node."""
PACE = Pace(told_after=(0.25, PATIENCE + 1), settled=3)
"""Told when all is quiet, and when no endpoint waits any more."""
MISSING = (
    "install the extra [dds] from where rosprivacy came from; there is no wheel for Linux on ARM and none for Python "
    "3.14: look from another computer in the network, or give the output of `ros2 node info` (--text)"
)


@dataclass(frozen=True, slots=True)
class DdsDoor:
    """A domain to look at.

    Attributes
    ----------
    domain
        The ROS domain id.
    peers
        Hosts to ask by unicast, beside multicast.
    interface
        Of the network; empty: as Cyclone chooses. ``lo`` looks at this computer only.
    """

    clock: Callable[[], str]
    domain: int
    peers: tuple[str, ...] = ()
    interface: str = ""
    wait: Wait = time.sleep

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
            from rosprivacy.ingest.running.dds_participant import joined
        except ImportError as error:
            raise ObservationError(f"--{DOOR}", 0, f"the package cyclonedds is not there ({error})", MISSING) from error
        with joined(self.domain, configuration(self.domain, self.peers, self.interface)) as readers:
            since, graph = self.clock(), DdsGraph()

            def observation_of(at_the_end: bool) -> Observation:  # noqa: FBT001 - as ``polled`` calls it
                now = self.clock()
                patience = "" if at_the_end else moment(from_iso(now) - timedelta(seconds=PATIENCE))
                return observation(graph, since, now, self.domain, patience)

            yield from polled(lambda: readers.take(graph, self.clock()), observation_of, PACE, seconds, self.wait)


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
