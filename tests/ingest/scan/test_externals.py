"""Things outside ROS that code exchanges data with: which, of what sort, where, and never a key or a password."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ingest.scan.outside.externals import host_of, read_externals
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from rosprivacy.ingest.scan.outside.externals import CodeExternals

RULES = read_library_rules((), load())[0]
HEAD = "from rclpy.node import Node\n"


def read(text: str, file: str = "n.py") -> CodeExternals:
    code = (read_cpp if file.endswith("pp") else read_python)(file, text.encode())
    return read_externals([code], RULES, {file: file})


def sorts(text: str, file: str = "n.py") -> list[tuple[str, int, str, str]]:
    """(class or function, line, sort, name) of what is found."""
    return [(u.unit, u.external.place.line, u.external.sort, u.external.name) for u in read(text, file).units]


@pytest.mark.parametrize(
    ("module", "line", "sort", "name"),
    [
        ("requests", "requests.post('https://api.example.com/v1?key=k', json={})", "cloud", "api.example.com"),
        ("requests", "requests.post('http://192.168.0.9:80/x')", "http", "192.168.0.9"),
        ("requests", "requests.post(self.url)", "http", "requests"),
        ("requests", "requests.post('https://api.openai.com/v1/chat')", "language-model", "api.openai.com"),
        ("openai", "self.c = openai.OpenAI(api_key='sk-1')", "language-model", "openai"),
        ("requests", "requests.post('http://localhost:11434/api/chat')", "language-model", "localhost"),
        ("paho.mqtt.client as mqtt", "self.c = mqtt.Client(); self.c.publish('x', 'y')", "broker", "paho"),
        ("websockets", "websockets.connect('wss://hub.example.com/ws')", "socket", "hub.example.com"),
        ("socket", "self.s = socket.socket()", "socket", "socket"),
        ("sqlite3", "self.db = sqlite3.connect('people.db')", "database", "sqlite3"),
        ("json", "json.dump({}, open('x', 'w'))", "file", "json"),
        ("os", "self.path.open('a')", "file", "pathlib"),
        ("cv2", "cv2.imshow('w', 1)", "screen", "cv2"),
        ("pyttsx3", "self.e = pyttsx3.init()", "speech", "pyttsx3"),
        ("playsound", "playsound.playsound('a.mp3')", "loudspeaker", "playsound"),
        ("flask", "self.app = flask.Flask('x')", "web-server", "flask"),
        ("subprocess", "subprocess.run(['tegrastats'])", "process", "tegrastats"),
        ("subprocess", "subprocess.run(self.command)", "process", "another program"),
        ("boto3", "boto3.client('s3')", "cloud", "boto3"),
        ("google.cloud.vision", "google.cloud.vision.ImageAnnotatorClient()", "vision", "google.cloud.vision"),
        ("gtts", "gtts.gTTS('x')", "speech", "gtts"),
        ("os", "self.go(f'{self.prefix}/v2/{self.maker}/{self.serial}/order')", "broker", "vda5050"),
        ("os", "self.go('uagv/v3/acme/' + self.serial + '/' + 'instantActions')", "broker", "vda5050"),
    ],
)  # fmt: skip
def test_the_use_of_a_library_is_a_thing_outside(module: str, line: str, sort: str, name: str) -> None:
    text = f"import {module}\n{HEAD}class N(Node):\n    def go(self):\n        {line}\n"
    assert sorts(text) == [("N", 5, sort, name)]


@pytest.mark.parametrize(
    ("code", "sort", "name"),
    [
        ('std::ofstream out("x");', "file", "std::ofstream"),
        ("CURL* c = curl_easy_init();", "http", "curl_easy"),
        ('cv::imshow("w", image);', "screen", "cv::imshow"),
        ('sqlite3_open("x", &db);', "database", "sqlite3"),
        ("int s = socket(AF_INET, SOCK_DGRAM, 0);", "socket", "socket"),
        ("boost::asio::ip::tcp::socket s(io);", "socket", "boost::asio"),
        ('mqtt::async_client c("tcp://x", "id");', "broker", "mqtt"),
        ('system("tegrastats");', "process", "tegrastats"),
        ('subscribe("uagv/v2/acme/7/state");', "broker", "vda5050"),
        ('popen(command, "r");', "process", "another program"),
    ],
)  # fmt: skip
def test_in_cpp_too(code: str, sort: str, name: str) -> None:
    text = f"#include <x>\nclass N : public rclcpp::Node {{\n  void go() {{\n    {code}\n  }}\n}};\n"
    assert sorts(text, "n.cpp") == [("N", 4, sort, name)]


def test_a_thing_stands_once_in_a_class_at_its_first_line_and_knows_its_directions() -> None:
    text = "import whisper, requests\nclass A:\n  def a(self):\n    self.m = whisper.load_model('b')\n"
    text += "    self.m.transcribe(1)\n    requests.get('https://a.example.com')\n    requests.post('https://a.example.com')\n"
    heard, asked = (one.external for one in read(text).units)
    assert (heard.place.line, heard.sort, heard.incoming, heard.outgoing) == (4, "speech", True, False)
    assert (asked.place.line, asked.name, asked.incoming, asked.outgoing) == (6, "a.example.com", True, True)
    assert not asked.stated


def test_what_only_names_a_library_is_none() -> None:
    text = "import requests, subprocess, cv2\ndef f():\n    try: g()\n    except requests.HTTPError: pass\n"
    assert sorts(text + "    except subprocess.TimeoutExpired: pass\n    x = 'http://www.w3.org/1999'\n") == []


def test_a_program_of_ros_is_a_gap_and_a_recording_a_process() -> None:
    text = "from launch.actions import ExecuteProcess\ndef generate_launch_description():\n"
    text += (
        "    ExecuteProcess(cmd=['ros2', 'run', 'p', 'x'])\n    ExecuteProcess(cmd=['ros2', 'bag', 'record', '-a'])\n"
    )
    made = read(text, "x.launch.py")
    assert [(gap.place.line, gap.sort) for gap in made.gaps] == [(3, "started")]
    assert [(one.external.place.line, one.external.name) for one in made.units] == [(4, "ros2 bag record")]


def test_a_recording_that_code_starts_takes_what_nobody_has_read() -> None:
    made = read("import subprocess\ndef f():\n    subprocess.Popen(['ros2', 'bag', 'record', '-a'])\n")
    assert [(gap.place.line, gap.sort) for gap in made.gaps] == [(3, "started")]
    assert [one.external.name for one in made.units] == ["ros2 bag record"]


@pytest.mark.parametrize("call", ["__import__('boto3').client('s3')", "importlib.import_module(name)", "exec(text)"])
def test_a_library_that_is_named_as_the_code_runs_is_a_gap(call: str) -> None:
    made = read(f"import importlib\ndef f(name, text):\n    {call}\n")
    assert [(gap.place.line, gap.sort) for gap in made.gaps] == [(3, "outside")]


def test_what_is_only_called_like_it_is_none() -> None:
    assert read("import executor\ndef f(model):\n    executor.eval(model)\n    model.eval()\n").gaps == ()


def test_files_without_a_name_are_left_out() -> None:
    code = read_python("n.py", b"import flask\nflask.Flask('x')\n")
    assert read_externals([code], RULES, {}).units == ()


SECRET = st.text("abcdefghijklmnopqrstuvwxyz0123456789", min_size=8, max_size=12).map(lambda text: f"zq{text}")


@given(SECRET, SECRET, SECRET)
def test_no_user_password_path_or_query_gets_out(user: str, password: str, key: str) -> None:
    address = f"https://{user}:{password}@api.example.com/{key}?token={key}#{key}"
    code = f"import requests\ndef f():\n    requests.post('{address}', headers={{'Authorization': '{key}'}})\n"
    told = repr(read(code))
    assert "api.example.com" in told
    assert not any(secret in told for secret in (user, password, key))


@given(st.text())
def test_a_host_is_plain_and_never_fails(address: str) -> None:
    host = host_of(address)
    assert all(sign.isalnum() or sign in ".-_:" for sign in host)
