"""What code uses outside ROS -> the nodes that use it: by class, by file, and through files that a node's file imports.

In: nodes, what classes and functions use, and imports of Python files. Out: nodes with their externals; a gap for what
code uses that no node imports: a program by itself, perhaps.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.scan_facts import Gap

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.scan.outside.externals import UnitExternal
    from rosprivacy.ingest.scan.scan_facts import CodeNode, External

MANY = 32  # nodes of one thing: beyond that it is open which uses it
INIT = "__init__"


class _Module(NamedTuple):
    """A file of Python, the folder at the top that it stands in, and its dotted name from there."""

    file: str
    top: tuple[str, ...]
    parts: tuple[str, ...]


def with_externals(
    nodes: Sequence[CodeNode], outside: Iterable[UnitExternal], imports: Mapping[str, Iterable[str]]
) -> tuple[tuple[CodeNode, ...], list[Gap]]:
    """Return nodes with what they exchange data with, and a gap for each file that uses what is of none.

    Parameters
    ----------
    imports
        By file, the dotted names that it imports.
    """
    by_class: dict[tuple[str, str], list[CodeNode]] = defaultdict(list)
    by_file: dict[str, list[CodeNode]] = defaultdict(list)
    for node in nodes:
        for file in {node.place.file, *(end.place.file for end in node.endpoints)}:
            by_class[file, _last(node.name)].append(node)
            by_file[file].append(node)
    users = _users(by_file, imports)
    externals: dict[int, dict[External, None]] = defaultdict(dict)
    gaps: list[Gap] = []
    homeless: dict[str, list[External]] = defaultdict(list)
    for unit, external in outside:
        file = external.place.file
        homes = by_class.get((file, _last(unit))) or by_file.get(file) or []
        homes = homes or [node for user in users.get(file, ()) for node in by_file[user]]
        for node in homes if len(homes) <= MANY else ():
            externals[id(node)][external] = None
        if len(homes) > MANY:
            text = f"which of {len(homes)} nodes exchanges data with {external.name} ({external.sort}) is not known"
            gaps.append(Gap(external.place, "node-of", text))
        if not homes:
            homeless[file].append(external)
    return tuple(node._replace(externals=tuple(externals[id(node)])) for node in nodes), [*gaps, *_gaps(homeless)]


def _gaps(homeless: Mapping[str, Sequence[External]]) -> Iterator[Gap]:
    """One for each file, at its first line of them."""
    for _, externals in sorted(homeless.items()):
        named = ", ".join(dict.fromkeys(f"{one.name} ({one.sort})" for one in sorted(externals)))
        text = f"code that no node is seen to use exchanges data with {named}"
        yield Gap(min(one.place for one in externals), "outside", text)


def _last(name: str) -> str:
    return name.replace("::", ".").rpartition(".")[2]


def _users(files: Iterable[str], imports: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    """By file, those of some files that import it, also through others."""
    modules: dict[str, list[_Module]] = defaultdict(list)
    folders = {file: PurePosixPath(file).parent.parts for file in imports}
    for file, folder in folders.items():
        stem = PurePosixPath(file).stem
        parts = folder if stem == INIT else (*folder, stem)
        modules[parts[-1] if parts else ""].append(_Module(file, folder[:1], parts))
    targets = {file: list(_targets(folders[file][:1], names, modules)) for file, names in imports.items()}
    users: dict[str, list[str]] = defaultdict(list)
    for file in sorted(files):
        reached, waiting = {file}, [file]
        while waiting:
            for target in targets.get(waiting.pop(), ()):
                if target not in reached:
                    reached.add(target)
                    waiting.append(target)
                    users[target].append(file)
    return users


def _targets(top: tuple[str, ...], names: Iterable[str], modules: Mapping[str, Sequence[_Module]]) -> Iterator[str]:
    """The files that a file below a folder imports: those whose path ends as the dotted name does."""
    for name in names:
        parts = tuple(name.strip(".").split("."))
        relative = name.startswith(".")
        for inner in (parts, parts[:-1]):
            for module in modules.get(inner[-1], ()) if inner else ():
                near = not relative or module.top == top
                if near and module.parts[-len(inner) :] == inner:
                    yield module.file
