"""Checkouts that are made to end a scan, to hang it or to lead it out of the folder: it says what it did not read."""

from __future__ import annotations

import os
from time import process_time
from typing import TYPE_CHECKING

import pytest

from rosprivacy.scanning import scan, scan_lines

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

SECONDS = 20  # of processor time; what is tried here takes about one
MANY = 2000
PYTHON = (
    "from rclpy.node import Node\nfrom std_msgs.msg import String\n"
    "class A(Node):\n    def __init__(self):\n        super().__init__('a')\n"
)
ENDS = "        self.create_publisher(String, {}, 1)\n"
CPP = '#include <rclcpp/rclcpp.hpp>\nclass A : public rclcpp::Node {{ public: A() : Node("a") {{\n{}}} }};\n'
CPP_ENDS = "p_ = create_publisher<std_msgs::msg::String>({}, 1);\n"
LAUNCH = (
    "from launch import LaunchDescription\nfrom launch_ros.actions import Node\ndef generate_launch_description():\n"
)
LAUGHS = "".join(f"a{at}: &a{at} [{', '.join([f'*a{at - 1}'] * 8)}]\n" for at in range(1, 30))
CYCLE = "<launch><include file='$(dirname)/{}.launch.xml'/><node pkg='p' exec='e' name='{}'/></launch>"
DOUBLED = "<launch>" + "<include file='$(dirname)/a{0}.launch.xml'/>" * 2 + "</launch>"
PYTHON_EXPRESSIONS = {
    "deep": "(" * MANY + "'x'" + ")" * MANY,
    "long": "+".join(["'x'"] * MANY),
    "repeated": "'x' * 10**10",
    "power": "str(9**9**9**9)",
    "padded": "'{:>1000000000}'.format(3)",
    "calls": "(lambda f: f(f))(lambda f: f(f))",
    "products": "''.join(__import__('itertools').product('ab', repeat=99))",
}
SOURCES = {
    "classes": {"a.py": "".join(f"class A{at}: pass\n" for at in range(MANY * 5))},
    "derived": {"a.py": PYTHON + "".join(f"class A{at}({f'A{at - 1}' if at else 'A'}): pass\n" for at in range(MANY))},
    "derived in a circle": {"a.py": "".join(f"class A{at}(A{(at + 1) % MANY}): pass\n" for at in range(MANY)) + PYTHON},
    "assigned": {"a.py": PYTHON + "".join(f"        a = 't{at}'\n" + ENDS.format("a") for at in range(MANY))},
    "parameters": {
        "a.py": PYTHON
        + "".join(f"        a{at} = self.declare_parameter('p{at}', 'x').value\n" for at in range(MANY // 2))
        + "".join(ENDS.format(f"a{at}") for at in range(MANY // 2))
    },
    "branches": {"a.py": PYTHON + "        a = ''\n" + "        if b: a += 'x'\n" * MANY + ENDS.format("a")},
    "doubled": {"a.py": PYTHON + "        a = 'a'\n" + "        a = a + a\n" * 60 + ENDS.format("a")},
    "imports in a circle": {
        f"p/m{at}.py": "".join(f"from .m{other} import *\n" for other in range(12)) + PYTHON + ENDS.format("X")
        for at in range(12)
    },
    "calls in a circle": {
        "a.py": PYTHON
        + "        self.f('x')\n    def f(self, n):\n        self.f(n + 'a'); self.f(n + 'b')\n"
        + ENDS.format("n")
    },
    "launches in a circle": {"a.launch.xml": CYCLE.format("b", "x"), "b.launch.xml": CYCLE.format("a", "y")},
    "launches doubled": {f"a{at}.launch.xml": DOUBLED.format(at + 1) for at in range(40)},
    "launch without end": {
        "a.launch.py": f"{LAUNCH}    while True:\n        a.append(Node(package='p', executable='e'))\n"
    },
    "launch of anything": {"a.launch.py": f"{LAUNCH}    return LaunchDescription([Node(package='p', executable=x)])\n"},
    "launch with laughs": {"a.launch.yaml": f"a0: &a0 [x]\n{LAUGHS}launch: *a29\n"},
    "compose with laughs": {
        "docker-compose.yml": f"a0: &a0 [x]\n{LAUGHS}services: {{x: {{image: a, volumes: *a29}}}}\n"
    },
    "manifest with laughs": {
        "package.xml": "<!DOCTYPE l [<!ENTITY a 'x'><!ENTITY b '&a;&a;'>]><package><name>&b;</name></package>"
    },
    "lists of cmake": {
        "package.xml": "<package><name>p</name></package>",
        "CMakeLists.txt": "".join(f"set(X{at + 1} ${{X{at}}} ${{X{at}}})\n" for at in range(60))
        + "add_executable(e ${X59})\n",
    },
    "deep c++": {"a.cpp": CPP.format("{" * MANY + CPP_ENDS.format('"x"') + "}" * MANY)},
    "derived c++": {
        "a.cpp": "".join(f"class A{at} : public A{(at + 1) % MANY} {{}};\n" for at in range(MANY))
        + CPP.format(CPP_ENDS.format('"x"'))
    },
    "includes in a circle": {
        f"a{at}.hpp": "".join(f'#include "a{other}.hpp"\n' for other in range(20))
        + CPP.format(CPP_ENDS.format(f"K{at}")).replace("A", f"A{at}")
        for at in range(20)
    },
    "macros in a circle": {"a.cpp": "#define X Y\n#define Y X\n" + CPP.format(CPP_ENDS.format("X"))},
}


@pytest.fixture(autouse=True)
def _in_time() -> Iterator[None]:
    before = process_time()
    yield
    assert process_time() - before < SECONDS


def lines_of(folder: Path, files: Mapping[str, str | bytes]) -> list[str]:
    for name, text in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return list(scan_lines(scan(str(folder))))


@pytest.mark.parametrize("expression", PYTHON_EXPRESSIONS)
def test_a_name_that_is_a_bomb_is_a_gap(tmp_path: Path, expression: str) -> None:
    (tmp_path / "a.py").write_text(PYTHON + ENDS.format(PYTHON_EXPRESSIONS[expression]), "utf-8")
    gaps = scan(str(tmp_path)).system.gaps
    ends = {end.name for end in scan(str(tmp_path)).system.ends}
    assert any(gap.place.file == "a.py" for gap in gaps) or any(set(name) == {"/", "x"} for name in ends)


@pytest.mark.parametrize("sources", SOURCES)
def test_a_scan_ends(tmp_path: Path, sources: str) -> None:
    assert lines_of(tmp_path, SOURCES[sources])


def test_a_variable_with_thousands_of_values_is_a_gap_at_each_call(tmp_path: Path) -> None:
    lines_of(tmp_path, SOURCES["assigned"])
    gaps = {gap.place.line for gap in scan(str(tmp_path)).system.gaps if gap.sort == "name"}
    assert len(gaps) == MANY


def test_links_out_and_in_circles_are_gaps_and_not_followed(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "secret.py").write_text(PYTHON + ENDS.format("'secret'"), "utf-8")
    (outside / "a.launch.xml").write_text("<launch><node pkg='p' exec='secret' name='secret'/></launch>", "utf-8")
    folder = tmp_path / "workspace"
    folder.mkdir()
    for name, to in (
        ("out", outside), ("secret.py", outside / "secret.py"), ("circle.py", "circle.py"), ("nowhere.py", "none.py"),
        ("here", "."), ("up", ".."), ("a.launch.xml", outside / "a.launch.xml"), ("package.xml", "/etc/passwd"),
        ("docker-compose.yml", "/etc/passwd"),
    ):  # fmt: skip
        (folder / name).symlink_to(to)
    lines_of(folder, {"node.py": PYTHON + ENDS.format("'own'")})
    system = scan(str(folder)).system
    assert "/own" in {end.name for end in system.ends}
    assert not [end for end in system.ends if "secret" in end.name]
    assert {gap.place.file for gap in system.gaps} >= {
        "out", "secret.py", "circle.py", "nowhere.py", "up", "a.launch.xml", "package.xml", "docker-compose.yml",
    }  # fmt: skip


def test_a_launch_file_outside_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "secret.launch.xml").write_text("<launch><node pkg='p' exec='e' name='secret'/></launch>", "utf-8")
    folder = tmp_path / "workspace"
    folder.mkdir()
    include = "<launch><include file='$(dirname)/../secret.launch.xml'/></launch>"
    lines = lines_of(folder, {"a.launch.xml": include, "a.py": PYTHON})
    system = scan(str(folder)).system
    assert [gap for gap in system.gaps if gap.sort == "include" and gap.place.file == "a.launch.xml"]
    assert not [node for node in system.nodes if "secret" in node.name]
    assert lines


@pytest.mark.parametrize("data", [bytes(range(256)) * 100, (PYTHON + ENDS.format("'é'")).encode("latin-1")])
def test_what_is_no_text_is_a_gap(tmp_path: Path, data: bytes) -> None:
    lines_of(tmp_path, {"a.py": data})
    assert [gap.sort for gap in scan(str(tmp_path)).system.gaps if gap.place.file == "a.py"]


@pytest.mark.parametrize("name", ["a\nb/c\x1b[31m.py", "\u202egpj.py", "a\nb/c\x1b[31m.cpp"])
def test_signs_that_move_the_cursor_are_escaped(tmp_path: Path, name: str) -> None:
    source = PYTHON + ENDS.format("'x' + y") + ENDS.format(r"'\x1b[2J\n\u202e'")
    if name.endswith(".cpp"):
        source = CPP.format(CPP_ENDS.format("y") + CPP_ENDS.format(r'"\x1b[2J\n"'))
    lines = lines_of(tmp_path, {name: source})
    assert all(line.isprintable() for line in lines)
    assert any("name" in line for line in lines)


def test_names_that_are_no_text_are_read_and_shown(tmp_path: Path) -> None:
    with open(os.fsencode(tmp_path) + b"/\xff\xfe.py", "w", encoding="utf-8") as file:  # noqa: PTH123 - no text
        file.write(PYTHON + ENDS.format("'x' + y"))
    lines = lines_of(tmp_path, {})
    assert "\n".join(lines).encode("utf-8")
    assert scan(str(tmp_path)).system.gaps


def test_pipes_are_not_opened(tmp_path: Path) -> None:
    for name in ("a.py", "a.launch.xml", "package.xml", "docker-compose.yml"):
        os.mkfifo(tmp_path / name)
    lines_of(tmp_path, {"b.py": PYTHON + ENDS.format("'x'")})
    assert "/x" in {end.name for end in scan(str(tmp_path)).system.ends}


def test_nothing_is_run(tmp_path: Path) -> None:
    sign = tmp_path / "run"
    command = f"__import__('pathlib').Path({str(sign)!r}).touch()"
    lines_of(
        tmp_path,
        {
            "a.py": f"{command}\n{PYTHON}{ENDS.format(command)}",
            "a.launch.py": f"{command}\n{LAUNCH}    {command}\n    return LaunchDescription([])\n",
            "b.launch.xml": f"<launch><node pkg='p' exec=\"$(eval '{command}')\"/>"
            f"<node pkg='p' exec='$(command touch {sign})'/></launch>",
            "setup.py": command,
        },
    )
    assert not sign.exists()
