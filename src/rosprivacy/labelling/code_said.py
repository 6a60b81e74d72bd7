"""Source code of nodes -> what it says of the elements of a system, as evidence for suggestions only.

In: files of code, elements. Out: types by channel, uses of libraries by node, what belongs to no node of the
system, and what could not be read. A node is the one that the code calls so; where the policies put it into another
namespace, the one whose own name is the same.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import MessageType
from rosprivacy.ingest.code.code_names import code_evidence
from rosprivacy.ingest.code.node_uses import node_uses
from rosprivacy.labelling.basis import CodeSaid

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.ingest.code.source_code import Code


def code_said(codes: Sequence[Code], of_others: tuple[str, ...], elements: Sequence[Element]) -> CodeSaid:
    """Return what source code says of elements.

    Parameters
    ----------
    of_others
        Folders that were left out.
    elements
        Of a graph, in the order of its vertices.
    """
    found = node_uses(codes)
    uses, placed = _placed(found.of_nodes, elements)
    homeless = {use for name, some in found.of_nodes.items() if name not in placed for use in some}
    homeless -= {use for some in uses.values() for use in some}
    unplaced = sorted({*found.without_node, *homeless}, key=lambda use: (use.place, use.name))
    problems = tuple(one for code in codes for one in code.problems if not code.uses and not code.sites)
    return CodeSaid(_types(codes, elements), uses, tuple(unplaced), problems, of_others, found.local)


def _types(codes: Sequence[Code], elements: Sequence[Element]) -> Mapping[int, tuple[MessageType, ...]]:
    said: dict[tuple[str, str], list[MessageType]] = defaultdict(list)
    for one in code_evidence(codes):
        if one.name and one.type:
            said[one.kind, one.name].append(MessageType(one.type, one.place))
    channels = ((at, (e.kind, e.name)) for at, e in enumerate(elements) if e.is_channel)
    return {at: tuple(said[key]) for at, key in channels if key in said}


def _placed(
    of_nodes: Mapping[str, tuple[NodeUse, ...]], elements: Iterable[Element]
) -> tuple[dict[int, tuple[NodeUse, ...]], set[str]]:
    """The uses of each node of a system, and the names in code that are of one."""
    by_own_name: dict[str, list[str]] = defaultdict(list)
    for name in of_nodes:
        by_own_name[_own_name(name)].append(name)
    uses, placed = {}, set()
    for vertex, element in enumerate(elements):
        if element.is_node:
            names = [element.name] if element.name in of_nodes else by_own_name.get(_own_name(element.name), [])
            placed.update(names)
            if names:
                uses[vertex] = tuple(use for name in names for use in of_nodes[name])
    return uses, placed


def _own_name(name: str) -> str:
    return name.rpartition("/")[2]
