"""A started node whose code is not there -> what the catalogue of packages states of it.

In: what a launch file starts, and the catalogue. Out: the entry, its channels with the parameters that name them, the
nodes that it makes, and what is not known beyond it. Only an entry of that very package and executable can be whole.
"""

from __future__ import annotations

import posixpath
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.packages import NOTHING, Interface
from rosprivacy.ingest.scan.final_names import is_open
from rosprivacy.ingest.scan.recorded_topics import RECORDER, recording
from rosprivacy.ingest.scan.scan_facts import PACKAGE, NamePiece, open_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.analysis.suggesting.packages import Package, PackageNode
    from rosprivacy.ingest.scan.final_names import RunningNode
    from rosprivacy.ingest.scan.scan_facts import Name, StartedNode

BRIDGE = "parameter_bridge"  # of ros_gz_bridge; ros_ign_bridge before
EVERY_TOPIC = "/*"  # as a policy writes it: every name that others write
BOTH_WAYS = ("publishes", "subscribes")


class Catalogued(NamedTuple):
    """What the catalogue states of a started node.

    Attributes
    ----------
    exact
        Whether the entry names this package and this executable; else another package may be called alike.
    """

    package: Package
    node: PackageNode
    exact: bool = False

    @property
    def usual_name(self) -> str:
        """Of the node, where a launch file gives it none."""
        return next((name for name in self.node.names if "*" not in name), "")

    @property
    def inner_nodes(self) -> Iterator[tuple[str, PackageNode]]:
        """Further nodes in its process: (name from its namespace, what is stated of it)."""
        for name in self.node.makes:
            base = name.rpartition("/")[2]
            yield name, next(node for node in self.package.nodes if base in node.names)

    def beyond(self, executable: str) -> str:
        """What is not known of the node, for people; empty if all its channels are stated."""
        named = all("*" not in one.name or one.parameter for one in (*self.node.interfaces, *self.node.further))
        if self.exact and named and self.node.rest == NOTHING:
            return ""
        if self.exact and self.node.rest not in ("", NOTHING):
            return f"of {executable} what the catalogue of packages states is known, but not {self.node.rest}"
        return f"of {executable} only what the catalogue of packages states is known"


def catalogued(started: StartedNode, packages: Sequence[Package]) -> Catalogued | None:
    """Return what the catalogue states of a node; None if it states nothing.

    By its executable, else by its name, of its package or of one that is called alike; else by the executable alone.
    """
    own = [package for package in packages if started.package in (package.name, *package.packages)]
    alike = [package for package in packages if started.package.startswith(package.name)]
    for group in (own, alike):
        for called in filter(None, (started.executable, started.name)):
            for package in group:
                for node in package.nodes:
                    if any(fnmatchcase(called, pattern) for pattern in (*node.names, *node.components)):
                        return Catalogued(package, node, group is own and called == started.executable)
    by_executable = (
        Catalogued(package, node)
        for package in packages
        for node in package.nodes
        if started.executable in node.names and node.interfaces
    )
    return next(by_executable, None)


def channel_names(
    node: PackageNode, running: RunningNode, arguments: Sequence[str]
) -> Iterator[tuple[Interface, Name]]:
    """Yield the channels of a node, with their names as its parameters and its command line make them."""
    options = [*running.parameters.items(), *_options(arguments)]
    for one in (*node.interfaces, *node.further):
        if "*" not in one.name:
            above = posixpath.dirname(running.namespace) if one.name.startswith("../") else ""
            yield one, (NamePiece(posixpath.join(above, one.name.removeprefix("../")), PACKAGE, one.parameter),)
            continue
        for value in _values(one.parameter, options):
            why = f"{one.parameter} is {value} in the launch file"
            yield one, open_name(why) if is_open(value) else (NamePiece(one.name.replace("*", value), PACKAGE),)
    for word in arguments if BRIDGE in node.names else ():
        yield from _bridged(word)
    if RECORDER in node.names:
        yield from _recorded(arguments)


def _options(arguments: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Options of a command line with their values; ``--`` stands for a word that belongs to none."""
    option = "--"
    for word in arguments:
        if word.startswith("-") and not word.lstrip("-")[:1].isdigit():
            option = word
        else:
            yield option, word
            option = "--"


def _values(pattern: str, options: Sequence[tuple[str, str]]) -> Iterator[str]:
    """What parameters of some names are set to; of a list each item."""
    for name, value in options:
        if pattern and fnmatchcase(name, pattern):
            yield from filter(None, (item.strip("'\" ") for item in value.strip("[]").split(",")))


def _recorded(arguments: Sequence[str]) -> Iterator[tuple[Interface, Name]]:
    """The topics that ``ros2 bag record`` is given; where it may be any, their pattern."""
    topics, every = recording(arguments)
    for name in (*topics, *([EVERY_TOPIC] if every else [])):
        why = f"an argument is {name} in the launch file"
        yield Interface("subscribes", name), open_name(why) if is_open(name) else (NamePiece(name, PACKAGE),)


def _bridged(word: str) -> Iterator[tuple[Interface, Name]]:
    """What a word of ``parameter_bridge`` makes: ``/topic@pkg/msg/Type[gz.msgs.Type``, from Gazebo with ``[``.

    Source: README of ros_gz_bridge: ``@`` is both ways, ``]`` from ROS to Gazebo; services are served in ROS.
    """
    name, sign, types = word.partition("@")
    if not sign:
        return
    way = next((one for one in types if one in "[]@"), "@")
    type_ = types.partition(way)[0]
    uses = ("replies",) if "/srv/" in type_ else {"[": ("publishes",), "]": ("subscribes",)}.get(way, BOTH_WAYS)
    for use in uses:
        yield (
            Interface(use, name, type_),
            open_name(f"an argument is {word} in the launch file") if is_open(name) else (NamePiece(name, PACKAGE),),
        )
