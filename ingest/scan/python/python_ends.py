"""How calls of libraries make ends of channels in Python, and which classes of libraries are nodes.

Source: the signatures of rclpy, ``tf2_ros``, ``message_filters``, ``image_transport_py``, ``py_trees_ros`` and
``nav2_simple_commander``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.python_code import ACTIONS, METHODS
from rosprivacy.ingest.code.source_code import INTERFACES, NODE_CLASSES

if TYPE_CHECKING:
    from collections.abc import Mapping

TF, LOOKUP = "tf2_msgs/msg/TFMessage", "tf2_msgs/action/LookupTransform"
WRAPPERS: Mapping[str, str] = {  # classes of other packages that are nodes; what they are called by default
    "BasicNavigator": "basic_navigator",
    "TurtleBot4Navigator": "turtlebot4_navigator",
    "MoveItPy": "",
    "ImageTransport": "",
}


class Ends(NamedTuple):
    """How a call makes ends of channels.

    Attributes
    ----------
    name, type, node
        Places of the arguments, and their keywords; without a node, it is what the method is called on.
    fixed
        The names, where the library fixes them.
    """

    roles: tuple[str, ...]
    name: tuple[int, str] = (1, "topic")
    type: tuple[int, str] = (0, "msg_type")
    node: tuple[int, str] | None = None
    fixed: tuple[str, ...] = ()
    fixed_type: str = ""
    below: bool = False


OF_METHODS = {name: Ends((one.role,), one.name, one.type) for name, one in METHODS.items()}
OF_METHODS["create_lifecycle_publisher"] = OF_METHODS["create_publisher"]
NO_NODE = (99, "node")  # that is given only later
TF_NAMES = ("/tf", "/tf_static")
IMAGE = "sensor_msgs/msg/Image"
OF_TRANSPORT = {
    "advertise": Ends(("publish",), (0, "base_topic"), fixed_type=IMAGE, below=True),
    "advertise_camera": Ends(("publish",), (0, "base_topic"), fixed_type=IMAGE, below=True),
    "subscribe": Ends(("subscribe",), (0, "base_topic"), fixed_type=IMAGE, below=True),
    "subscribe_camera": Ends(("subscribe",), (0, "base_topic"), fixed_type=IMAGE, below=True),
}
OF_LIBRARIES = {  # by the first and the last part of a name
    **{("rclpy", name): Ends((one.role,), one.name, one.type, one.node) for name, one in ACTIONS.items()},
    ("rclpy", "wait_for_message"): Ends(("subscribe",), (2, "topic"), (0, "msg_type"), (1, "node")),
    ("message_filters", "Subscriber"): Ends(("subscribe",), (2, "topic"), (1, "msg_type"), (0, "node")),
    ("tf2_ros", "TransformBroadcaster"): Ends(("publish",), node=(0, "node"), fixed=TF_NAMES[:1], fixed_type=TF),
    ("tf2_ros", "StaticTransformBroadcaster"): Ends(("publish",), node=(0, "node"), fixed=TF_NAMES[1:], fixed_type=TF),
    ("tf2_ros", "TransformListener"): Ends(("subscribe",), node=(1, "node"), fixed=TF_NAMES, fixed_type=TF),
    ("tf2_ros", "BufferClient"): Ends(("call",), (1, "ns"), node=(0, "node"), fixed_type=LOOKUP),
    ("tf2_ros", "BufferServer"): Ends(("execute",), (2, "ns"), node=(1, "node"), fixed_type=LOOKUP),
    ("py_trees_ros", "ActionClient"): Ends(("call",), (2, "action_name"), (1, "action_type"), NO_NODE),
    ("py_trees_ros", "ToBlackboard"): Ends(("subscribe",), (1, "topic_name"), (2, "topic_type"), NO_NODE),
    ("py_trees_ros", "FromBlackboard"): Ends(("publish",), (1, "topic_name"), (2, "topic_type"), NO_NODE),
}  # fmt: skip
LAST_NAMES = frozenset(last for _, last in OF_LIBRARIES)


def is_node_class(library: str) -> bool:
    """Return whether a name of a library is that of a class of nodes, or makes one.

    >>> is_node_class("rclpy.node.Node"), is_node_class("rclpy.create_node"), is_node_class("launch_ros.actions.Node")
    (True, True, False)
    """
    first, _, rest = library.partition(".")
    last = library.rpartition(".")[2]
    return (first == "rclpy" and (last in NODE_CLASSES or rest == "create_node")) or (last in WRAPPERS and bool(rest))


def of_library(library: str) -> Ends | None:
    """Return how a class or function of a library makes ends of channels."""
    return OF_LIBRARIES.get((library.partition(".")[0], library.rpartition(".")[2]))


def interface(name: str) -> str:
    """Return an interface as ROS writes it; empty for what is none.

    >>> interface("std_msgs.msg.String"), interface("std_msgs.msg._string.String"), interface("os.path")
    ('std_msgs/msg/String', 'std_msgs/msg/String', '')
    """
    parts = name.split(".")
    known = len(parts) >= len(("package", "msg", "Name")) and parts[1] in INTERFACES and all(parts)
    return f"{parts[0]}/{parts[1]}/{parts[-1]}" if known else ""
