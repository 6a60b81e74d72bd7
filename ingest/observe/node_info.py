"""The text of ``ros2 node info``, from files or standard input -> an observation.

In: what ``ros2 node list -a``, and ``ros2 node info`` for each node, print on both their outputs, of any distribution
and middleware. Out: ``Observation``. It has no enclaves and no times: when it was taken is said by who knows.

Source: ros2cli 0.36.1, ``ros2node/verb/info.py``: a node's full name alone on a line, sections with two spaces before
them, entries with four, an empty line for an empty section.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, ObservationError, shown
from rosprivacy.analysis.model import WITHOUT_WARNINGS
from rosprivacy.ingest.observe.observation import Observation, ObservedEndpoint, ObservedNode, Span
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
_ALIKE = re.compile(r'There are ([0-9]{1,9}) nodes in the graph with the exact name *"?([^"\s]{0,300})')
_SILENT = re.compile(r"Unable to find node '?([^'\s]{0,300})")
_OF_A_TOOL = re.compile(r"(?:WARNING|\[(?:WARN|INFO|ERROR)\]|[0-9.]+ \[)")
OWN = "/_ros2cli"  # nodes of the program that looks


def read_node_info(text: str, at: str, name: str = "text", *, whole: bool = True) -> Observation:
    r"""Read the text.

    Parameters
    ----------
    at
        When it was taken.
    name
        Of the file, for messages.
    whole
        Whether it is all that was printed about a system; else it is one answer of several.

    Raises
    ------
    InputErrors
        With the first lines that are something else; with one, if no line is of a node.

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
        raise InputErrors(reader.problems[: MOST_PROBLEMS if reader.nodes else 1])
    reader.ended(whole=whole)
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
    begun: bool = False  # whether a section of the node has come since its name
    names: Counter[str] = field(default_factory=Counter)  # node -> how often its name stands there
    blocks: Counter[str] = field(default_factory=Counter)  # node -> how often with sections behind it
    alike: dict[str, int] = field(default_factory=dict)  # node -> how many the tool says there are
    sections: dict[str, set[str]] = field(default_factory=dict)
    silent: dict[str, str] = field(default_factory=dict)  # node -> what is to be said of it
    warned: bool = False  # whether anything is there of standard error
    shared: bool = False
    nodes: list[ObservedNode] = field(default_factory=list)
    endpoints: list[ObservedEndpoint] = field(default_factory=list)
    gaps: dict[str, int] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)

    def line(self, number: int, line: str) -> None:
        """One line; what is none of the format's is a problem."""
        if line.startswith("/"):
            self.node, self.role, self.begun = line, "", False
            self.names[line] += 1
            self.nodes.append(ObservedNode(line, self.seen))
        elif line.startswith(" "):
            self._of_node(number, line)
        elif line:
            self._of_tool(number, line)

    def _of_node(self, number: int, line: str) -> None:
        section, (name, colon, types) = _SECTION.fullmatch(line), line.partition(":")
        if section and section[1] in SECTIONS and self.node:
            self.role = SECTIONS[section[1]]
            self.blocks[self.node] += not self.begun
            self.begun = True
            self.sections.setdefault(self.node, set()).add(self.role)
        elif colon and self.role and name.startswith("    ") and not name.startswith("     "):
            self.endpoints.extend(self._endpoints(name[4:], types))
        else:
            self._problem(number, line)

    def _of_tool(self, number: int, line: str) -> None:
        """What the tool writes to standard error."""
        self.warned = True
        if match := _ALIKE.match(line):
            self.alike[match[2]] = int(match[1])
        elif match := _SILENT.match(line):
            self.silent[match[1]] = line
        elif "share an exact name" in line:
            self.shared = True
        elif not _OF_A_TOOL.match(line):
            self._problem(number, line)

    def ended(self, *, whole: bool) -> None:
        """What is missing: nodes behind one name, nodes that did not answer, what the tool said beside its answers."""
        for node, heads in self.names.items():
            blocks = self.blocks[node]
            self.alike[node] = max(self.alike.get(node, 1), blocks, heads - blocks)
            if not blocks:
                self.silent.setdefault(node, f"{node}: only its name is there, so what it does is not known")
            elif len(self.sections[node]) < len(SECTIONS):
                self.silent[node] = f"{node}: not all of its sections are there, so not all that it does is known"
        for node, several in self.alike.items():
            self._gap(SAME_NAME, several - 1, f"{several} nodes are named {node}: what only one of them does is known")
        if self.shared:
            self.gaps.setdefault(SAME_NAME, 1)
        for node, remark in self.silent.items():
            self._gap(UNANSWERED, int(not node.startswith(OWN)), remark)
        self.nodes = [one for one in self.nodes if self.blocks[one.name] or not one.name.startswith(OWN)]
        names = (*self.names, *(one.name for one in self.endpoints))
        if whole and not self.warned and not any("/_" in name for name in names):
            self.gaps[WITHOUT_WARNINGS] = 1

    def _endpoints(self, name: str, types: str) -> Iterator[ObservedEndpoint]:
        """One for each type; two types of one channel are two facts."""
        for kind in [part.strip() for part in types.split(",")]:
            yield ObservedEndpoint(self.node, self.role, name, self.seen, kind)

    def _gap(self, gap: str, number: int, remark: str) -> None:
        if number > 0:
            self.gaps[gap] = self.gaps.get(gap, 0) + number
            self.remarks.append(shown(remark))

    def _problem(self, number: int, line: str) -> None:
        what = f"not the output of `ros2 node info`: {shown(repr(line))}"
        self.problems.append(ObservationError(self.file, number, what, HINT))
