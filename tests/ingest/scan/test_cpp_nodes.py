"""What C++ says of nodes and channels: every alternative of a name, and a gap where nothing fixes it (rule S16)."""

from __future__ import annotations

from time import thread_time
from typing import TYPE_CHECKING, NamedTuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.ingest.scan.scan_facts import NamePiece
from tests.ingest.scan.source_code import cpp_nodes

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.ingest.scan.scan_facts import CodeFacts, CodeNode, Name

pytest.importorskip("tree_sitter_cpp", reason="without the [code] extra")

TALKER = """#include "rclcpp/rclcpp.hpp"
class Talker : public rclcpp::Node {
public:
  Talker() : Node("talker") {
BODY
  }
  std::string topic_;
  std::string other_ = "other";
};
"""
BODY_LINE = 5  # of TALKER


class Said(NamedTuple):
    """An end as a test writes it: names with ``{}`` for what is open."""

    line: int
    role: str
    names: tuple[str, ...]
    type: str = ""


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., CodeFacts]:
    def reading(**files: str) -> CodeFacts:
        for name, text in files.items():
            file = tmp_path / "src" / name.replace("__", ".")
            file.parent.mkdir(exist_ok=True)
            file.write_text(text)
        return cpp_nodes(tmp_path)

    return reading


def text(name: Name) -> str:
    return "".join("{}" if piece.text is None else piece.text for piece in name)


def ends(node: CodeNode) -> list[Said]:
    return [Said(one.place.line, one.role, tuple(map(text, one.names)), one.type) for one in node.endpoints]


def of_talker(read: Callable[..., CodeFacts], body: str) -> list[Said]:
    (node,) = read(talker__cpp=TALKER.replace("BODY", body)).nodes
    assert [text(name) for name in node.names] == ["talker"]
    return ends(node)


STRING = "std_msgs/msg/String"
PUBLISHER = "create_publisher<std_msgs::msg::String>"


@pytest.mark.parametrize(
    ("call", "end"),
    [
        ('create_publisher<std_msgs::msg::String>("a", 1);', ("publish", STRING)),
        ('this->create_subscription<std_msgs::msg::String>("a", 1, f);', ("subscribe", STRING)),
        ('create_service<std_srvs::srv::Trigger>("a", f);', ("reply", "std_srvs/srv/Trigger")),
        ('create_client<std_srvs::srv::Trigger>("a");', ("request", "std_srvs/srv/Trigger")),
        ('rclcpp_action::create_server<demo::action::Go>(this, "a", f, f, f);', ("execute", "demo/action/Go")),
        ('rclcpp_action::create_client<demo::action::Go>(this, "a");', ("call", "demo/action/Go")),
        ('rclcpp::create_publisher<std_msgs::msg::String>(*this, "a", 1);', ("publish", STRING)),
        ('create_generic_publisher("a", "std_msgs/msg/String", 1);', ("publish", STRING)),
        ('image_transport::create_subscription(this, "a", f, "raw");', ("subscribe", "sensor_msgs/msg/Image")),
        (
            'image_transport::ImageTransport it(shared_from_this()); it.advertise("a", 1);',
            ("publish", "sensor_msgs/msg/Image"),
        ),
        ('message_filters::Subscriber<std_msgs::msg::String> s(this, "a");', ("subscribe", STRING)),
        ('message_filters::Subscriber<std_msgs::msg::String> s; s.subscribe(this, "a");', ("subscribe", STRING)),
        (
            'std::make_unique<nav2_util::ServiceClient<std_srvs::srv::Empty>>("a", shared_from_this());',
            ("request", "std_srvs/srv/Empty"),
        ),
    ],
)
def test_what_makes_an_end(read: Callable[..., CodeFacts], call: str, end: tuple[str, str]) -> None:
    assert of_talker(read, call) == [Said(BODY_LINE, end[0], ("a",), end[1])]


def test_transforms_have_their_own_channels(read: Callable[..., CodeFacts]) -> None:
    body = """tf2_ros::TransformBroadcaster a(*this);
    b = std::make_shared<tf2_ros::StaticTransformBroadcaster>(this);
    tf2_ros::TransformListener c(buffer);"""
    assert [(one.line, one.role, *one.names) for one in of_talker(read, body)] == [
        (5, "publish", "/tf"),
        (6, "publish", "/tf_static"),
        (7, "subscribe", "/tf"),
        (7, "subscribe", "/tf_static"),
    ]


@pytest.mark.parametrize(
    ("before", "name", "names"),
    [
        ("", '"a" "b"', ("ab",)),
        ("", 'std::string("a") + "/" + other_', ("a/other",)),
        ('const std::string t{"a"};', "t", ("a",)),
        ('std::string t = "a"; t += "/b";', "t", ("a/b",)),
        ("", 'flag ? "a" : "b"', ("a", "b")),
        ('std::string t = "a"; if (flag) { t = "b"; }', "t", ("a", "b")),
        ('std::string t = "a"; t = "b";', "t", ("b",)),
        ('topic_ = "a";', "topic_", ("a",)),
        ('for (const auto & t : {"a", "b"})', "t", ("a", "b")),
        ('std::vector<std::string> all{"a", "b"}; for (auto t : all)', "t", ("a", "b")),
        ('std::map<std::string, int> all{{"a", 1}, {"b", 2}}; for (auto & [t, n] : all)', "t", ("a", "b")),
        ('std::map<std::string, int> all{{"a", 1}, {"b", 2}}; for (auto & e : all)', "e.first", ("a", "b")),
        ("auto same = [](std::string n) { return n; };", 'same("a")', ("a",)),
        ('declare_parameters<std::string>("x", {{"p", "a"}});', 'get_parameter("x.p").as_string()', ("a",)),
        ("for (int i = 0; i < 2; ++i)", '"a" + std::to_string(i)', ("a0", "a1")),
        ('declare_parameter("p", "a");', 'get_parameter("p").as_string()', ("a",)),
        ('declare_parameter<std::string>("p", "a"); get_parameter("p", topic_);', "topic_", ("a",)),
        ("", 'declare_parameter("p", std::string("a")) + "_raw"', ("a_raw",)),
        ("", 'std::string(get_name()) + "/a"', ("talker/a",)),
        ("", "std::getenv(x)", ("{}",)),
        ("", '"a/" + argv[1]', ("a/{}",)),
    ],
)
def test_what_a_name_can_be(read: Callable[..., CodeFacts], before: str, name: str, names: tuple[str, ...]) -> None:
    (end,) = of_talker(read, f"{before} {PUBLISHER}({name}, 1);")
    assert (end.line, end.names) == (BODY_LINE, names)


def test_a_parameter_stands_in_its_piece(read: Callable[..., CodeFacts]) -> None:
    """A launch file can set it: the default is what is known until then."""
    (node,) = read(
        a__cpp=TALKER.replace("BODY", f'declare_parameter("p", "a"); {PUBLISHER}(get_parameter("p").as_string(), 1);')
    ).nodes
    ((piece,),) = node.endpoints[0].names
    assert (piece.text, piece.basis, piece.parameter) == ("a", "default", "p")
    assert node.parameters == {"p": "a"}


def test_a_helper_gets_node_name_and_type_from_the_same_call(read: Callable[..., CodeFacts]) -> None:
    helper = """#include "rclcpp/rclcpp.hpp"
    template <typename T> class Helper {
    public:
      Helper(rclcpp::Node::SharedPtr node, std::string name) : node_(node) { client_ = node_->create_client<T>(name); }
      rclcpp::Node::SharedPtr node_;
    };"""
    body = """a_ = std::make_unique<Helper<demo::srv::A>>(shared_from_this(), "a");
    b_ = std::make_unique<Helper<demo::srv::B>>(shared_from_this(), "b");"""
    (node,) = read(helper__hpp=helper, talker__cpp=TALKER.replace("BODY", body)).nodes
    assert ends(node) == [Said(4, "request", ("a",), "demo/srv/A"), Said(4, "request", ("b",), "demo/srv/B")]


def test_a_class_in_a_header_with_methods_in_another_file_and_a_base_class(read: Callable[..., CodeFacts]) -> None:
    """The ends of a base stand at their call, in each class that is derived from it."""
    base = """class Base : public rclcpp::Node {
    public:
      explicit Base(const std::string & name, std::string topic = "default") : rclcpp::Node(name), topic_(topic) {}
      void start();
      std::string topic_;
    };
    class Left : public Base { public: Left() : Base("left", "left_topic") {} };
    class Right : public Base { public: Right() : Base("right") {} };"""
    code = f"void Base::start() {{ {PUBLISHER}(topic_, 1); }}"
    left, right = read(base__hpp=base, base__cpp=code).nodes
    assert (left.name, [text(one) for one in left.names], [one.names for one in ends(left)]) == (
        "Left",
        ["left"],
        [("left_topic",)],
    )
    assert (right.name, [text(one) for one in right.names], [one.names for one in ends(right)]) == (
        "Right",
        ["right"],
        [("default",)],
    )


def test_names_that_callers_hand_to_a_constructor(read: Callable[..., CodeFacts]) -> None:
    code = f"""class Camera : public rclcpp::Node {{
    public:
      Camera(std::string name, std::string topic) : Node(name) {{ {PUBLISHER}(topic, 1); }}
    }};
    int main() {{ spin(std::make_shared<Camera>("left", "l")); spin(std::make_shared<Camera>("right", "r")); }}"""
    (node,) = read(a__cpp=code).nodes
    assert ([text(one) for one in node.names], [one.names for one in ends(node)]) == (["left", "right"], [("l", "r")])


def test_a_node_without_a_class_is_one_of_its_function(read: Callable[..., CodeFacts]) -> None:
    code = f"""#include <rclcpp/rclcpp.hpp>
    void add(rclcpp::Node & node) {{ node.{PUBLISHER}("b", 1); }}
    int main() {{
      auto node = rclcpp::Node::make_shared("plain");
      node->{PUBLISHER}("a", 1);
      add(*node);
    }}"""
    (node,) = read(a__cpp=code).nodes
    assert (node.place.line, node.name, [text(one) for one in node.names]) == (4, "main", ["plain"])
    assert [(one.line, *one.names) for one in ends(node)] == [(2, "b"), (5, "a")]


def test_components_controllers_and_lifecycle_nodes(read: Callable[..., CodeFacts]) -> None:
    code = f"""namespace demo {{
    class A : public rclcpp_lifecycle::LifecycleNode {{
      A(const rclcpp::NodeOptions & o) : LifecycleNode("a", o) {{}}
    }};
    class B : public controller_interface::ControllerInterface {{
      void on_configure() {{ get_node()->{PUBLISHER}("~/b", 1); }}
    }};
    }}
    RCLCPP_COMPONENTS_REGISTER_NODE(demo::A)
    PLUGINLIB_EXPORT_CLASS(demo::B, controller_interface::ControllerInterface)"""
    a, b = read(a__cpp=code).nodes
    assert (a.plugin, [text(one) for one in a.names]) == ("demo::A", ["a"])
    assert (b.plugin, b.names, [one.names for one in ends(b)]) == ("demo::B", (), [("~/b",)])


@pytest.mark.parametrize(
    ("declared", "written"),
    [
        ("using std_msgs::msg::String;", "String"),
        ("using Words = std_msgs::msg::String;", "Words"),
        ("namespace sm = std_msgs::msg;", "sm::String"),
        ("typedef std_msgs::msg::String Words;", "Words"),
        ("using namespace std_msgs::msg;", "String"),
    ],
)
def test_types_by_other_names(read: Callable[..., CodeFacts], declared: str, written: str) -> None:
    code = TALKER.replace("BODY", f'create_publisher<{written}>("a", 1);')
    (node,) = read(names__hpp=declared, talker__cpp=f"{declared}\n{code}").nodes
    assert ends(node)[0].type == STRING


def test_a_second_argument_of_a_base_that_is_not_there_is_no_namespace(read: Callable[..., CodeFacts]) -> None:
    text = """class Arm : public vendor::Driver {
    public: Arm() : vendor::Driver("arm", "left") { create_publisher<std_msgs::msg::String>("state", 1); } };
    int main() { auto arm = std::make_shared<Arm>(); }"""
    (node,) = read(arm__cpp=text).nodes
    assert (node.names, node.namespaces) == (((NamePiece("arm", "guessed"),),), ())


def test_a_node_from_outside_is_a_gap_and_its_ends_are_kept(read: Callable[..., CodeFacts]) -> None:
    code = f"""#include <rclcpp/rclcpp.hpp>
    struct Layer : public other::Plugin {{ void start(rclcpp::Node * node) {{ node->{PUBLISHER}("a", 1); }} }};"""
    facts = read(a__cpp=code)
    assert [(gap.place.line, gap.sort) for gap in facts.gaps] == [(2, "node-of")]
    assert [(node.name, node.names, [one.names for one in ends(node)]) for node in facts.nodes] == [
        ("Layer", (), [("a",)])
    ]


def test_a_method_of_the_checkout_with_the_same_name_is_no_end(read: Callable[..., CodeFacts]) -> None:
    code = f"""#include <rclcpp/rclcpp.hpp>
    struct Led {{
      void create_publisher(rclcpp::Node::SharedPtr node, std::string topic) {{ node->{PUBLISHER}(topic, 1); }}
    }};
    class Leds : public rclcpp::Node {{
      Leds() : Node("leds") {{ led_->create_publisher(shared_from_this(), "a"); }}
      std::shared_ptr<Led> led_;
    }};"""
    (node,) = read(a__cpp=code).nodes
    assert [(one.line, *one.names) for one in ends(node)] == [(3, "a")]


@pytest.mark.parametrize(
    "code",
    [
        '#define MAKE(T) create_publisher<T>("a", 1)\n',
        f'void f() {{\n  }} ) ] {PUBLISHER}("a" 1);\n',
    ],
)
def test_what_cannot_be_read_is_a_gap_at_its_line(read: Callable[..., CodeFacts], code: str) -> None:
    facts = read(a__cpp=f"#include <rclcpp/rclcpp.hpp>\n{code}")
    line = 2 if "#define" in code else 3
    lines = {gap.place.line for gap in facts.gaps} | {end.line for node in facts.nodes for end in ends(node)}
    assert line in lines


def test_a_window_of_qt_is_read_as_any_node(read: Callable[..., CodeFacts]) -> None:
    code = """class Panel : public QObject, public rclcpp::Node {
      Q_OBJECT
      Q_PROPERTY(bool shown READ shown)
    public:
      Panel() : QObject(), rclcpp::Node("panel") {
        heard_ = create_subscription<Image>("faces", 10, [this](Image::SharedPtr image) { emit shown(image->width); });
      }
    signals:
      void shown(int width);
    private slots:
      void close() { closed_ = create_publisher<Image>("closed", 10); }
    };
    """
    facts = read(panel__cpp=code)
    assert [[piece.text for piece in name] for node in facts.nodes for name in node.names] == [["panel"]]
    assert sorted(end.role for node in facts.nodes for end in node.endpoints) == ["publish", "subscribe"]
    assert [end.place.line for node in facts.nodes for end in node.endpoints] == [6, 11]
    assert facts.gaps == ()


def test_code_of_ros_1_is_not_read(read: Callable[..., CodeFacts]) -> None:
    code = '#include <ros/ros.h>\nint main() { ros::NodeHandle n; n.advertise<std_msgs::String>("a", 1); }'
    assert read(a__cpp=code) == ((), ())


PIECES = [
    *("{", "}", ";", "(", ")", '"text"', "topic", "+", "this->", "t", ",", "if (x)", "=", "<", ">", "\n", "/*", '"'),
    *("class A : public rclcpp::Node {", "A() : Node(name)", "template <typename T>", "struct t : t {", "using A = A;"),
    *("std::string t = ", "for (auto t : t)", "return t;", "auto f = [&](std::string t)", "t += t;", "operator+"),
    *("A(t)", "std::make_shared<A>(t)", "#define t t", "get_parameter(t, t)", "declare_parameter(t, t)", PUBLISHER),
]


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(pieces=st.lists(st.sampled_from(PIECES), max_size=60))
def test_no_text_makes_it_fail(tmp_path: Path, pieces: list[str]) -> None:
    (tmp_path / "a.cpp").write_text("#include <rclcpp/rclcpp.hpp>\n" + " ".join(pieces))
    facts = cpp_nodes(tmp_path)
    assert facts == cpp_nodes(tmp_path)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    names=st.lists(
        st.sampled_from(['"a"', "t", "f(t)", "argv[1]", "topic_", '"a" + t', "T::x", "t[0]", "{}"]),
        min_size=1,
        max_size=8,
    )
)
def test_each_call_is_an_end_or_a_gap(tmp_path: Path, names: list[str]) -> None:
    calls = [f"    {PUBLISHER}({name}, 1);" for name in names]
    (tmp_path / "a.cpp").write_text(TALKER.replace("BODY", "\n".join(calls)))
    facts = cpp_nodes(tmp_path)
    places = {end.place.line for node in facts.nodes for end in node.endpoints if end.names}
    places |= {gap.place.line for gap in facts.gaps}
    assert places >= set(range(BODY_LINE, BODY_LINE + len(names)))


def test_helpers_that_call_each_other_for_ever_end(read: Callable[..., CodeFacts]) -> None:
    chain = "\n".join(
        f"std::string f{at}(std::string t) {{ return f{(at + 1) % 50}(t + t) + f{at}(t); }}" for at in range(50)
    )
    facts = read(a__cpp=f"{chain}\n{TALKER.replace('BODY', f'{PUBLISHER}(f0(other_), 1);')}")
    assert any(gap.sort == "name" for gap in facts.gaps) or any(ends(node) for node in facts.nodes)


def test_a_value_that_a_call_gives_back_by_reference(read: Callable[..., CodeFacts]) -> None:
    helper = """template <typename T> void load(rclcpp::Node * node, const std::string & name, T value, T & result) {
      node->declare_parameter(name, value);
      node->get_parameter(name, result);
    }"""
    body = f'load<std::string>(this, "p", "a", topic_); {PUBLISHER}(topic_, 1);'
    (node,) = read(talker__cpp=f"{helper}\n{TALKER.replace('BODY', body)}").nodes
    ((piece,),) = node.endpoints[0].names
    assert (piece.text, piece.basis, piece.parameter) == ("a", "default", "p")


def test_links_and_places_are_below_the_root(read: Callable[..., CodeFacts]) -> None:
    facts = read(talker__cpp=TALKER.replace("BODY", f'{PUBLISHER}("a", 1);'))
    assert {node.place.file for node in facts.nodes} == {"src/talker.cpp"}


def test_time_grows_with_the_code(tmp_path: Path) -> None:
    """Twice the packages take about twice the processor time, though all have the same names."""

    def seconds(count: int) -> float:
        root = tmp_path / str(count)
        for number in range(count):
            folder = root / f"p{number}" / "src"
            folder.mkdir(parents=True)
            (folder / "talker.cpp").write_text(TALKER.replace("BODY", f'topic_ = "a"; {PUBLISHER}(topic_, 1);'))
        begun = thread_time()
        assert len(cpp_nodes(root).nodes) == count
        return thread_time() - begun

    seconds(10)
    assert seconds(400) < 10 * seconds(100)
