"""Leaks that are put into real systems: how many a scan finds, names by a gap, or loses without a word.

    python -m tests.scanned.planting FOLDER_OF_SYSTEMS [--seeds N]

A seed draws a system, a language of its code, a function of a class that makes ends of channels, and a statement of it.
Before it stand a subscription, a publisher and a client of a cloud from then on, in one of the ways in which code is
written. *Named* is what has a gap at that very line. Systems are copied; nothing is run.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
import shutil
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, NamedTuple

import tree_sitter
import tree_sitter_cpp

from rosprivacy.ingest.scan.checkout import read_checkout
from rosprivacy.ingest.scan.checkout_files import checkout_files
from tests.scanned.measuring import open_ends, scanned_ends

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.ingest.scan.scan_facts import CodeFacts

MAKES = re.compile(r"(?:self\.|this->|\b)create_(?:publisher|subscription)\b")
ENDS = "publisher", "subscription", "cloud"
PYTHON = {
    "literal": {
        "subscription": "self.create_subscription(String, 'planted_in', lambda message: None, 10)",
        "publisher": "self.create_publisher(String, 'planted_out', 10)",
        "cloud": "requests.post('https://planted.example/in', data=str(self), timeout=9)",
    },
    "variable": {
        "subscription": "planted = 'planted_in'; self.create_subscription(String, planted, print, qos_profile=10)",
        "publisher": "planted = '/'.join(['planted_out']); self.create_publisher(String, planted, 10)",
        "cloud": "planted = requests.Session(); planted.post('https://planted.example/in', data=str(self))",
    },
    "parameter": {
        "subscription": "self.create_subscription(String, self.declare_parameter('p', 'planted_in').value, print, 1)",
        "publisher": "self.create_publisher(String, topic=f\"{self.declare_parameter('q', 'planted').value}_out\", "
        "qos_profile=1)",
        "cloud": "import boto3; boto3.client('s3').put_object(Body=str(self))",
    },
}
CPP = {
    "literal": {
        "subscription": 'auto planted1 = this->create_subscription<std_msgs::msg::String>("planted_in", 10, heard);',
        "publisher": 'auto planted2 = create_publisher<std_msgs::msg::String>("planted_out", 10);',
        "cloud": "curl_easy_perform(planted_curl);",
    },
    "variable": {
        "subscription": 'const std::string planted3 = "planted_in"; '
        "auto planted1 = create_subscription<std_msgs::msg::String>(planted3, 10, heard);",
        "publisher": 'std::string planted4("planted_"); '
        'auto planted2 = create_publisher<std_msgs::msg::String>(planted4 + "out", 10);',
        "cloud": 'cpr::Post(cpr::Url{"https://planted.example"});',
    },
    "parameter": {
        "subscription": "auto planted1 = create_subscription<std_msgs::msg::String>("
        'this->declare_parameter<std::string>("p", "planted_in"), 10, heard);',
        "publisher": "auto planted2 = create_publisher<std_msgs::msg::String>("
        'declare_parameter("q", std::string("planted_out")), 10);',
        "cloud": "mosquitto_publish(planted5, 0, planted6, 1, planted7, 0, 0);",
    },
}


class Place(NamedTuple):
    """A line before which a statement can stand, with what stands before it there."""

    file: str
    line: int
    indent: str

    @property
    def language(self) -> str:
        """``python`` or ``c++``."""
        return "python" if self.file.endswith(".py") else "c++"


def places(root: Path) -> list[Place]:
    """Return where something can be planted in a system, in the order of its files."""
    found: list[Place] = []
    for file in checkout_files(root).files:
        if file.endswith((".py", ".cpp")) and not file.endswith((".launch.py", "setup.py")):
            text = (root / file).read_bytes()
            if MAKES.search(text.decode("utf-8", "replace")):
                found += (_of_python if file.endswith(".py") else _of_cpp)(file, text)
    return found


def _of_python(file: str, data: bytes) -> Iterator[Place]:
    try:
        tree = ast.parse(data)
    except (SyntaxError, ValueError):
        return
    lines = data.decode("utf-8", "replace").splitlines()
    for top in ast.walk(tree):
        if not isinstance(top, ast.ClassDef) or not MAKES.search(ast.unparse(top)):
            continue
        for function in top.body:
            if not isinstance(function, ast.FunctionDef) or not function.args.args or function.decorator_list:
                continue
            inner = [one for one in ast.walk(function) if isinstance(one, ast.stmt) and one is not function]
            for one in inner:
                before = lines[one.lineno - 1][: one.col_offset]
                own_line = not before.strip() and not lines[one.lineno - 1].lstrip().startswith(("elif", "else"))
                nested = any(isinstance(other, ast.FunctionDef | ast.ClassDef) for other in inner)
                if own_line and not nested and function.args.args[0].arg == "self":
                    yield Place(file, one.lineno, before)


def _of_cpp(file: str, data: bytes) -> Iterator[Place]:
    tree = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language())).parse(data)
    waiting = [tree.root_node]
    while waiting:
        node = waiting.pop()
        waiting += reversed(node.children)
        if node.type != "function_definition" or not MAKES.search(data[node.start_byte : node.end_byte].decode()):
            continue
        body = node.child_by_field_name("body")
        for one in body.named_children if body is not None else ():
            if one.type in ("expression_statement", "declaration", "if_statement"):
                yield Place(file, one.start_point[0] + 1, " " * one.start_point[1])


def planted(root: Path, place: Place, form: str) -> Mapping[str, int]:
    """Put the three into a file, and return the line of each."""
    path = root / place.file
    lines = path.read_text("utf-8", "surrogateescape").split("\n")
    forms, imports = (PYTHON[form], ["import requests", "from std_msgs.msg import String"])
    if place.file.endswith(".cpp"):
        forms, imports = CPP[form], ["#include <curl/curl.h>"]
    statements = [f"{place.indent}{forms[end]}" for end in ENDS]
    lines[place.line - 1 : place.line - 1] = statements
    first = next((at for at, line in enumerate(lines) if line.startswith(("import ", "from rclpy", "#include"))), 0)
    lines[first:first] = imports
    path.write_text("\n".join(lines), "utf-8", "surrogateescape")
    return {end: place.line + len(imports) + at for at, end in enumerate(ENDS)}


def outcome(facts: CodeFacts, file: str, line: int, end: str) -> str:
    """Return ``found``, ``named`` or ``lost``."""
    if end == "cloud":
        found = any(one.place == (file, line) for node in facts.nodes for one in node.externals)
    else:
        names = {one.name for one in scanned_ends(facts) if (one.file, one.line) == (file, line)}
        found = any(name.endswith("planted_out" if end == "publisher" else "planted_in") for name in names)
    if found:
        return "found"
    gaps = {(gap.place.file, gap.place.line) for gap in facts.gaps} | set(open_ends(facts))
    return "named" if (file, line) in gaps else "lost"


def main() -> None:
    """Print what becomes of what is planted."""
    parser = argparse.ArgumentParser(prog="python -m tests.scanned.planting")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=200)
    arguments = parser.parse_args()
    systems = {root: found for root in sorted(arguments.folder.iterdir()) if root.is_dir() and (found := places(root))}
    counts: Counter[tuple[str, str, str]] = Counter()
    for seed in range(arguments.seeds):
        draw = random.Random(seed)  # noqa: S311 - the same draw each time
        root = draw.choice(list(systems))
        language = draw.choice(sorted({place.language for place in systems[root]}))
        place = draw.choice([place for place in systems[root] if place.language == language])
        form = draw.choice(list(PYTHON))
        with TemporaryDirectory() as folder:
            copy = Path(folder) / root.name
            shutil.copytree(root, copy, symlinks=True, ignore=shutil.ignore_patterns(".git", "*.stl", "*.pt"))
            lines = planted(copy, place, form)
            facts = read_checkout(str(copy)).facts
        for end, line in lines.items():
            became = outcome(facts, place.file, line, end)
            counts[language, end, became] += 1
            if became != "found":
                print(f"{became} {end} ({form}), seed {seed}: {root.name}/{place.file}:{line}", flush=True)
    for language, end in sorted({key[:2] for key in counts}):
        parts = ", ".join(f"{became} {counts[language, end, became]}" for became in ("found", "named", "lost"))
        print(f"{language:7} {end:12} {parts}")


if __name__ == "__main__":
    main()
