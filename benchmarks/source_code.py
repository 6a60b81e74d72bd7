"""What reading the source code of nodes costs: it grows with the code and no faster, and is some times parsing alone.

A workspace of packages in Python and C++, each with a node, a module of helpers that the node imports, and a class in
C++ with its header. Reading is all that ``suggest --source`` does with it: types of channels, uses of libraries, and
whose they are. Parsing alone is what Python's own parser and tree-sitter take for the same files.
"""

from __future__ import annotations

import ast
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Row, timed, timed_or_counted

from rosprivacy.ingest.code.source_files import read_sources
from rosprivacy.labelling.knowledge import code_said

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

LINEAR, TIMES_PARSING = 1.5, 25.0
FEW, TIMES = 25, 4  # packages; the large workspace has so many times more
METHODS = 20  # of a class
PYTHON = (
    "import cv2\nimport requests\nfrom rclpy.node import Node\nfrom sensor_msgs.msg import Image\n"
    "from .helper import Helper\n\nclass Camera(Node):\n"
    "    def __init__(self):\n        super().__init__('camera{0}')\n"
    "        self.out = self.create_publisher(Image, 'image', 1)\n        self.helper = Helper()\n"
    "        self.cap = cv2.VideoCapture(0)\n"
)
METHOD = (
    "    def m{0}(self, x):\n        y = [self.cap.read() for _ in range(x)]\n        return cv2.resize(y[0], (1, 2))\n"
)
HELPER = "import requests\nclass Helper:\n    def send(self):\n        requests.post('x')\n"
HEADER = (
    "#include <opencv2/opencv.hpp>\nclass Show{0} : public rclcpp::Node {{ public: Show{0}(); cv::VideoCapture c; }};\n"
)
SOURCE = 'Show{0}::Show{0}() : Node("show{0}") {{ cv::imshow("x", m); }}\n'
FUNCTION = "void Show{0}::m{1}(int x) {{ std::vector<int> y; for (int i = 0; i < x; i++) y.push_back(i * {1}); }}\n"


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    what = f"reading {FEW * TIMES} packages of source code"
    yield from rows_of(what, workspace, told, (FEW, TIMES), TIMES_PARSING, quick=quick)


def rows_of(
    what: str,
    made: Callable[[Path, int], str],
    read: Callable[[str], object],
    few_and_times: tuple[int, int],
    times_parsing: float,
    *,
    quick: bool,
) -> Iterator[Row]:
    """Declare the two rows of whatever reads source code: against so many times fewer packages, and against parsing.

    ``made`` writes so many packages into a folder and returns its name, ``read`` does with it what is measured.
    """
    few, times = few_and_times
    rounds = 3 if quick else 7
    with TemporaryDirectory() as folder:
        small, large = (made(Path(folder) / str(count), count) for count in (few, few * times))
        grown = partial(
            timed_or_counted, rounds, partial(read, large), lambda: [read(small) for _ in range(times)], quick=quick
        )
        yield Row(what, f"{times} times {few}", grown, LINEAR, counts=quick)
        beside = partial(timed, rounds, partial(read, large), parsing(large))
        yield Row(what, "parsing them", beside, bound=times_parsing)


def workspace(folder: Path, packages: int) -> str:
    """Write so many packages."""
    for number in range(packages):
        package = folder / f"p{number}"
        functions = "".join(FUNCTION.format(number, at) for at in range(METHODS))
        for name, text in (
            ("p/node.py", PYTHON.format(number) + "".join(METHOD.format(at) for at in range(METHODS))),
            ("p/helper.py", HELPER),
            ("include/show.hpp", HEADER.format(number)),
            ("src/show.cpp", '#include "show.hpp"\n' + SOURCE.format(number) + functions),
        ):
            (package / name).parent.mkdir(parents=True, exist_ok=True)
            (package / name).write_text(text, "utf-8")
    return str(folder)


def parsing(folder: str) -> Callable[[], None]:
    """Return what parses all Python and C++ of a folder, and does nothing else."""
    import tree_sitter
    import tree_sitter_cpp

    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
    files = [file for file in sorted(Path(folder).rglob("*")) if file.suffix in (".py", ".cpp", ".hpp")]

    def parse() -> None:
        for file in files:
            data = file.read_bytes()
            if file.suffix == ".py":
                ast.parse(data)
            else:
                parser.parse(data)

    return parse


def told(folder: str) -> object:
    """All that suggestions take from source code, of a system without elements."""
    codes, of_others, _ = read_sources([folder])
    return code_said(codes, of_others, [])
