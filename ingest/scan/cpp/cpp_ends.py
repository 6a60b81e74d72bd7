"""Which calls in C++ make ends of channels, and what of them says the node, the name and the type.

Source: the signatures of rclcpp, rclcpp_lifecycle, rclcpp_action, image_transport, point_cloud_transport,
message_filters, tf2_ros and nav2_util.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.cpp.cpp_expressions import Call, Construction, Expression, Ref, Text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.scan.cpp.cpp_program import CppProgram
    from rosprivacy.ingest.scan.cpp.cpp_units import Function

OF_NODES = {
    "create_publisher": "publish",
    "create_generic_publisher": "publish",
    "create_subscription": "subscribe",
    "create_generic_subscription": "subscribe",
    "create_service": "reply",
    "create_generic_service": "reply",
    "create_client": "request",
    "create_generic_client": "request",
    "create_server": "execute",
    "create_camera_publisher": "publish",
    "create_camera_subscription": "subscribe",
}
OF_TRANSPORTS = {
    "advertise": "publish",
    "advertiseCamera": "publish",
    "subscribe": "subscribe",
    "subscribeCamera": "subscribe",
}
TRANSPORTS = {"image_transport": "sensor_msgs/msg/Image", "point_cloud_transport": "sensor_msgs/msg/PointCloud2"}
TRANSPORT_CLASSES = {"ImageTransport": "image_transport", "PointCloudTransport": "point_cloud_transport"}
SPACES = ("rclcpp", "rclcpp_lifecycle", "rclcpp_action", *TRANSPORTS)  # of functions that take the node first
FILTERS = ("Subscriber", "SubscriberFilter")
TF = "tf2_msgs/msg/TFMessage"
TRANSFORMS = {
    "TransformBroadcaster": (("publish", "/tf"),),
    "StaticTransformBroadcaster": (("publish", "/tf_static"),),
    "TransformListener": (("subscribe", "/tf"), ("subscribe", "/tf_static")),
}
OF_NAV2 = {  # class -> role, argument of the node, of the name
    "SimpleActionServer": ("execute", 0, 1),
    "ServiceClient": ("request", 1, 0),
    "ServiceServer": ("reply", 1, 0),
}
NODES = ("Node", "LifecycleNode")
NODE_SPACES = ("rclcpp", "rclcpp_lifecycle", "nav2_util", "nav2")
NODE_BASES = (*NODES, "ControllerInterface", "ChainableControllerInterface", "ControllerInterfaceBase")
UNNAMED_BASES = ("ControllerInterface", "ChainableControllerInterface", "ControllerInterfaceBase")
WRAPPERS = {
    "MoveGroupInterface", "PlanningSceneInterface", "PlanningSceneMonitor", "MoveItCpp", "MoveItVisualTools",
    "RvizVisualTools", "Costmap2DROS", "Updater", "PluginlibFactory", "OccGridMapUpdater", "BasicNavigator",
}  # fmt: skip
THIS_OBJECT = Ref("this")


class End(NamedTuple):
    """A call that makes an end of a channel.

    Attributes
    ----------
    node
        What it is made of; None where the object is meant whose method it stands in.
    names
        Expressions: alternatives.
    written
        Type as the code writes it; ``type`` where the library fixes it.
    own_node
        Whether it makes a node of its own where none is handed to it.
    """

    role: str
    node: Expression | None
    name: Expression
    line: int
    start: int
    written: str = ""
    type: str = ""
    below: bool = False
    own_node: bool = False


def ends_of(program: CppProgram, call: Call | Construction, function: Function) -> Iterator[End]:
    """Yield the ends that a call makes; most calls make none."""
    if isinstance(call, Construction):
        yield from _constructed(program, call, function)
        return
    if call.last in OF_NODES:
        yield from _created(program, call, function)
    elif call.last in OF_TRANSPORTS and call.of is not None and call.arguments:
        yield from _transported(program, call, function)
    elif call.of is None and (call.last in TRANSFORMS or call.last in OF_NAV2 or call.last in FILTERS):
        written = f"{call.name}<{', '.join(call.types)}>" if call.types else call.name
        yield from _constructed(program, Construction(written, call.arguments, call.line, call.start), function)


def _created(program: CppProgram, call: Call, function: Function) -> Iterator[End]:
    last, role, given, node = call.last, OF_NODES[call.last], call.arguments, call.of
    scope = (
        program.meaning(call.name, function.file)[0].rpartition("::")[0].rpartition("::")[2]
        if "::" in call.name
        else ""
    )
    transport = TRANSPORTS.get(scope, "")
    plain = bool(transport) or "generic" in last or "camera" in last
    if scope not in SPACES and program.has_method(last, function, node):
        return  # of the checkout: what it calls itself is the end
    kind = program.type_text(node, function) if node is not None else ""
    if not call.types and not plain and not (kind and program.last(kind, function.file) in NODE_BASES):
        return
    free = scope in SPACES or (
        node is None and (last == "create_server" or given[:1] == (THIS_OBJECT,) or "camera" in last)
    )
    if last == "create_server" or (last == "create_client" and (scope == "rclcpp_action" or (node is None and free))):
        role = {"create_server": "execute", "create_client": "call"}[last]
    if free:
        interfaces = [at for at, one in enumerate(given) if _of_interface(one)]
        if not given:
            return
        node, given = given[0], given[max(interfaces, default=0) + 1 :]
        if transport and (isinstance(node, Text)):
            return
    if not given:
        return
    written = call.types[0] if call.types else ""
    if transport or "camera" in last:
        transport, written = transport or TRANSPORTS["image_transport"], ""
    if "generic" in last and len(given) > 1 and isinstance(given[1], Text):
        written = given[1].text.replace("/", "::")
    yield End(role, node, given[0], call.line, call.start, written, transport, bool(transport) and role == "publish")


def _of_interface(argument: Expression) -> bool:
    """Whether an argument is one of the interfaces that a node is made of."""
    return isinstance(argument, Call) and argument.last.startswith("get_node_")


def _transported(program: CppProgram, call: Call, function: Function) -> Iterator[End]:
    kind = program.type_text(call.of, function) if call.of is not None else ""
    name, types = program.meaning(kind, function.file) if kind else ("", ())
    last = name.rpartition("::")[2]
    if last in TRANSPORT_CLASSES:
        kind = TRANSPORTS[TRANSPORT_CLASSES[last]]
        role = OF_TRANSPORTS[call.last]
        yield End(role, call.of, call.arguments[0], call.line, call.start, "", kind, role == "publish")
    elif last in FILTERS and call.last == "subscribe" and len(call.arguments) > 1:
        yield _filtered(last, types, call.arguments, call.line, call.start)


def _filtered(last: str, types: tuple[str, ...], arguments: tuple[Expression, ...], line: int, start: int) -> End:
    kind = "" if last == "Subscriber" else TRANSPORTS["image_transport"]
    return End("subscribe", arguments[0], arguments[1], line, start, types[0] if types and not kind else "", kind)


def _constructed(program: CppProgram, construction: Construction, function: Function) -> Iterator[End]:
    name, types = program.meaning(construction.type, function.file)
    space, _, last = name.rpartition("::")
    given = construction.arguments
    if space and program.type_class(name, function.file):
        return
    if last in TRANSFORMS and given and space in ("", "tf2_ros"):
        node = (given[1] if len(given) > 1 else None) if last == "TransformListener" else given[0]
        for role, channel in TRANSFORMS[last]:
            yield End(
                role,
                node,
                Text(channel),
                construction.line,
                construction.start,
                "",
                TF,
                own_node=last == "TransformListener",
            )
    elif last in FILTERS and len(given) > 1 and space in ("message_filters", "image_transport", ""):
        if (last != "Subscriber" or types) and not program.type_class(name, function.file):
            yield _filtered(last, types, given, construction.line, construction.start)
    elif last in OF_NAV2 and space in ("nav2_util", "nav2") and len(given) > 1 and types:
        role, node_at, name_at = OF_NAV2[last]
        name_at += sum(map(_of_interface, given[1:])) if _of_interface(given[0]) else 0
        if name_at < len(given):
            yield End(role, given[node_at], given[name_at], construction.line, construction.start, types[0])
