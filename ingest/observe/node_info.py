"""The text of ``ros2 node info``, from files or standard input -> an observation.

In: what ``for n in $(ros2 node list); do ros2 node info $n; done`` prints, of any distribution and middleware. Out:
``Observation``. It has no enclaves and no times: when it was taken is said by who knows.

Source: ros2cli 0.36.1, ``ros2node/verb/info.py``: a node's full name alone on a line, sections with two spaces before
them, entries with four, an empty line for an empty section.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, ObservationError, shown
from rosprivacy.ingest.observe.observation import (
    Observation,
    ObservedEndpoint,
    ObservedNode,
    Span,
)
from rosprivacy.ingest.policies.observed_metadata import SAME_NAME, UNANSWERED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.errors import InputError

DOOR = "text"
SECTIONS = {
    "Subscribers": "subscribe",
    "Publishers": "publish",
    "Service Servers": "reply",
    "Service Clients": "request",
    "Action Servers": "execute",
    "Action Clients": "call",
}
MOST_PROBLEMS = 20
HINT = "give the output of `ros2 node info`, one node after the other"
_SECTION = re.compile(r"  ([A-Z][A-Za-z ]+):\s*")
_ALIKE = re.compile(r"There are ([0-9]{1,9}) nodes in the graph with the exact name")
_OF_A_TOOL = re.compile(r"(?:WARNING|\[(?:WARN|INFO|ERROR)\]|[0-9.]+ \[)")


def read_node_info(text: str, at: str, name: str = "text") -> Observation:
    r"""Read the text.

    Parameters
    ----------
    at
        When it was taken.
    name
        Of the file, for messages.

    Raises
    ------
    InputErrors
        With the first lines that are something else.

    Examples
    --------
    >>> seen = read_node_info("/cam\n  Publishers:\n    /image: sensor_msgs/msg/Image\n", "2026-11-22T10:00:00Z")
    >>> [(one.node, one.role, one.name, one.type) for one in seen.endpoints]
    [('/cam', 'publish', '/image', 'sensor_msgs/msg/Image')]
    """
    reader = _Reader(name, Span(at, at))
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), 1):
        reader.line(number, line.rstrip())
    if reader.problems:
        raise InputErrors(reader.problems[:MOST_PROBLEMS])
    reader.untold()
    return Observation(
        (DOOR,), reader.seen, tuple(reader.nodes), tuple(reader.endpoints), (), reader.gaps, tuple(reader.remarks)
    )


@dataclass(slots=True)
class _Reader:
    """Goes through the lines once."""

    file: str
    seen: Span
    node: str = ""
    role: str = ""
    told: dict[str, set[str]] = field(default_factory=dict)  # node -> its sections
    nodes: list[ObservedNode] = field(default_factory=list)
    endpoints: list[ObservedEndpoint] = field(default_factory=list)
    gaps: dict[str, int] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)

    def line(self, number: int, line: str) -> None:
        """One line; what is none of the format's is a problem."""
        if line.startswith("/"):
            self.node, self.role = line, ""
            self.told.setdefault(line, set())
            self.nodes.append(ObservedNode(line, self.seen))
        elif match := _ALIKE.match(line):
            self._gap(SAME_NAME, int(match[1]) - 1, f"{line[:200]}: what the others do is not known")
        elif "share an exact name" in line:
            self.gaps.setdefault(SAME_NAME, 1)
        elif line.startswith("Unable to find node"):
            self._gap(UNANSWERED, 1, line)
        elif line and not _OF_A_TOOL.match(line):
            self._of_node(number, line)

    def untold(self) -> None:
        """A node without all sections: the text was cut, or is that of `ros2 node list`."""
        for node, sections in self.told.items():
            if len(sections) < len(SECTIONS):
                self._gap(UNANSWERED, 1, f"{node}: not all of its sections are there, so not all that it does is known")

    def _of_node(self, number: int, line: str) -> None:
        section, (name, colon, types) = _SECTION.fullmatch(line), line.partition(":")
        if section and section[1] in SECTIONS and self.node:
            self.role = SECTIONS[section[1]]
            self.told[self.node].add(self.role)
        elif colon and self.role and name.startswith("    ") and not name.startswith("     "):
            self.endpoints.extend(self._endpoints(name[4:], types))
        else:
            what = f"not the output of `ros2 node info`: {shown(repr(line))}"
            self.problems.append(ObservationError(self.file, number, what, HINT))

    def _endpoints(self, name: str, types: str) -> Iterator[ObservedEndpoint]:
        """One for each type; two types of one channel are two facts."""
        for kind in [part.strip() for part in types.split(",")]:
            yield ObservedEndpoint(self.node, self.role, name, self.seen, kind)

    def _gap(self, gap: str, number: int, remark: str) -> None:
        self.gaps[gap] = self.gaps.get(gap, 0) + number
        self.remarks.append(shown(remark))
