"""What cannot be looked at is an error, on every Python: never 'there is nothing'."""

from __future__ import annotations

import ast
import os
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.reading.path_kinds import exists, is_dir, is_file
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/robot"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>image</topic></topics></profile></profiles></enclave></enclaves></policy>
"""
LONG = "d" * 200


def test_a_file_a_folder_and_nothing(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    file.write_text(POLICY)
    (tmp_path / "link").symlink_to(file)
    (tmp_path / "ring").symlink_to(tmp_path / "ring")
    os.mkfifo(tmp_path / "pipe")
    kinds = {
        str(tmp_path): (True, False, True),
        str(file): (True, True, False),
        str(tmp_path / "link"): (True, True, False),
        str(tmp_path / "ring"): (False, False, False),
        str(tmp_path / "pipe"): (True, False, False),
        str(tmp_path / "none"): (False, False, False),
        str(file / "below a file"): (False, False, False),
        "a\0b": (False, False, False),
    }
    assert {path: (exists(path), is_file(path), is_dir(path)) for path in kinds} == kinds


@pytest.mark.parametrize("question", [exists, is_file, is_dir])
def test_a_path_that_the_system_refuses_is_an_error(question: object) -> None:
    assert callable(question)
    with pytest.raises(OSError, match="too long"):
        question("a" * 5000)


def planted_deep(top: Path, text: str) -> None:
    """A file whose path is longer than the 4,096 bytes that Linux takes, in folders that can be listed."""
    at = os.open(top, os.O_RDONLY)
    for name in [LONG] * ((4050 - len(str(top))) // (len(LONG) + 1)):
        os.mkdir(name, dir_fd=at)
        below = os.open(name, os.O_RDONLY, dir_fd=at)
        os.close(at)
        at = below
    with closing(os.fdopen(os.open(f"{LONG}{'p' * 40}.xml", os.O_CREAT | os.O_WRONLY, dir_fd=at), "w")) as file:
        file.write(text)
    os.close(at)


def test_a_policy_that_cannot_be_looked_at_is_not_passed_over(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "robot.xml").write_text(POLICY)
    planted_deep(tmp_path, POLICY)
    done = cli("analyze", str(tmp_path))
    assert done.returncode == 2
    assert "File name too long" in done.stderr


def test_what_reads_asks_no_path_itself() -> None:
    asked = [
        f"{file.relative_to(ROOT)}:{node.lineno}"
        for file in (ROOT / "ingest").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and not node.args
        if node.func.attr in {"exists", "is_file", "is_dir"}
        if not (isinstance(node.func.value, ast.Name) and node.func.value.id == "entry")  # of os.scandir
    ]
    assert not asked, "use rosprivacy.ingest.reading.path_kinds"
