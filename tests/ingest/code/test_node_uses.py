"""What the code of nodes uses: names as imports resolve them, and whose they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.code.node_uses import node_uses
from rosprivacy.ingest.code.source_files import read_sources

if TYPE_CHECKING:
    from pathlib import Path

NODE = "from rclpy.node import Node\n"
CLASS = "class {0}(Node):\n    def __init__(self):\n        super().__init__('{1}')\n        {2}\n"
SETUP = "from setuptools import setup\nsetup(name='p', entry_points={'console_scripts': ['eye = p.camera:main']})\n"
LAUNCH = (
    "from launch_ros.actions import Node\nx = [Node(package='p', executable='{}', name='front'),\n"
    "     Node(package='p', executable='eye', name=NAME)]\n"
)
LONGEST_NAME = 100


def uses(folder: Path, **files: str) -> dict[str, list[str]]:
    """Write files (``a__b_py`` is a/b.py) and return what nodes use, and under '' what belongs to none."""
    for name, text in files.items():
        stem, _, ending = name.rpartition("_")
        path = folder / f"{stem.replace('__', '/')}.{ending}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    found = node_uses(read_sources([str(folder)]).codes)
    told = {name: [use.name for use in own if not use.name.startswith("rcl")] for name, own in found.of_nodes.items()}
    left = [use.name for use in found.without_node if not use.name.startswith(("rcl", "setuptools", "launch"))]
    return {**told, **({"": left} if left else {})}


def node(name: str = "n", line: str = "pass", of: str = "N") -> str:
    return CLASS.format(of, name, line)


@pytest.mark.parametrize(
    ("code", "name"),
    [
        ("import cv2\n" + NODE + node(line="cv2.VideoCapture(0)"), "cv2.VideoCapture"),
        ("import cv2\nfrom rclpy.node import Node as B\n" + node(line="cv2.x").replace("(Node)", "(B)"), "cv2.x"),
        ("import cv2 as c\n" + NODE + node(line="self.x = c.VideoCapture(0)"), "cv2.VideoCapture"),
        ("from cv2 import VideoCapture as V\n" + NODE + node(line="V(0)"), "cv2.VideoCapture"),
        ("import a.b.c\n" + NODE + node(line="x = [a.b.c.d() for _ in y]"), "a.b.c.d"),
        ("import sr\n" + NODE + node(line="with sr.Mic() as m: m.listen()"), "sr.Mic.listen"),
        ("import mq\n" + NODE + node(line="self.c = mq.Client(); self.c.publish('x')"), "mq.Client.publish"),
        ("import mq\n" + NODE + node(line="y = mq.A() if x else 0; self.run(target=mq.loop)"), "mq.loop"),
        ("import mq\n" + NODE + node(line="self.c = None; self.c = mq.Client(); self.c.go('x')"), "mq.Client.go"),
        ("from gui import *\n" + NODE + node(line="root = Tk(); root.title('x')"), "gui.Tk.title"),
        (NODE + node(line="go('https://a.b/c?key=d')"), "@ https://a.b/c"),
        (NODE + node(line="go(f'http://{host}:1/x/{y}')"), "@ http://{}:1/x/{}"),
        (NODE + node(line="import sr; self.sr = sr; self.r = self.sr.Mic(); self.r.listen()"), "sr.Mic.listen"),
        (NODE + node(line="open('f', 'w').write('x')"), "open(w)"),
        (NODE + node(line="open('f', mode='ab')"), "open(w)"),
        (NODE + node(line="open('f')"), "open"),
        ("from pathlib import Path\n" + NODE + node(line="Path('f').open('w')"), "pathlib.Path.open(w)"),
        ("import pa\n" + NODE + node(line="pa.PyAudio().open(rate=1, input=True)"), "pa.PyAudio.open(input)"),
        ("import os\n" + NODE + node(line="os.system(f'espeak {x}')"), "$ espeak"),
        ("import os\n" + NODE + node(line="os.popen('sudo ros2 bag record -a')"), "$ ros2 bag record"),
        ("import subprocess\n" + NODE + node(line="subprocess.Popen(['/usr/bin/arecord', x])"), "$ arecord"),
        ("import subprocess\n" + NODE + node(line="c = ['/bin/rec', x]; subprocess.run(c)"), "$ rec"),
        ("import shutil\n" + NODE + node(line="self.say = shutil.which('espeak')"), "$ espeak"),
        ("import fl\n" + NODE + node() + "@fl.route('/')\ndef page(): pass\n", "fl.route"),
    ],
)  # fmt: skip
def test_names_are_resolved_by_imports(tmp_path: Path, code: str, name: str) -> None:
    assert name in uses(tmp_path, own_py=code)["/n"]


def test_a_variable_that_may_be_two_things_is_none(tmp_path: Path) -> None:
    code = "import a, b\n" + NODE + node(line="self.c = a.X() if y else 0; self.c = b.Y(); self.c.go()")
    assert uses(tmp_path, own_py=code)["/n"] == ["a.X", "b.Y"]


def test_what_the_file_names_itself_is_not_of_a_module_that_is_imported_whole(tmp_path: Path) -> None:
    code = (
        "from gui import *\n" + NODE + node(line="own = print(1); own.go(); self.f(Tk)") + "    def f(self, x): x.y()\n"
    )
    assert uses(tmp_path, own_py=code)["/n"] == ["gui.Tk"]


def test_of_several_nodes_in_a_file_each_has_its_own(tmp_path: Path) -> None:
    code = "import lib\n" + NODE + node("a", "lib.a()", "A") + node("b", "lib.b(); both()", "B")
    code += "def both():\n    lib.c()\ndef main():\n    lib.d(); A(); B()\n"
    assert uses(tmp_path, x_py=code) == {"/a": ["lib.a"], "/b": ["lib.b", "lib.c"], "": ["lib.d"]}


def test_helpers_in_modules_of_the_package_belong_to_who_imports_them(tmp_path: Path) -> None:
    helper = "import lib\nclass Used:\n    x = lib.used()\nclass Other:\n    y = lib.other()\n"
    deep = "import lib\ndef deeper():\n    lib.deep()\n"
    for first in ("from .helper import Used", "from p.helper import Used", "from helper import Used"):
        code = f"{first}\nfrom . import deep\n{NODE}" + node(line="Used(); deep.deeper()")
        found = uses(tmp_path, p__n_py=code, p__helper_py=helper, p__deep_py=deep)
        assert found == {"/n": ["lib.deep", "lib.used"], "": ["lib.other"]}, first


def test_a_name_that_a_package_hands_on_is_what_it_imports(tmp_path: Path) -> None:
    helper = "import lib\nclass Used:\n    x = lib.used()\nclass Other:\n    y = lib.other()\n"
    code = "from tools import Used\n" + NODE + node(line="Used()")
    first = tmp_path / "a/tools/__init__.py"
    first.parent.mkdir(parents=True)
    for hands_on in ("from .eyes import Used", "from .eyes import *", "from tools.eyes import Used"):
        first.write_text(f"{hands_on}\n", "utf-8")
        found = uses(tmp_path, a__tools__eyes_py=helper, a__n_py=code)
        assert found == {"/n": ["lib.used"], "": ["lib.other"]}, hands_on
    assert uses(tmp_path, a__tools__eyes_py="from . import Used\n")["/n"] == []  # in a circle


def test_a_node_may_be_called_as_its_package(tmp_path: Path) -> None:
    code = "from arm.client import Client\n" + NODE + node("arm", "Client()")
    client = "import requests\nclass Client:\n    def go(self): requests.post(self.url)\n"
    assert uses(tmp_path, src__arm__arm_py=code, src__arm__client_py=client) == {"/arm": ["requests.post"]}


def test_helpers_in_another_package_of_the_workspace_belong_to_who_imports_them(tmp_path: Path) -> None:
    code = "from llm.client import ask\n" + NODE + node("guide", "ask()")
    client = "import requests\ndef ask(): requests.post(1)\n"
    files = {"src__guide__guide__node_py": code, "src__llm__llm__client_py": client}
    assert uses(tmp_path, **files)["/guide"] == ["llm.client.ask"]  # no package: nothing says how it is imported
    (tmp_path / "src/llm/llm/__init__.py").touch()
    assert uses(tmp_path) == {"/guide": ["requests.post"]}
    second = uses(tmp_path, old__llm__client_py=client)
    (tmp_path / "old/llm/__init__.py").touch()
    assert second == {"/guide": ["requests.post"], "": ["requests.post"]}
    assert uses(tmp_path)["/guide"] == ["llm.client.ask"]  # two such packages: no guess


def test_a_file_that_runs_one_node_belongs_to_it(tmp_path: Path) -> None:
    page = "from flask import Flask\nfrom camera import Camera\ndef main(): Flask(1), Camera()\n"
    files = {"camera_py": NODE + node("camera", of="Camera"), "page_py": page, "test__test_page_py": page}
    assert uses(tmp_path, **files) == {"/camera": ["flask.Flask"], "": ["flask.Flask"]}
    lidar = {"lidar_py": NODE + node("lidar", of="Lidar"), "page_py": page + "from lidar import Lidar\nLidar()\n"}
    assert uses(tmp_path, **lidar) == {"/camera": [], "/lidar": [], "": ["flask.Flask", "flask.Flask"]}


def test_a_namespace_that_is_not_known_leaves_the_own_name(tmp_path: Path) -> None:
    code = "import cv2\n" + NODE + node().replace("'n'", "'n', namespace=where") + "        cv2.imshow(1)\n"
    assert uses(tmp_path, a_py=code) == {"/n": ["cv2.imshow"]}


def test_a_base_belongs_to_its_node_and_another_node_does_not(tmp_path: Path) -> None:
    base = "import lib\n" + NODE + node("base", "lib.base()", "Base")
    code = "from .base import Base\nfrom .other import Other\nclass N(Base):\n    def __init__(self):\n"
    code += "        super().__init__('n')\n        Other.name\n"
    other = "import lib\n" + NODE + node("other", "lib.other()", "Other")
    found = uses(tmp_path, p__base_py=base, p__n_py=code, p__other_py=other)
    assert found["/n"] == ["lib.base"]
    assert found["/other"] == ["lib.other"]


def test_a_launch_file_names_the_one_node_of_a_module(tmp_path: Path) -> None:
    camera = "import lib\n" + NODE + node("camera", "lib.x()") + "def main():\n    N()\n"
    found = uses(tmp_path, p__setup_py=SETUP, p__p__camera_py=camera, p__launch__l_py=LAUNCH.format("eye"))
    assert found["/front"] == found["/camera"] == ["lib.x"]
    two = camera + node("second", "lib.y()", "M")
    assert "/front" not in uses(tmp_path, p__p__camera_py=two)
    assert "/front" not in uses(tmp_path, p__p__camera_py=camera, p__launch__l_py=LAUNCH.format("ear"))


def test_what_has_no_node_is_told(tmp_path: Path) -> None:
    assert uses(tmp_path, own_py="import lib\nlib.x()\n") == {"": ["lib.x"]}
    nameless = "import lib\n" + NODE + "class N(Node):\n    def __init__(self, name):\n        super().__init__(name)\n"
    assert uses(tmp_path, own_py=nameless + "        lib.x()\n") == {"": ["lib.x"]}


def test_cpp_by_class_through_header_and_source(tmp_path: Path) -> None:
    header = (
        "class Helper { zmq::socket_t s; };\n"
        "class Eye : public rclcpp::Node { public: Eye(); void go(); cv::VideoCapture cap; Helper helper; };\n"
    )
    source = (
        'using namespace cv;\nnamespace c = curl;\nEye::Eye() : Node("eye") { imshow("x", m); }\n'
        'void Eye::go() { c::post(); curl_easy_init(); std::ofstream f("x"); fopen("x", "w"); system("aplay x"); }\n'
    )
    unused = "class Unused { zmq::context_t c; };\n"
    found = uses(tmp_path, p__include__p__eye_hpp=header, p__src__eye_cpp=source, p__src__unused_hpp=unused)
    told = {"cv::VideoCapture", "cv::imshow", "curl::post", "curl_easy_init", "std::ofstream", "fopen(w)", "$ aplay"}
    assert told | {"zmq::socket_t"} <= set(found["/eye"])
    assert "zmq::context_t" not in found["/eye"]
    assert "zmq::context_t" in found[""]


def test_code_that_is_nested_and_chained_as_deep_as_it_can_be_ends(tmp_path: Path) -> None:
    chain = "import a\n" + "x = a" + ".b()" * 400 + "\n"
    nested = "x = " + "[" * 80 + "a.b" + "]" * 80 + "\n"
    found = uses(tmp_path, own_py=chain + nested + NODE + node())["/n"]
    assert "a.b" in found
    assert max(map(len, found)) < LONGEST_NAME


@pytest.mark.slow
def test_names_that_are_longer_than_any_of_a_library_are_none(tmp_path: Path) -> None:
    long = "own" + ".a" * 10_000  # the compiler of Python itself takes the square of it
    code = f"from {long} import x\nimport lib\n{NODE}" + node(line="x(); lib.y()")
    cpp = f"void f() {{ {'a::' * 20_000}b(); }}\n"
    found = uses(tmp_path, own_py=code, c_cpp=cpp)
    assert found["/n"] == ["lib.y"]
    assert max(map(len, found.get("", [""]))) < 2 * LONGEST_NAME
