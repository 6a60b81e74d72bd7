"""Log calls with data of channels, or with what was recognised: which, where, and of which channel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.scan.outside.log_calls import with_logs
from rosprivacy.ingest.scan.scan_facts import CodeEndpoint, CodeNode, CodePlace, NamePiece
from tests.ingest.scan.source_code import source_trees

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.scan.outside.log_calls import FileLogs

PYTHON = """\
import whisper, functools, json, logging
from rclpy.node import Node
class N(Node):
    def __init__(self):
        super().__init__('n')
        self.create_subscription(String, '/words', self.heard, 10)
        self.create_service(Say, '/say', {callback})
        self.model = whisper.load_model('base')
        self.people = []
    def heard(self, msg):
        {heard}
    def say(self, request, response):
        {say}
    def more(self):
        {more}
    def show(self, text):
        {show}
"""
WORDS, SAY, RECOGNISED = 6, 7, "recognised"  # lines of the ends of channels
LINES = {"heard": 11, "say": 13, "more": 15, "show": 17}
CPP = """\
#include <rclcpp/rclcpp.hpp>
class N : public rclcpp::Node {
public:
  N() : Node("n") {
    a_ = create_subscription<String>("/words", 10, std::bind(&N::heard, this, std::placeholders::_1));
    b_ = create_subscription<String>("/b", 10, [this](const String::SharedPtr msg) { CALLBACK });
  }
  void heard(const String::SharedPtr msg) { HEARD }
  void more() { MORE }
  void show(const std::string & text) { SHOW }
  std::string last_;
};
"""
CPP_LINES = {"CALLBACK": 6, "HEARD": 8, "MORE": 9, "SHOW": 10}


def logs(folder: Path, name: str, text: str) -> list[FileLogs]:
    (folder / name).write_text(text, "utf-8")
    return source_trees(folder).logs


def python(folder: Path, **pieces: str) -> list[tuple[int, list[object], str]]:
    """(line, lines of ends or 'recognised', words) of the log calls."""
    whole = {"callback": "self.say", **dict.fromkeys(LINES, "pass"), **pieces}
    return told(logs(folder, "n.py", PYTHON.format(**whole)))


def cpp(folder: Path, **pieces: str) -> list[tuple[int, list[object], str]]:
    text = CPP
    for key in CPP_LINES:
        text = text.replace(key, pieces.get(key, ""))
    return told(logs(folder, "n.cpp", text))


def told(files: list[FileLogs]) -> list[tuple[int, list[object], str]]:
    return [
        (one.line, [RECOGNISED if origin.recognised else origin.line for origin in one.origins], one.words)
        for file in files
        for one in file.values
    ]


@pytest.mark.parametrize(
    "call",
    [
        "self.get_logger().info(f'Heard: {msg.data}')",
        "self.get_logger().warn('Heard: %s' % msg.data)",
        "self.get_logger().error('Heard: {}'.format(msg.data))",
        "self.get_logger().debug('Heard: ' + str(msg.data))",
        "self.get_logger().fatal(msg.data, once=True)",
        "print('Heard', msg.data)",
        "logging.getLogger('x').info('%s', msg.data)",
        "logging.info('%s', msg.data)",
        "self.logger.info(msg.data)",
        "log.warning(msg.data if x else '')",
    ],
)
def test_a_field_of_a_message_in_a_log(tmp_path: Path, call: str) -> None:
    assert python(tmp_path, heard=call) == [(LINES["heard"], [WORDS], "msg.data")]


@pytest.mark.parametrize(
    ("pieces", "line", "words"),
    [
        ({"heard": "self.last = msg.data", "more": "print(self.last)"}, "more", "self.last"),
        ({"heard": "self.people.append(msg.data)", "more": "for p in self.people: print(p)"}, "more", "p"),
        ({"heard": "self.show(msg.data)", "show": "print(text)"}, "show", "text"),
        ({"heard": "self.last = json.loads(msg.data)", "more": "print(self.last['name'])"}, "more", "self.last"),
        ({"heard": "a, b = 1, msg.data; print(a); print(b)"}, "heard", "b"),
        ({"heard": "self.fill(msg, self.people)\n    def fill(self, m, into): into.append(m.data)",
          "more": "print(self.people)"}, "", "self.people"),
    ],
)  # fmt: skip
def test_what_a_message_said_is_followed(tmp_path: Path, pieces: dict[str, str], line: str, words: str) -> None:
    (made,) = python(tmp_path, **pieces)
    assert made[1:] == ([WORDS], words)
    assert not line or made[0] == LINES[line]


@pytest.mark.parametrize(
    ("callback", "words"),
    [
        ("self.say", "request.text"),
        ("functools.partial(self.say, 1)", ""),
        ("lambda request, response: print(request.text)", "request.text"),
    ],
)
def test_requests_of_a_service(tmp_path: Path, callback: str, words: str) -> None:
    found = python(tmp_path, callback=callback, say="print(request.text)" if "lambda" not in callback else "pass")
    assert found == ([(SAY if "lambda" in callback else LINES["say"], [SAY], words)] if words else [])


def test_what_was_recognised(tmp_path: Path) -> None:
    found = python(tmp_path, more="text = self.model.transcribe('a.wav')['text']; self.get_logger().info(text)")
    assert found == [(LINES["more"], [RECOGNISED, RECOGNISED], "text")]


@pytest.mark.parametrize(
    "call",
    [
        "self.get_logger().info('heard something')",
        "print(len(msg.data))",
        "print(msg.data == 'x')",
        "print(msg.header.frame_id)",
        "self.publisher.publish(msg)",
        "other = 1; print(other)",
    ],
)
def test_what_says_nothing_of_it_is_no_log_of_it(tmp_path: Path, call: str) -> None:
    assert python(tmp_path, heard=call) == []


@pytest.mark.parametrize(
    ("pieces", "at", "words"),
    [
        ({"HEARD": 'RCLCPP_INFO(get_logger(), "%s", msg->data.c_str());'}, "HEARD", "msg.data"),
        ({"HEARD": 'RCLCPP_WARN_STREAM(this->get_logger(), "heard " << msg->data);'}, "HEARD", "msg.data"),
        ({"HEARD": 'RCLCPP_ERROR_THROTTLE(get_logger(), *clock, 1000, "%s", msg->data.c_str());'}, "HEARD", "msg.data"),
        ({"HEARD": "std::cout << msg->data << std::endl;"}, "HEARD", "msg.data"),
        ({"HEARD": 'printf("%s", msg->data.c_str());'}, "HEARD", "msg.data"),
        ({"HEARD": 'spdlog::info("{}", msg->data);'}, "HEARD", "msg.data"),
        ({"HEARD": "last_ = msg->data;", "MORE": "std::cerr << last_;"}, "MORE", "last_"),
        ({"HEARD": "show(msg->data);", "SHOW": "std::cout << text;"}, "SHOW", "text"),
        ({"HEARD": "for (const auto & p : msg->people) { std::cout << p.name; }"}, "HEARD", "p.name"),
        ({"HEARD": "tf2::fromMsg(msg->pose, pose); std::cout << pose;"}, "HEARD", "pose"),
    ],
)
def test_in_cpp_too(tmp_path: Path, pieces: dict[str, str], at: str, words: str) -> None:
    assert [(line, ends) for line, ends, _ in cpp(tmp_path, **pieces)] == [(CPP_LINES[at], [5])]
    assert words in cpp(tmp_path, **pieces)[0][2]


def test_a_lambda_and_what_says_nothing_in_cpp(tmp_path: Path) -> None:
    assert cpp(tmp_path, CALLBACK="std::cout << msg->data;") == [(6, [6], "msg.data")]
    quiet = 'RCLCPP_INFO(get_logger(), "got one"); std::cout << msg->data.size(); int x = 1; std::cout << x;'
    assert cpp(tmp_path, HEARD=quiet) == []


def test_a_log_call_names_the_channels_of_its_node(tmp_path: Path) -> None:
    text = PYTHON.format(callback="self.say", heard="print(msg.data)", say="pass", more="pass", show="pass")
    found = logs(tmp_path, "n.py", text)
    words = (NamePiece("/words"),)
    end = CodeEndpoint(CodePlace("n.py", WORDS), "subscribe", (words,))
    node = CodeNode(CodePlace("n.py", 3), "N", "python", ((NamePiece("n"),),), endpoints=(end,))
    (whole,) = with_logs([node], found)
    assert [(one.place.line, one.channels, one.words) for one in whole.logs] == [(LINES["heard"], (words,), "msg.data")]
    (other,) = with_logs([node._replace(endpoints=())], found)
    assert other.logs == ()


@given(st.text(), st.sampled_from(["n.py", "n.cpp"]))
def test_no_text_makes_it_fail(tmp_path_factory: pytest.TempPathFactory, text: str, name: str) -> None:
    folder = tmp_path_factory.mktemp("any")
    file = folder / name
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    source_trees(folder)
