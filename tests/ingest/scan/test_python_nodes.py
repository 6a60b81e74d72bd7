"""Python code -> nodes and ends of channels: each call that makes an end gives a name or a gap at its line (S16)."""

from __future__ import annotations

from textwrap import dedent
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.ingest.scan.scan_facts import DEFAULT, LITERAL
from tests.ingest.scan.source_code import python_nodes

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.scan.scan_facts import CodeFacts, CodeNode, Name

HEAD = """\
import os
import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from std_msgs.msg import Int32, String
"""


def scan(folder: Path, **files: str) -> CodeFacts:
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEAD + dedent(text), encoding="utf-8")
    return python_nodes(folder)


def shown(name: Name) -> str:
    return "".join("{}" if piece.text is None else piece.text for piece in name)


def names(node: CodeNode) -> list[str]:
    return sorted(shown(name) for end in node.endpoints for name in end.names)


def of_body(folder: Path, body: str, before: str = "") -> CodeFacts:
    body = body.replace("PUB(", "self.create_publisher(")
    lines = "".join(f"        {line}\n" for line in dedent(body).strip().splitlines())
    head = f"{dedent(before)}\nclass Talker(Node):\n    def __init__(self):\n        super().__init__('talker')\n"
    return scan(folder, talker=head + lines)


PUBLISHED = {
    "a literal": ("PUB(String, '/a', 1)", ["/a"]),
    "keywords": ("self.create_publisher(qos_profile=1, topic='/a', msg_type=String)", ["/a"]),
    "a constant of the module": ("PUB(String, TOPIC, 1)", ["/top"]),
    "an f-string": ("x = 'b'\nPUB(String, f'/a/{x}', 1)", ["/a/b"]),
    "a sum": ("PUB(String, TOPIC + '/' + 'x', 1)", ["/top/x"]),
    "percent": ("PUB(String, '/%s/%02d' % ('a', 3), 1)", ["/a/03"]),
    "format": ("PUB(String, '/{}/{x}'.format('a', x='b'), 1)", ["/a/b"]),
    "join": ("PUB(String, '/'.join(['', 'a', 'b']), 1)", ["/a/b"]),
    "a path": ("PUB(String, os.path.join('/a', 'b'), 1)", ["/a/b"]),
    "a loop over constants": ("for i in range(2):\n    PUB(String, f'/a{i}', 1)", ["/a0", "/a1"]),
    "a loop over a dictionary": ("for k, v in {'a': 1, 'b': 2}.items():\n    PUB(String, k, v)", ["a", "b"]),
    "a condition": ("PUB(String, 'a' if self.x else 'b', 1)", ["a", "b"]),
    "the last of several": ("t = 'a'\nt = 'b'\nPUB(String, t, 1)", ["b"]),
    "one of several": ("t = 'a'\nif self.x:\n    t = 'b'\nPUB(String, t, 1)", ["a", "b"]),
    "each at its time": ("t = 'a'\nPUB(String, t, 1)\nt = 'b'\nPUB(String, t, 1)", ["a", "b"]),
    "an attribute": ("self.t = '/a'\nPUB(String, self.t, 1)", ["/a"]),
    "a method of strings": ("PUB(String, '/A/'.lower().rstrip('/'), 1)", ["/a"]),
    "a lambda": ("f = lambda x: '/a/' + x\nPUB(String, f('b'), 1)", ["/a/b"]),
    "a handed-on method": ("self.declare_parameter('t', 'a')\np = self.get_parameter\nPUB(Int32, p('t').value)", ["a"]),
}  # fmt: skip


@pytest.mark.parametrize(("body", "expected"), PUBLISHED.values(), ids=PUBLISHED)
def test_what_names_a_channel(tmp_path: Path, body: str, expected: list[str]) -> None:
    facts = of_body(tmp_path, body, "TOPIC = '/top'")
    assert (names(facts.nodes[0]), facts.gaps) == (expected, ())


@pytest.mark.parametrize(
    ("call", "role", "type_"),
    [
        ("PUB(String, '/a', 1)", "publish", "std_msgs/msg/String"),
        ("self.create_subscription(String, '/a', print, 1)", "subscribe", "std_msgs/msg/String"),
        ("self.create_service(Trigger, '/a', print)", "reply", "std_srvs/srv/Trigger"),
        ("self.create_client(Trigger, '/a')", "request", "std_srvs/srv/Trigger"),
        ("ActionServer(self, Spin, '/a', print)", "execute", "nav2_msgs/action/Spin"),
        ("ActionClient(self, Spin, '/a')", "call", "nav2_msgs/action/Spin"),
        ("message_filters.Subscriber(self, String, '/a')", "subscribe", "std_msgs/msg/String"),
    ],
)
def test_roles_and_types(tmp_path: Path, call: str, role: str, type_: str) -> None:
    imports = "import message_filters\nfrom std_srvs.srv import Trigger\nfrom nav2_msgs.action import Spin\n"
    (end,) = of_body(tmp_path, call, imports).nodes[0].endpoints
    assert (end.role, end.type, shown(end.names[0])) == (role, type_, "/a")


def test_transforms_have_the_names_of_the_library(tmp_path: Path) -> None:
    body = "self.a = tf2_ros.TransformBroadcaster(self)\nself.b = tf2_ros.TransformListener(tf2_ros.Buffer(), self)"
    (node,) = of_body(tmp_path, body, "import tf2_ros").nodes
    assert [(end.role, [shown(one) for one in end.names]) for end in node.endpoints] == [
        ("publish", ["/tf"]),
        ("subscribe", ["/tf", "/tf_static"]),
    ]


@pytest.mark.parametrize(
    ("body", "known", "parameter"),
    [
        ("PUB(String, self.declare_parameter('t', '/a').value, 1)", DEFAULT, "t"),
        ("self.declare_parameter('t', '/a')\nPUB(Int32, self.get_parameter('t').get_parameter_value().string_value, 1)",
         DEFAULT, "t"),
        ("self.declare_parameters('', [('t', '/a')])\nPUB(String, self.get_parameter('t').value, 1)", DEFAULT, "t"),
        ("PUB(String, os.environ.get('T', '/a'), 1)", DEFAULT, ""),
        ("PUB(String, '/a', 1)", LITERAL, ""),
    ],
)  # fmt: skip
def test_how_a_name_is_known(tmp_path: Path, body: str, known: str, parameter: str) -> None:
    (node,) = of_body(tmp_path, body).nodes
    ((piece,),) = node.endpoints[0].names
    assert (piece.text, piece.basis, piece.parameter) == ("/a", known, parameter)
    assert node.parameters == ({"t": "/a"} if parameter else {})


@pytest.mark.parametrize(
    "body",
    [
        "PUB(String, load()['x'], 1)",
        "PUB(String, self.get_parameter('t').value, 1)",
        "self.declare_parameter('t', '')\nPUB(String, self.get_parameter('t').value, 1)",
        "self.create_publisher(*load())",
        "for t in load():\n    PUB(String, t, 1)",
        "for t in []:\n    PUB(String, t, 1)",
        "t = 'a'\nwhile self.x:\n    t += 'b'\n    PUB(String, t, 1)",
        "for i in range(40):\n    PUB(String, f'/a{i}', 1)",
        "take(self.create_publisher)",
    ],
)
def test_what_is_not_fixed_is_a_gap_at_its_line(tmp_path: Path, body: str) -> None:
    facts = of_body(tmp_path, body, "from far import load, take")
    line = next(
        at for at, one in enumerate((tmp_path / "talker.py").read_text().splitlines(), 1) if "create_pub" in one
    )
    assert [(gap.place.line, gap.sort) for gap in facts.gaps if gap.sort == "name"][-1:] == [(line, "name")]


def test_a_node_and_its_namespace(tmp_path: Path) -> None:
    (node,) = scan(
        tmp_path, a="class A(Node):\n    def __init__(self):\n        super().__init__('a', namespace='/robot')\n"
    ).nodes
    assert ([shown(one) for one in node.names], [shown(one) for one in node.namespaces]) == (["a"], ["/robot"])


def test_a_name_that_the_caller_gives(tmp_path: Path) -> None:
    code = """
    class A(Node):
        def __init__(self, name, topic='/default'):
            super().__init__(name)
            self.create_publisher(String, topic, 1)
    def main():
        nodes = [A('left', '/l'), A('right', topic='/r')]
    """
    (node,) = scan(tmp_path, a=code).nodes
    assert ([shown(one) for one in node.names], names(node)) == (["left", "right"], ["/l", "/r"])


def test_a_base_class_in_another_file(tmp_path: Path) -> None:
    base = """
    class Base(Node):
        def __init__(self, name):
            super().__init__(name)
            self.create_publisher(String, f'/{self.part}/state', 1)
            self.add('fixed')
        def add(self, topic):
            self.create_subscription(String, topic, print, 1)
    """
    derived = """
    from pkg.base import Base
    class Arm(Base):
        part = 'arm'
        def __init__(self):
            super().__init__('arm_node')
            self.add('arm_only')
    class Leg(Base):
        def __init__(self):
            self.part = 'leg'
            super().__init__('leg_node')
    """
    facts = scan(tmp_path, pkg____init__="", pkg__base=base, pkg__derived=derived)
    found = {
        node.name: (shown(node.names[0]), names(node), {end.place.file for end in node.endpoints})
        for node in facts.nodes
    }
    assert found == {
        "Arm": ("arm_node", ["/arm/state", "arm_only", "fixed"], {"pkg/base.py"}),
        "Leg": ("leg_node", ["/leg/state", "fixed"], {"pkg/base.py"}),
    }
    assert facts.gaps == ()


def test_a_helper_gives_each_node_its_own_names(tmp_path: Path) -> None:
    code = """
    class Helper:
        def __init__(self, node, topic):
            self.node = node
            self.pub = self.node.create_publisher(String, topic, 1)
    def subscribe(node, topic):
        node.create_subscription(Int32, topic, print, 1)
    class A(Node):
        def __init__(self):
            super().__init__('a')
            self.helper = Helper(self, '/of_a')
    class B(Node):
        def __init__(self):
            super().__init__('b')
            self.helper = Helper(self, '/of_b')
            subscribe(self, '/in_b')
    """
    facts = scan(tmp_path, a=code)
    assert {node.name: names(node) for node in facts.nodes} == {"A": ["/of_a"], "B": ["/in_b", "/of_b"]}
    assert facts.gaps == ()


def test_nodes_without_a_class(tmp_path: Path) -> None:
    code = """
    def main():
        node = rclpy.create_node('one')
        node.create_publisher(String, 'a', 1)
        other = Node('two')
        other.create_publisher(String, 'b', 1)
    """
    facts = scan(tmp_path, a=code)
    assert [(node.name, shown(node.names[0]), names(node)) for node in facts.nodes] == [
        ("main", "one", ["a"]),
        ("main", "two", ["b"]),
    ]


def test_of_which_node_is_not_known(tmp_path: Path) -> None:
    facts = scan(
        tmp_path, a="class Helper:\n    def __init__(self, node):\n        node.create_publisher(String, '/a', 1)\n"
    )
    assert [(gap.sort, gap.place.line) for gap in facts.gaps] == [("node-of", 8)]
    assert [(node.name, node.names, names(node)) for node in facts.nodes] == [("Helper", (), ["/a"])]


def test_wrappers_of_other_packages(tmp_path: Path) -> None:
    code = """
    from nav2_simple_commander.robot_navigator import BasicNavigator
    from far.arm import Arm
    class A(Node):
        def __init__(self):
            super().__init__('a')
            self.arm = Arm(self)
    def main():
        BasicNavigator()
    """
    found = {shown(node.names[0]): [one.name for one in node.wrappers] for node in scan(tmp_path, a=code).nodes}
    assert found == {"a": ["Arm"], "basic_navigator": ["BasicNavigator"]}


@pytest.mark.parametrize(
    "line",
    ["boto3.client('s3').create_client('s3', 'x')", "Bus('x').create_publisher('a', 'b')", "local(String, 'a', 1)"],
)
def test_calls_of_other_libraries_are_none(tmp_path: Path, line: str) -> None:
    before = "import boto3\nclass Bus:\n    def create_publisher(self, a, b): pass\ndef local(a, b, c): pass\n"
    facts = of_body(tmp_path, line, before)
    assert (names(facts.nodes[0]), facts.gaps) == ([], ())


def test_code_of_ros_1_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "old.py").write_text("import rospy, tf2_ros\ntf2_ros.TransformListener(tf2_ros.Buffer())\n")
    facts = python_nodes(tmp_path)
    assert ([(gap.sort, gap.place.file) for gap in facts.gaps], facts.nodes) == ([("file", "old.py")], ())


HOSTILE = {
    "a long sum": "x = " + " + ".join(["'a'"] * 3000),
    "itself": "x = 'a'\nx = x + y\ny = x + x\ndef f(): return f()\nx = f()",
    "doubling": "x0 = 'a'\n" + "".join(f"x{at} = x{at - 1} + x{at - 1}\n" for at in range(1, 60)) + "x = x59",
    "branches": "x = ''\n" + "if y:\n    x += 'a'\nelse:\n    x += 'b'\n" * 60,
    "deep": "x = " + "[" * 80 + "]" * 80,
    "bases of each other": "class P(Q): pass\nclass Q(P): pass\nx = P().y",
    "calls of calls": "def f(a): return g(a)\ndef g(a): return f(a) + f(a)\nx = f(1)",
}


@pytest.mark.parametrize("code", HOSTILE.values(), ids=HOSTILE)
def test_hostile_code_ends_in_a_name_or_a_gap(tmp_path: Path, code: str) -> None:
    facts = of_body(tmp_path, "PUB(String, x, 1)", code)
    assert facts.gaps or names(facts.nodes[-1])
    assert all(len(shown(name)) <= 1000 for node in facts.nodes for end in node.endpoints for name in end.names)


EXPRESSIONS = st.recursive(
    st.sampled_from(["'a'", "'/b'", "x", "self.y", "f('c')", "None", "3", "load()", "[]", "{'a': 'b'}", "('a', 'b')"]),
    lambda inner: st.one_of(
        st.builds("({} + {})".format, inner, inner),
        st.builds("({} if x else {})".format, inner, inner),
        st.builds("({} or {})".format, inner, inner),
        st.builds("({})[{}]".format, inner, inner),
        st.builds("({}).get({}, 'd')".format, inner, inner),
        st.builds("({} % {})".format, inner, inner),
        st.builds("'/{{}}'.format({})".format, inner),
        st.builds("''.join([{}, {}])".format, inner, inner),
        st.builds("[i for i in {}]".format, inner),
        st.builds("f({})".format, inner),
        st.builds("getattr(self, {})".format, inner),
        st.builds("str({})".format, inner),
    ),
    max_leaves=8,
)


@given(EXPRESSIONS)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_each_call_gives_a_name_or_a_gap(tmp_path: Path, expression: str) -> None:
    facts = of_body(tmp_path, f"self.y = '/y'\nPUB(String, {expression}, 1)", "x = '/x'\ndef f(a): return a")
    (node,) = facts.nodes
    line = len(HEAD.splitlines()) + 7
    assert {end.place.line for end in node.endpoints} == {line}
    is_open = any(piece.text is None for end in node.endpoints for name in end.names for piece in name)
    assert is_open == any(gap.place.line == line and gap.sort == "name" for gap in facts.gaps)
