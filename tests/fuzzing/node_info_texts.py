"""Choices -> what ``ros2 node info`` prints: good and odd names, whole, cut, mixed with other lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.fuzzing.words import ODD_TEXT
from tests.helpers.observed import EMPTY

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

NODES = ("/n0", "/n1", "/a/n2", "/launch_ros_17", "/transform_listener_impl_55aa01", "/_ros2cli_9", "/x y", "//n", "/*")
NAMES = (
    "/c0",
    "/c1",
    "/c0/_action/status",
    "/c0/_action/send_goal",
    "/launch_ros_17/get_parameters",
    "/c[0]",
    "c",
    "/",
)
TYPES = ("std_msgs/msg/String", "t/action/T_SendGoal", "t/srv/S", "a/msg/A, b/msg/B", "", "<b>", "a::b")
LINES = (
    "WARNING: nodes that share an exact name", "Unable to find node /n9", "[INFO] [1.0] [rcl]: x", "", "  Nobody:", "x",
    "  Publishers:", 'There are 2 nodes in the graph with the exact name "/n0"', "    /c0: t/msg/T", "     /c0: x",
)  # fmt: skip


def node_info(choices: Choices) -> dict[str, str | bytes]:
    """A text of one to three nodes."""
    lines: list[str] = []
    for _ in range(1 + choices.below(3)):
        lines.append(_odd(choices, NODES, "/"))
        for title in EMPTY[: None if choices.below(4) else choices.below(6)]:
            lines.append(f"  {title}:")
            entries = choices.below(3)
            lines += [f"    {_odd(choices, NAMES, '/')}: {_odd(choices, TYPES, '')}" for _ in range(entries)] or [""]
    if choices.once_in(3):
        lines.insert(choices.below(min(len(lines), 256)), choices.pick(LINES))
    end = "\r\n" if choices.once_in(5) else "\n"
    return {"graph.txt": end.join(lines).encode("utf-8", "backslashreplace")}


def _odd(choices: Choices, good: tuple[str, ...], before: str) -> str:
    return before + choices.pick(ODD_TEXT) if choices.once_in(12) else choices.pick(good)
