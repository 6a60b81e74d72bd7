"""What annotations in Python are about: the class or call that they stand beside (rule S11: or an error)."""

from __future__ import annotations

from textwrap import dedent

import pytest

from tests.helpers.annotated import said_by

HEAD = """\
import rclpy
from rclpy.action import ActionServer, ActionClient
from rclpy.node import Node
from sensor_msgs.msg import Image
"""
BEFORE = HEAD.count("\n")


def read(text: str, namespace: str = "/") -> tuple[list[tuple[str, str, int]], list[str]]:
    found, problems = said_by(("a.py", HEAD + dedent(text)), namespace=namespace)
    return [(section, name, line - BEFORE) for section, name, line in found], problems


CAMERA = """\
# privacy: leak Voice
@decorated
class Camera(Node):  # privacy: note of the door
    def __init__(self):
        # privacy: sensitive
        # privacy: source Video
        self.a = self.create_publisher(
            Image,  # privacy: note of the call
            "image", 10)
        super().__init__("camera", namespace="/front")
        self.b = self.create_subscription(Image, topic="/abs", callback=f, qos_profile=1)  # privacy: mundane
        self.c = [self.create_service(S, "~/s", f),  # privacy: mundane
                  ActionServer(self, A, "act", f)]  # privacy: only Video
        self.create_client(S, "cl").call()  # privacy: never Video
"""


def test_a_class_and_its_calls() -> None:
    """The namespace is that of the constructor; a source at a publisher is its node (rule S8)."""
    assert read(CAMERA) == (
        [
            ("nodes", "/front/camera", 1),
            ("nodes", "/front/camera", 3),
            ("topics", "/front/image", 5),
            ("nodes", "/front/camera", 6),
            ("nodes", "/front/camera", 8),
            ("topics", "/front/image", 8),
            ("topics", "/abs", 11),
            ("services", "/front/camera/s", 12),
            ("actions", "/front/act", 13),
            ("services", "/front/cl", 14),
        ],
        [],
    )


def test_nodes_without_a_class() -> None:
    text = """\
    def main():
        node = rclpy.create_node("tool")  # privacy: conduit
        # privacy: source Video
        node.create_publisher(Image, "image", 1)
        # privacy: mundane
        ActionClient(node, A, "~/x")
    def other():
        node = Node(node_name="other", namespace="ns")  # privacy: conduit
    """
    assert read(text, "/r") == (
        [("nodes", "/r/tool", 2), ("nodes", "/r/tool", 3), ("actions", "/r/tool/x", 5), ("nodes", "/r/ns/other", 8)],
        [],
    )


def test_a_class_derived_through_another_file() -> None:
    base = "from rclpy.node import Node\nclass Base(Node): ...\n"
    text = '# privacy: conduit\nclass Mine(Base):\n    def f(self):\n        super().__init__("mine")\n'
    assert said_by(("a.py", text), ("b.py", base)) == ([("nodes", "/mine", 1)], [])
    found, problems = said_by(("a.py", text))
    assert (found, len(problems)) == ([], 1)
    assert "attached to nothing" in problems[0]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("x = 1  # privacy: mundane", "an annotation attached to nothing; put it on the line of a call or class"),
        ("# privacy: mundane\n\nn.create_publisher(Image, 'a', 1)", "attached to nothing"),
        ("n.create_publisher(Image, 'a', 1)\n# privacy: mundane", "attached to nothing"),
        ("n.create_publisher(I, 'a', 1); n.create_publisher(I, 'b', 1)  # privacy: mundane", "beside 2 calls"),
        ("n.create_publisher(Image, self.name, 1)  # privacy: only Video",
         "the name here is no literal; name the element in the annotation: privacy(/image): only"),
        ("n.create_publisher(Image, f'{x}/a', 1)  # privacy: mundane", "no literal"),
        ("n.create_publisher(*a, 'x')  # privacy: mundane", "no literal"),
        ("n.create_publisher(Image, 'a b', 1)  # privacy: mundane", "'a b' is no full name of ROS"),
        ("n.create_publisher(Image, '{node}/x', 1)  # privacy: mundane", "no full name"),
        ("n.create_publisher(Image, '~/x', 1)  # privacy: mundane", "the node here has no name that is a literal"),
        ("n.create_publisher(Image, 'a', 1)  # privacy: source Video",
         "no name that is a literal; name the element in the annotation: privacy(/camera): source Video through"),
        ("n.create_publisher(Image, 'a', 1)  # privacy: leak Video", "leak is said of a node, and this is a topic"),
        ("n.create_subscription(Image, 'a', f, 1)  # privacy: source Video", "source at a subscription"),
        ("x = rclpy.create_node('x')  # privacy: mundane", "mundane is said of a channel, and this is a node"),
        ("x = rclpy.create_node('x')\nx.create_publisher(I, 'a', 1)  # privacy: source Video through /a",
         "the call itself says through which channel"),
        ("class A(Node):  # privacy: conduit\n  pass", "the name here is no literal"),
        ("class A(Node):  # privacy: conduit\n  def f(self, n): super().__init__(n)", "no literal"),
        ("class A:  # privacy: conduit\n  def f(self): super().__init__('a')", "attached to nothing"),
        ("# privacy(/x): note why", "a note about /x, of which nothing is said"),
        ("x = rclpy.create_node('x')  # privacy: note why", "a note about /x, of which nothing is said"),
    ],
)  # fmt: skip
def test_what_is_attached_to_nothing_or_guessed_is_told(text: str, problem: str) -> None:
    found, problems = read(text)
    assert (found, len(problems)) == ([], 1)
    assert problem in problems[0]


def test_a_relative_name_in_a_namespace_that_is_no_literal_is_not_guessed() -> None:
    """What is said of another topic of that name could hide a leak there."""
    found, problems = read("""\
        class Camera(Node):
            def __init__(self, space):
                super().__init__("camera", namespace=space)
                self.a = self.create_publisher(Image, "image", 1)  # privacy: never Video
                self.b = self.create_publisher(Image, "/absolute", 1)  # privacy: never Video
        """)
    assert [name for _, name, _ in found] == ["/absolute"]
    (problem,) = problems
    assert "the node here has no name that is a literal" in problem


def test_one_variable_of_two_names_is_not_guessed() -> None:
    text = (
        "n = rclpy.create_node('a')\nn = rclpy.create_node('b')\nn.create_publisher(I, 'x', 1)  # privacy: source Video"
    )
    found, problems = read(text)
    assert (found, len(problems)) == ([], 1)


def test_a_variable_is_of_its_function() -> None:
    text = (
        "def f():\n  n = rclpy.create_node('a')\ndef g(n):\n  n.create_publisher(I, 'x', 1)  # privacy: source Video\n"
    )
    found, problems = read(text)
    assert (found, len(problems)) == ([], 1)


def test_a_name_stands_anywhere() -> None:
    assert read("# privacy(/a/*): only Video\n\nx = 1  # privacy(/n): leak Voice\n# privacy(/n): note why") == (
        [("channels", "/a/*", 1), ("nodes", "/n", 3), ("nodes", "/n", 4)],
        [],
    )


def test_strings_are_no_comments() -> None:
    text = '"""\n# privacy: leak Voice\n"""\nx = "# privacy: leak Voice"\ny = f"""\n# privacy: leak {x}\n"""\n'
    assert read(text) == ([], [])


@pytest.mark.parametrize(
    ("data", "line", "problem"),
    [
        (b"x = (\n", 1, "'(' was never closed"),
        (b"a = 1\n b = 2\n", 2, "unexpected indent"),
        (b"# -*- coding: nope -*-\n", 1, "unknown encoding"),
        (b"x = '\xff'\n", 1, "missing encoding"),
        (b"x = 1\0\n", 1, "null byte"),
        (b"x = " + b"-" * 100_000 + b"1\n", 1, ""),
        (b"x = " + b"(" * 300 + b"1\n", 1, "too many nested parentheses"),
    ],
)
def test_a_file_that_is_no_python_is_told(data: bytes, line: int, problem: str) -> None:
    from rosprivacy.ingest.code.python_code import read_python

    (told,) = read_python("a.py", data).problems
    assert str(told).startswith(f"a.py:{line}: not Python ")
    assert problem in str(told)
    assert str(told).isprintable()


def test_long_chains_and_odd_ends_of_lines_are_read() -> None:
    long = "x = " + " + ".join(["1"] * 800)
    code = "\ufeff# coding: utf-8\r\n" + long + "\r\nn.create_publisher(Image, 'a', 1)\r\n".replace("\r\n", "\r")
    assert said_by(("a.py", code + "# é\n# privacy(/a): mundane")) == ([("channels", "/a", 5)], [])
    latin = "# coding: latin-1\nn = 'é'\nn.create_publisher(I, 'a', 1)  # privacy: mundane\n".encode("latin-1")
    from rosprivacy.ingest.code.python_code import read_python

    assert [comment.text for comment in read_python("a.py", latin).comments][1:] == ["privacy: mundane"]
