"""Versions of code: what changes the hash of a class, and what does not (rule S11)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.checkout import chosen, code_of, scanned

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.labels.pins import CodeVersion

MANIFEST = "<package format='3'><name>blurring</name></package>\n"
PYTHON = """\
from rclpy.node import Node


class Base(Node):
    def clean(self, image):
        return image[:2]


class Blur(Base):
    def __init__(self):
        super().__init__("blur")
        self.out = self.create_publisher(Image, "clean", 10)

    def send(self, image):
        self.out.publish(self.clean(image))


class Other:
    size = 1
"""
HEADER = "class Base : public rclcpp::Node { void clean(); };\nclass Blur : public Base {\n  void send();\n};\n"
SOURCE = '#include "blur.hpp"\nvoid Base::clean() { cut(2); }\nvoid Blur::send() { log("a  b"); }\nvoid helper() {}\n'
CPP = {"blur.hpp": HEADER, "blur.cpp": SOURCE}


def version(folder: Path, unit: str, **files: str) -> CodeVersion | None:
    for name, text in {"package.xml": MANIFEST, **files}.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return code_of(str(folder)).version(unit)


def is_same(folder: Path, unit: str, files: dict[str, str], old: str, new: str) -> bool:
    assert any(old in text for text in files.values())
    before = version(folder / "before", unit, **files)
    now = version(folder / "now", unit, **{name: text.replace(old, new) for name, text in files.items()})
    assert before
    assert now
    return before.hash == now.hash


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("        return image[:2]", "        # why\n        return (image[: 2])", True),
        ('"clean", 10)', "'clean',\n            10)  # ten", True),
        ("size = 1", "size = 2", True),  # a class that is no base of it
        ("image[:2]", "image[:3]", False),  # of its base class
        ('"clean", 10', '"raw", 10', False),
        ("self.clean(image)", "image", False),
        ("Blur(Base)", "Blur(Other)", False),
    ],
)
def test_of_python_the_class_and_its_bases_count(tmp_path: Path, old: str, new: str, *, same: bool) -> None:
    assert is_same(tmp_path, "blurring/blur.py:Blur", {"blur.py": PYTHON}, old, new) == same


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("void send();", "void\n  send( ) ;  // why", True),
        ("void helper() {}", "void helper() { go(); }", True),
        ('log("a  b")', 'log("a b")', False),  # inside a text white space counts
        ("cut(2)", "cut(3)", False),  # a method of its base class, in another file
        ("class Blur : public Base", "class Blur : public Other", False),
    ],
)
def test_of_cpp_methods_outside_of_the_class_count_too(tmp_path: Path, old: str, new: str, *, same: bool) -> None:
    assert is_same(tmp_path, "blurring/blur.hpp:Blur", CPP, old, new) == same


def test_a_unit_is_called_by_its_package_wherever_the_package_lies(tmp_path: Path) -> None:
    at_top = version(tmp_path / "a", "blurring/src/blur.py:Blur", **{"src/blur.py": PYTHON})
    deeper = {"package.xml": "<package format='3'><name>all</name></package>", "x/y/package.xml": MANIFEST}
    below = version(tmp_path / "b", "blurring/src/blur.py:Blur", **deeper, **{"x/y/src/blur.py": PYTHON})
    assert at_top
    assert below
    assert at_top.hash == below.hash
    assert below.place == (str(tmp_path / "b/x/y/src/blur.py"), 9)


@pytest.mark.parametrize("unit", ["blurring/blur.py:Gone", "blurring/gone.py:Blur", "blur.py:Blur", "", ":", "/"])
def test_what_is_not_there_has_no_version(tmp_path: Path, unit: str) -> None:
    assert version(tmp_path, unit, **{"blur.py": PYTHON}) is None


def test_what_cannot_be_read_has_no_version(tmp_path: Path) -> None:
    assert version(tmp_path, "blurring/blur.py:Blur", **{"blur.py": PYTHON + "def\n"}) is None


def test_a_node_that_functions_make_is_the_whole_file(tmp_path: Path) -> None:
    text = 'import rclpy\n\n\ndef seen(image):\n    pass\n\n\ndef main():\n    node = rclpy.create_node("blur")\n'
    text += '    node.create_subscription(Image, "raw", seen, 10)\n'
    version(tmp_path, "", **{"blur.py": text})
    (node,) = chosen(*scanned(str(tmp_path))).nodes
    assert node.code
    unit = code_of(str(tmp_path)).unit_of(node.code)
    assert unit == "blurring/blur.py"
    assert not is_same(tmp_path, unit, {"blur.py": text}, "pass", "send(image)")


def test_base_classes_may_go_round(tmp_path: Path) -> None:
    text = "class A(B):\n    x = 1\n\n\nclass B(A):\n    y = 1\n"
    assert not is_same(tmp_path, "blurring/a.py:A", {"a.py": text}, "y = 1", "y = 2")


def test_one_name_in_two_namespaces_is_no_circle(tmp_path: Path) -> None:
    files = {"a.hpp": "class Blur : public base::Blur {};\n", "b.hpp": "namespace base { class Blur { int n; }; }\n"}
    assert not is_same(tmp_path, "blurring/a.hpp:Blur", files, "int n", "long n")
