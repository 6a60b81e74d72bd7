"""What a launch file sets for one node: its parameters, one after the other, and what it says to ROS in arguments.

In: settings as they are written, words of a command. Out: parameters with the values that remain, remappings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.launch.parameter_files import fits

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.scan.launch.launch_values import Alternatives

ROS_ARGUMENTS = "--ros-args"


class Setting(NamedTuple):
    """What sets one parameter, or a file that sets several.

    Attributes
    ----------
    written, replaced
        Of a file that is rewritten: (parameter, its value), and words in values that something else replaces.
    """

    name: str
    texts: Alternatives
    file: bool = False
    written: tuple[tuple[str, Alternatives], ...] = ()
    replaced: tuple[str, ...] = ()


class NodeParameters:
    """The parameters of a node as they are set, one after the other.

    Parameters
    ----------
    node
        Its full name; empty where the launch file does not say.
    """

    def __init__(self, node: str) -> None:
        self.node = node
        self.values: dict[str, str] = {}
        self.unresolved: dict[str, None] = {}
        self.by_node: dict[tuple[str, str, str], None] = {}

    def add(self, name: str, value: str | None) -> None:
        """Set a parameter; None is a value that the sources do not say."""
        self.values.pop(name, None)
        self.unresolved.pop(name, None)
        if value is None:
            self.unresolved[name] = None
        else:
            self.values[name] = value

    def of_file(self, pattern: str, name: str, value: str | None) -> None:
        """Set what a file sets for nodes of some names."""
        everywhere = pattern in ("/**", "/**/*")
        if everywhere or (self.node and fits(pattern, self.node)):
            self.add(name, value)
        elif value is not None and (not self.node or pattern.count("/") > self.node.count("/")):
            self.by_node[pattern, name, value] = None  # below the node are those that it may make itself


class RosOptions(NamedTuple):
    """What arguments after ``--ros-args`` say, and the other ones."""

    remaps: tuple[tuple[str, str], ...] = ()
    parameters: tuple[tuple[str, str], ...] = ()
    files: tuple[str, ...] = ()
    words: tuple[str, ...] = ()


def ros_options(words: Sequence[Alternatives]) -> RosOptions:
    """Return what the words of a command say to ROS.

    >>> from rosprivacy.ingest.scan.launch.launch_values import Alternative
    >>> ros_options([(Alternative(word),) for word in "-v --ros-args -r a:=b -p x:=1".split()])
    RosOptions(remaps=(('a', 'b'),), parameters=(('x', '1'),), files=(), words=('-v',))
    """
    remaps, parameters, files, rest = [], [], [], []
    before, inside = "", False
    for alternatives in words:
        word = alternatives[0].text
        if word in (ROS_ARGUMENTS, "--"):
            inside = word == ROS_ARGUMENTS
        name, sign, value = word.partition(":=")
        if inside and before in ("-p", "--param") and sign:
            parameters.append((name, value))
        elif inside and before == "--params-file":
            files.append(word)
        elif sign and (not inside or before in ("-r", "--remap")):  # without --ros-args as older versions took it
            remaps.append((name, value))
        elif not inside and word != "--":
            rest += [one.text for one in alternatives]
        before = word
    return RosOptions(tuple(remaps), tuple(parameters), tuple(files), tuple(rest))
