"""What launch files and ``setup.py`` say of names: ``Node(package=…, executable=…, name=…)``, and entry points.

Source: the signature of ``launch_ros.actions.Node``, and setuptools' ``console_scripts``. Only literals are read.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from rosprivacy.ingest.annotations.source_code import Launch, Script

if TYPE_CHECKING:
    from collections.abc import Iterator

LAUNCHED = ("Node", "LifecycleNode", "ComposableNode")
ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*\w+\s*")


def launched(tree: ast.Module) -> tuple[tuple[Launch, ...], tuple[Script, ...]]:
    """Return what a file says of executables; nothing unless it is a launch file or sets a package up."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return tuple(one for call in calls for one in _launch(call)), tuple(one for call in calls for one in _scripts(call))


def _launch(call: ast.Call) -> Iterator[Launch]:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    given = {one.arg: _text(one.value) for one in call.keywords if one.arg}
    executable = given.get("executable") or given.get("node_executable", "")
    if name in LAUNCHED and given.get("package") and executable:
        yield Launch(given["package"], executable, given.get("name") or given.get("node_name", ""))


def _scripts(call: ast.Call) -> Iterator[Script]:
    """The scripts of ``setup(entry_points={"console_scripts": ["talker = demo.talker:main"]})``."""
    for given in call.keywords:
        if given.arg == "entry_points" and isinstance(given.value, ast.Dict):
            for node in ast.walk(given.value):
                found = ENTRY.fullmatch(_text(node))
                if found:
                    yield Script(found[1], found[2])


def _text(node: ast.AST) -> str:
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""
