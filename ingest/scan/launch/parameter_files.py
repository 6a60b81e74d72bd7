"""A file of ROS parameters -> what it sets, for nodes of which names.

In: text. Out: entries (pattern of a node's full name, parameter, value as text), in order: the last that fits wins.

Source: ``rcl_yaml_param_parser`` and rclcpp's ``parameter_map.cpp``: a name without ``/`` is below the root, ``*`` is
one part of a name, ``**`` any number of them.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.reading import yaml_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.reading.yaml_values import Value

PARAMETERS = "ros__parameters"


class ParameterEntry(NamedTuple):
    """One parameter that a file sets.

    Attributes
    ----------
    node
        The full name of a node, or a pattern of names.
    """

    node: str
    name: str
    value: str


def read_parameters(text: str, file: str) -> tuple[ParameterEntry, ...]:
    """Read the text of a file.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    return tuple(_of_nodes(yaml_values.parse(text, partial(InputError, file)), ""))


def _of_nodes(value: Value, above: str) -> Iterator[ParameterEntry]:
    waiting = [(above, value)]
    while waiting:
        space, inner = waiting.pop(0)
        for key, _, child in inner.entries:
            if key == PARAMETERS:
                yield from (ParameterEntry(space or "/**", name, text) for name, text in flat(child))
            elif child.kind == "map":
                waiting.append((f"{space}/{key.strip('/')}", child))


def flat(value: Value) -> Iterator[tuple[str, str]]:
    """Yield (name, text) of the parameters in a map; those of inner maps with dots."""
    waiting = [("", value)]
    while waiting:
        before, inner = waiting.pop(0)
        for key, _, child in inner.entries:
            if child.kind == "map":
                waiting.append((f"{before}{key}.", child))
            elif child.kind == "list":
                yield before + key, "[" + ", ".join(item.text for item in child.items) + "]"
            else:
                yield before + key, child.text


def fits(pattern: str, node: str) -> bool:
    """Return whether a pattern of a file of parameters is about a node.

    >>> fits("/**", "/a/b"), fits("/*/b", "/a/b"), fits("/b", "/a/b"), fits("/a/**", "/a/b")
    (True, True, False, True)
    """
    parts = node.strip("/").split("/")
    reached = {0}  # how many parts of the name the pattern so far can be about
    for piece in pattern.strip("/").split("/"):
        if piece == "**":
            reached = set(range(min(reached), len(parts) + 1))
        else:
            reached = {at + 1 for at in reached if at < len(parts) and piece in ("*", parts[at])}
        if not reached:
            return False
    return len(parts) in reached
