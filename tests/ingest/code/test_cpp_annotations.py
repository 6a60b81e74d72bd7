"""What annotations in C++ are about, by tree-sitter's grammar (rule S11: or an error)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy import analyze
from rosprivacy.ingest.code.annotated_elements import attach, label_text
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ontology.vocabulary import load
from tests.helpers.annotated import said_by

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("tree_sitter_cpp", reason="without the [code] extra")

POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/a"><profiles><profile ns="/" node="a"><topics publish="ALLOW">{}</topics></profile></profiles></enclave>
<enclave path="/o"><profiles>
<profile ns="/" node="out"><topics subscribe="ALLOW">{}</topics></profile></profiles></enclave>
</enclaves></policy>
"""
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
    found, problems = said_by(("a.hpp", HEADER), ("b.cpp", SOURCE))
    assert problems == []
    assert found == [
        ("nodes", "/front/camera", 1),
        ("topics", "/front/a", 3),
        ("topics", "/front/image", 6),
        ("nodes", "/front/camera", 7),
        ("nodes", "/front/camera", 10),
        ("topics", "/front/image", 10),
        ("services", "/front/camera/s", 11),
        ("nodes", "/front/camera", 12),
        ("actions", "/act", 13),
        ("nodes", "/tool", 17),
        ("topics", "/t", 18),
        ("nodes", "/other", 19),
    ]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
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
    ],
)  # fmt: skip
def test_what_is_attached_to_nothing_or_guessed_is_told(text: str, problem: str) -> None:
    found, problems = said_by(("a.cpp", text.encode("utf-8", "replace").decode()))
    assert (found, len(problems)) == ([], 1)
    assert problem in problems[0]
    assert problems[0].isprintable()


def test_two_classes_of_one_name_are_not_guessed() -> None:
    one, two = (f'A::A() : rclcpp::Node("{name}") {{}}' for name in "xy")
    head = "// privacy: conduit\nclass A : public rclcpp::Node {};"
    found, problems = said_by(("a.hpp", head), ("a.cpp", one), ("b.cpp", two))
    assert (found, len(problems)) == ([], 1)
    assert said_by(("a.hpp", head + "\n" + one), ("b.cpp", two)) == ([("nodes", "/x", 1)], [])


def test_a_delegating_constructor_is_no_other_name() -> None:
    text = 'class A : public rclcpp::Node { // privacy: conduit\n A() : A("x") {}\n A(S n) : Node("a") {} };'
    assert said_by(("a.cpp", text)) == ([("nodes", "/a", 1)], [])


def test_strings_are_no_comments() -> None:
    text = 'auto a = "// privacy: leak Voice";\nauto b = R"x(\n// privacy: leak Voice\n)x";\nchar c = \'"\'; // fine\n'
    assert said_by(("a.cpp", text)) == ([], [])


def test_a_comment_goes_on_behind_a_backslash() -> None:
    text = '// said \\\nprivacy: mundane\nvoid f() { n->create_publisher<I>("a", 1); }\n'
    assert said_by(("a.cpp", text)) == ([("topics", "/a", 2)], [])


@pytest.mark.parametrize("data", [b"", b"\xff\xfe\0\0", b"{" * 50_000, b"#if 0\n" * 2000, b"a<" * 20_000, b"/*" * 9])
def test_what_is_no_cpp_says_nothing_and_ends(data: bytes) -> None:
    code = read_cpp("a.cpp", data)
    assert code.problems == ()


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
