"""What the code of the labelled nodes uses of libraries -> ``uses`` in their system files.

In: a folder with the sources of each system, by its name, at the commit that its file names. Nodes are found as
``rosprivacy suggest --source`` finds them. Nobody has to look at what is written, of held-out systems neither.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedSeq

from rosprivacy.analysis.model import Element
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, PYTHON
from rosprivacy.ingest.code.source_files import read_sources
from rosprivacy.ingest.suggestions.library_file import read_library_rules
from rosprivacy.labelling.code_said import code_said
from rosprivacy.ontology.vocabulary import load
from tests.labelled.labelled_set import HERE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.analysis.suggesting.library_rules import LibraryRules, NodeUse

WIDTH = 120
ROS = ("rclpy", "rclcpp", "ament_index_python", "launch", "launch_ros", "builtin_interfaces", "tf_transformations")
PLAIN = (  # libraries that bring nothing in and let nothing out, by no rule that anybody could write
    "numpy", "math", "time", "datetime", "typing", "threading", "collections", "dataclasses", "enum", "functools",
    "random", "copy", "re", "struct", "itertools", "abc", "traceback", "contextlib", "uuid", "warnings",
    "__future__", "string", "textwrap", "hashlib", "base64", "statistics", "heapq", "queue", "signal", "cmath", "array",
    "operator", "types", "importlib", "inspect", "setuptools", "pytest", "unittest", "glob", "shutil",
)  # fmt: skip
INTERFACES = ("msg", "srv", "action")


def write_uses(root: Path) -> dict[str, int]:
    """Write the uses of all systems whose sources are there; return how many nodes of each have some."""
    files = sorted((HERE / "systems").glob("*.yaml"))
    return {file.stem: _write(file, root / file.stem) for file in files if (root / file.stem).is_dir()}


def _write(file: Path, sources: Path) -> int:
    yaml = YAML()
    yaml.width, yaml.preserve_quotes = WIDTH, True
    top: Any = yaml.load(file.read_text("utf-8"))
    nodes = top["nodes"]
    names = [*nodes]
    rules = read_library_rules((), load())[0]
    codes, of_others, _ = read_sources([str(sources)])
    said = code_said(codes, of_others, [Element("node", name) for name in names])
    for vertex, name in enumerate(names):
        used = sorted({told for use in said.uses.get(vertex, ()) for told in _told(use, rules)})
        nodes[name].pop("uses", None)
        if used:
            nodes[name]["uses"] = CommentedSeq(used)
            nodes[name]["uses"].fa.set_flow_style()
    text = io.StringIO()
    yaml.dump(top, text)
    file.write_text(text.getvalue(), "utf-8")
    return sum("uses" in node for node in nodes.values())


def _told(use: NodeUse, rules: LibraryRules) -> Iterator[str]:
    """What is written of a use; of an address the parts that rules name: addresses of others are not ours to keep."""
    if use.name.startswith(ADDRESS):
        sections = (rules.brings_in, rules.makes, rules.lets_out)
        parts = {part for section in sections for part in section[PYTHON].addresses}
        yield from (f"{ADDRESS}{part}" for part in parts if part in use.name)
        return
    head, _, rest = use.name.partition(".")
    if head not in ROS and head not in PLAIN and rest.partition(".")[0] not in INTERFACES:
        yield use.name
