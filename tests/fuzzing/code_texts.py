"""Choices -> source code with annotations: good and odd ones, at calls, classes and nothing, in Python and C++."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.fuzzing.words import KINDS, ODD_TEXT

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

NAMES = ("image", "/a", "~/b", "c/d", "/x y", "{node}/a", "", "~", "a\\n")
OF_NODES = ("source", "leak", "sanitizer", "conduit", "derives")
OF_CHANNELS = ("mundane", "sensitive", "only", "never")
RESTS = ("", "none", "Video drop", "Video -> FaceTemplate", "Video through /a, /b/*", "Video,", "anonymise")
SIGNS = ("privacy: ", "privacy(/n): ", "privacy(/a/*):", "privacy(=/*): ", "Privacy: ", "privacy ", "see privacy: ", "")
PYTHON = (
    "class {}(Node):  {}", "    def f(self):  {1}", "        super().__init__({0!r}) {1}",
    "        self.create_publisher(Image, {0!r}, 1)  {1}", "        {1}", "        n = rclpy.create_node({0!r})",
    "        n.create_service(S, {0!r}, f) {1}", "        ActionClient(self, A, {0!r}); f()  {1}", "",
    "        x = '''{1}", "        '''", "\tx = (", "# -*- coding: {0} -*-",
)  # fmt: skip
CPP = (
    "class K : public rclcpp::Node {{ {1}", 'K() : Node("{0}") {{ {1}', "}};", "}}", "{1}", "",
    'create_publisher<sensor_msgs::msg::Image>("{0}", 1); {1}', 'rclcpp_action::create_client<A>(this, R"({0})"); {1}',
    'void K::f() {{ n->create_service<S>("{0}" /* {1} */, g);', "#define X {1}", "#if 0 {1}", 'auto s = R"x({1}',
    ')x";', "/* {1}", " * {1}", "*/", 'auto n = std::make_shared<rclcpp::Node>("{0}"); {1} \\', 'x = "{1};',
    "using sensor_msgs::msg::Image;", "template<typename T>",
)  # fmt: skip


def python(choices: Choices) -> dict[str, str | bytes]:
    """A Python file that is read more often than not."""
    head = ["class K(Node):", "    def f(self):", "        super().__init__('k')"]
    good = choices.below(3)
    lines = [*head, *(_line(choices, PYTHON[3:8:1] if good else PYTHON, "#", good) for _ in range(choices.below(8)))]
    return {"a.py": _file(choices, lines)}


def cpp(choices: Choices) -> dict[str, str | bytes]:
    """A C++ file, whole or not."""
    head = ["class K : public rclcpp::Node {", 'K() : Node("k") {']
    good = choices.below(3)
    lines = [*head, *(_line(choices, CPP[6:9:2] if good else CPP, "//", good) for _ in range(choices.below(8)))]
    return {"a.cpp": _file(choices, [*lines, "}", "};"])}


def _line(choices: Choices, shapes: tuple[str, ...], sign: str, good: int) -> str:
    name = choices.pick(NAMES[:3] if good else NAMES)
    name = choices.pick(ODD_TEXT) if choices.once_in(20) else name
    return choices.pick(shapes).format(name, _comment(choices, sign, good))


def _comment(choices: Choices, sign: str, good: int) -> str:
    if good:
        return f"{sign} privacy: only Video" if choices.below(2) else f"{sign} privacy(/n{choices.below(9)}): conduit"
    word = choices.pick((*OF_NODES, *OF_CHANNELS, "note", "sorce"))
    rest = choices.pick(RESTS) if choices.below(2) else ", ".join(choices.some(KINDS))
    rest = choices.pick(ODD_TEXT) if choices.once_in(10) else rest
    return f"{sign} {choices.pick(SIGNS)}{word} {rest}"


def _file(choices: Choices, lines: list[str]) -> bytes:
    end = "\r\n" if choices.once_in(6) else "\r" if choices.once_in(9) else "\n"
    return end.join([*lines, ""]).encode("utf-8", "surrogatepass")
