"""Source code -> what it writes into logs of the data of channels, and of what was recognised .

In: files of source code, read once. Out: by file the calls of loggers, of ``print`` and their like with such a value,
and the lines of the calls that make the channels whose data it is. What a file does not say, since it is done in
another one, is not followed.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.library_rules import NodeUse
from rosprivacy.ingest.scan.scan_facts import CodePlace, LogCall

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    from rosprivacy.ingest.code.source_code import Code
    from rosprivacy.ingest.scan.outside.value_flow import LoggedValue
    from rosprivacy.ingest.scan.scan_facts import CodeNode


class FileLogs(NamedTuple):
    """What one file writes into logs; the file relative to the root of the checkout."""

    file: str
    values: tuple[LoggedValue, ...]


def lines_recognising(code: Code, rules: LibraryRules) -> frozenset[int]:
    """Return the lines at which a file uses what recognises something."""
    return frozenset(
        use.line
        for use in code.uses
        if rules.spoken(rules.makes, NodeUse(use.name, code.language, Place(code.file, use.line)))
    )


def with_logs(nodes: Iterable[CodeNode], logs: Iterable[FileLogs]) -> tuple[CodeNode, ...]:
    """Return nodes with the log calls that write data of their ends of channels, or what they recognise.

    What is recognised is of the node whose class writes it; in a file with one node, of that one.
    """
    nodes = tuple(nodes)
    by_file = {one.file: one.values for one in logs}
    nodes_of = Counter(node.place.file for node in nodes)
    return tuple(_with_own(node, by_file, nodes_of) for node in nodes)


def _with_own(node: CodeNode, by_file: Mapping[str, Iterable[LoggedValue]], nodes_of: Mapping[str, int]) -> CodeNode:
    ends = {end.place: end.names for end in node.endpoints}
    last = node.name.replace("::", ".").rpartition(".")[2]
    calls = []
    for file in sorted({node.place.file, *(place.file for place in ends)}):
        for value in by_file.get(file, ()):
            of_ends = [ends[place] for one in value.origins if (place := CodePlace(file, one.line)) in ends]
            alone = nodes_of.get(file, 0) <= 1
            recognised = any(one.recognised for one in value.origins) and (value.unit == last or alone)
            if of_ends or recognised:
                channels = tuple(sorted({name for names in of_ends for name in names}, key=str))
                calls.append(LogCall(CodePlace(file, value.line), channels, value.words))
    return node._replace(logs=tuple(calls))
