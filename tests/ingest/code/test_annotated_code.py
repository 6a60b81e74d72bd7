"""What annotations in Python and C++ are about: the class or call that they stand beside (rule S11: or an error)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy import analyze
from rosprivacy.ingest.code.annotated_elements import attach, label_text
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ontology.vocabulary import load
from tests.helpers.annotated import said_by

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("tree_sitter_cpp", reason="without the [code] extra")

Label = tuple[str, str, int]  # section, name, line
HEAD = "import rclpy; from rclpy.action import ActionServer, ActionClient; from rclpy.node import Node\n"


def read(text: str, ending: str = ".py", namespace: str = "/") -> tuple[list[Label], list[str]]:
    """What one file says; lines without those of the imports that stand before Python."""
    head = HEAD if ending == ".py" else ""
    labels, problems = said_by((f"a{ending}", head + text), namespace=namespace)
    return [(section, name, line - head.count("\n")) for section, name, line in labels], problems


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
    labels = [
        ("nodes", "/front/camera", 1), ("nodes", "/front/camera", 3), ("topics", "/front/image", 5),
        ("nodes", "/front/camera", 6), ("nodes", "/front/camera", 8), ("topics", "/front/image", 8),
        ("topics", "/abs", 11), ("services", "/front/camera/s", 12), ("actions", "/front/act", 13),
        ("services", "/front/cl", 14),
    ]  # fmt: skip
    assert read(CAMERA) == (labels, [])


NO_CLASS = """\
def main():
    node = rclpy.create_node("tool")  # privacy: conduit
    # privacy: source Video
    node.create_publisher(Image, "image", 1)
    # privacy: mundane
    ActionClient(node, A, "~/x")
def other():
    node = Node(node_name="other", namespace="ns")  # privacy: conduit
"""


def test_nodes_without_a_class() -> None:
    labels = [
        ("nodes", "/r/tool", 2),
        ("nodes", "/r/tool", 3),
        ("actions", "/r/tool/x", 5),
        ("nodes", "/r/ns/other", 8),
    ]
    assert read(NO_CLASS, namespace="/r") == (labels, [])


HEADER = """\
// privacy: leak Voice
template<typename T>
class Camera : public rclcpp_lifecycle::LifecycleNode, private Other<T>
{
  explicit Camera(const rclcpp::NodeOptions & options);
  Publisher::SharedPtr pub_;
};
"""
SOURCE = """\
Camera::Camera(const rclcpp::NodeOptions & options)
: LifecycleNode("cam" /* x */ "era", "front", options),
  // privacy: mundane
  a_(create_publisher<sensor_msgs::msg::Image>("a", 10))
{
  /* privacy: only Video
   * privacy: source Video
   */
  pub_ = this->create_publisher<sensor_msgs::msg::Image>(
    R"(image)", 10);  /// privacy: note why
  auto f = [this](int) { s_ = create_service<S>("~/s", &Camera::g); };  // privacy: mundane
  it_ = image_transport::create_publisher(this, "img");  // privacy: source Location
  act_ = rclcpp_action::create_client<A>(this, "/act");  //!< privacy: never Video
}
void ns::Camera::g()
{
  auto node = std::make_shared<rclcpp::Node>("tool");  // privacy: conduit
  node->create_subscription<A>("t", 1, f);  // privacy: mundane
  // privacy: leak Voice
  rclcpp::Node other("other");
}
"""


def test_a_class_over_two_files() -> None:
    """The name is that of the constructor, in whatever file; below image_transport's topic there are more."""
    labels = [
        ("nodes", "/front/camera", 1), ("topics", "/front/a", 3), ("topics", "/front/image", 6),
        ("nodes", "/front/camera", 7), ("nodes", "/front/camera", 10), ("topics", "/front/image", 10),
        ("services", "/front/camera/s", 11), ("nodes", "/front/camera", 12), ("actions", "/act", 13),
        ("nodes", "/tool", 17), ("topics", "/t", 18), ("nodes", "/other", 19),
    ]  # fmt: skip
    assert said_by(("a.hpp", HEADER), ("b.cpp", SOURCE)) == (labels, [])


def test_a_class_derived_through_another_file() -> None:
    base = "from rclpy.node import Node\nclass Base(Node): ...\n"
    text = '# privacy: conduit\nclass Mine(Base):\n    def f(self):\n        super().__init__("mine")\n'
    assert said_by(("a.py", text), ("b.py", base)) == ([("nodes", "/mine", 1)], [])
    labels, (problem,) = said_by(("a.py", text))
    assert labels == []
    assert "attached to nothing" in problem


def test_two_classes_of_one_name_are_not_guessed() -> None:
    one, two = (f'A::A() : rclcpp::Node("{name}") {{}}' for name in "xy")
    head = "// privacy: conduit\nclass A : public rclcpp::Node {};"
    labels, problems = said_by(("a.hpp", head), ("a.cpp", one), ("b.cpp", two))
    assert (labels, len(problems)) == ([], 1)
    assert said_by(("a.hpp", head + "\n" + one), ("b.cpp", two)) == ([("nodes", "/x", 1)], [])


COMMENTS: dict[str, tuple[str, str, list[Label]]] = {
    "a name stands anywhere": (
        ".py", "# privacy(/a/*): only Video\n\nx = 1  # privacy(/n): leak Voice\n# privacy(/n): note why",
        [("channels", "/a/*", 1), ("nodes", "/n", 3), ("nodes", "/n", 4)],
    ),
    "strings of Python are none": (
        ".py", '"""\n# privacy: leak Voice\n"""\nx = "# privacy: leak Voice"\ny = f"""\n# privacy: leak {x}\n"""\n', [],
    ),
    "strings of C++ are none": (
        ".cpp",
        'auto a = "// privacy: leak Voice";\nauto b = R"x(\n// privacy: leak Voice\n)x";\nchar c = \'"\'; // x\n',
        [],
    ),
    "one goes on behind a backslash": (
        ".cpp", '// said \\\nprivacy: mundane\nvoid f() { n->create_publisher<I>("a", 1); }\n', [("topics", "/a", 2)],
    ),
    "a delegating constructor is no other name": (
        ".cpp", 'class A : public rclcpp::Node { // privacy: conduit\n A() : A("x") {}\n A(S n) : Node("a") {} };',
        [("nodes", "/a", 1)],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", COMMENTS)
def test_what_is_a_comment_and_of_whom(case: str) -> None:
    ending, text, labels = COMMENTS[case]
    assert read(text, ending) == (labels, [])


IN_PYTHON = [
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
    ("n = rclpy.create_node('a')\nn = rclpy.create_node('b')\nn.create_publisher(I, 'x', 1)  # privacy: source Video",
     "no name that is a literal"),
    ("def f():\n  n = rclpy.create_node('a')\ndef g(n):\n  n.create_publisher(I, 'x', 1)  # privacy: source Video\n",
     "no name that is a literal"),
]  # fmt: skip
IN_CPP = [
    ("int x = 1;  // privacy: mundane", "an annotation attached to nothing"),
    ('// privacy: mundane\n\nvoid f() { n->create_publisher<I>("a", 1); }', "attached to nothing"),
    ("void f() { n->create_publisher<I>(name, 1); }  // privacy: mundane", "the name here is no literal"),
    ('void f() { n->create_publisher<I>("a\\x62", 1); }  // privacy: mundane', "no literal"),
    ('void f() { n->create_publisher<I>("a" "\\x62", 1); }  // privacy: mundane', "no literal"),
    ('void f() { n->create_publisher<I>("a" + b, 1); }  // privacy: mundane', "no literal"),
    ('void f() { n->create_publisher<I>("a", 1); m->create_client<J>("b"); }// privacy: mundane', "beside 2 calls"),
    ('void f() { n->create_publisher<I>("a", 1); }  // privacy: source Video', "the node here has no name"),
    ('class A : Base { A() : Base("a") {} };  // privacy: conduit', "attached to nothing"),
    ("class A : rclcpp::Node { A() : Node(name) {} };  // privacy: conduit", "no literal"),
    ('#define X create_publisher<I>("a", 1) // privacy: mundane', "a macro or in code that cannot be read"),
    ('#define X(a) \\\n  y("privacy: leak Voice")', "a macro or in code that cannot be read"),
    ('class { ( "privacy: leak Voice"', "a macro or in code that cannot be read"),
    ('auto x = R"(\n// privacy: leak Voice\n', "a macro or in code that cannot be read"),
    ("// privacy: leak Vo\udcff\udcfe", "unknown category"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("ending", "text", "problem"), [*((".py", *row) for row in IN_PYTHON), *((".cpp", *row) for row in IN_CPP)]
)
def test_what_is_attached_to_nothing_or_guessed_is_told(ending: str, text: str, problem: str) -> None:
    labels, (message,) = read(text.encode("utf-8", "replace").decode(), ending)
    assert labels == []
    assert problem in message
    assert message.isprintable()


def test_a_relative_name_in_a_namespace_that_is_no_literal_is_not_guessed() -> None:
    """What is said of another topic of that name could hide a leak there."""
    labels, (problem,) = read("""\
class Camera(Node):
    def __init__(self, space):
        super().__init__("camera", namespace=space)
        self.a = self.create_publisher(Image, "image", 1)  # privacy: never Video
        self.b = self.create_publisher(Image, "/absolute", 1)  # privacy: never Video
""")
    assert [name for _, name, _ in labels] == ["/absolute"]
    assert "the node here has no name that is a literal" in problem


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
    (told,) = read_python("a.py", data).problems
    assert str(told).startswith(f"a.py:{line}: not Python ")
    assert problem in str(told)
    assert str(told).isprintable()


def test_long_chains_and_odd_ends_of_lines_are_read() -> None:
    long = "x = " + " + ".join(["1"] * 800)
    code = "\ufeff# coding: utf-8\r\n" + long + "\r\nn.create_publisher(Image, 'a', 1)\r\n".replace("\r\n", "\r")
    assert said_by(("a.py", code + "# é\n# privacy(/a): mundane")) == ([("channels", "/a", 5)], [])
    latin = "# coding: latin-1\nn = 'é'\nn.create_publisher(I, 'a', 1)  # privacy: mundane\n".encode("latin-1")
    assert [comment.text for comment in read_python("a.py", latin).comments][1:] == ["privacy: mundane"]


@pytest.mark.parametrize("data", [b"", b"\xff\xfe\0\0", b"{" * 50_000, b"#if 0\n" * 2000, b"a<" * 20_000, b"/*" * 9])
def test_what_is_no_cpp_says_nothing_and_ends(data: bytes) -> None:
    code = read_cpp("a.cpp", data)
    assert code.problems == ()


POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/a"><profiles><profile ns="/" node="a"><topics publish="ALLOW">{}</topics></profile></profiles></enclave>
<enclave path="/o"><profiles>
<profile ns="/" node="out"><topics subscribe="ALLOW">{}</topics></profile></profiles></enclave>
</enclaves></policy>
"""


def test_image_transport_writes_below_its_topic_too(tmp_path: Path) -> None:
    """A source through the topic alone would lose what is sent compressed (rule S8: through the channels named)."""
    text = (
        'A::A() : rclcpp::Node("a") {\n// privacy: source Video\nit_ = image_transport::create_publisher(this, "i");\n}'
    )
    labelled, problems = attach([read_cpp("a.cpp", text.encode())], load(), "/")
    assert not problems
    (tmp_path / "l.yaml").write_text(label_text(labelled, load(), "l.yaml") + "  /out: {leak: [Video]}\n")
    for topics in (["/i"], ["/i/compressed"], ["/i", "/i/compressed", "/i/theora"]):
        written, read = ("".join(f"<topic>{one}</topic>" for one in some) for some in (topics, topics[-1:]))
        (tmp_path / "p.xml").write_text(POLICY.format(written, read))
        assert analyze(tmp_path / "p.xml", tmp_path / "l.yaml").analysis.verdict == "leak"
