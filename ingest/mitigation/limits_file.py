"""Limits files -> ``Limits``: what may be changed to remove findings, where, and at what cost.

In: YAML or JSON in the format of ``docs/mitigation.md``, and the graph that it is about. Out: limits by vertex and
flow. All problems of a file are raised at once; a name that matches nothing is one of them (rule S11).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, fields
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, LimitsError, shown
from rosprivacy.analysis.mitigation.limits import CHANGES, LARGEST_COST, LimitRule, Limits, Weights
from rosprivacy.analysis.written_names import A_LITTLE, FEW, bare_name, did_you_mean, literal, nearest
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.reading.format_reader import FileReader, read_values

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.ingest.reading.yaml_values import Value

TOP = ("limits", "time_critical", "weights", "places")
PLACE = ("at", "from", "to", "never", "factor", "note")


def read_limits(file: str, graph: FlowGraph, bounds: Bounds = BOUNDS) -> Limits:
    """Read one limits file and join it to a graph.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``LimitsError`` of one line.
    """
    top, _ = read_values(file, partial(LimitsError, file), bounds)
    reader = _LimitsReader(file, graph)
    return reader.whole(reader.document(top))


@dataclass
class _LimitsReader(FileReader):
    """One limits file."""

    graph: FlowGraph
    error: type[InputError] = field(default=LimitsError, kw_only=True)
    by_name: dict[str, list[int]] = field(default_factory=lambda: defaultdict(list))

    def __post_init__(self) -> None:
        for vertex, element in enumerate(self.graph.elements):
            self.by_name[element.name].append(vertex)

    def document(self, top: Value) -> Limits:
        if not self.is_format(top, "limits", "a limits file"):
            return Limits()
        said = self.values_of(top, TOP)
        critical = [v for item in self._items(said, "time_critical") for v in self._nodes(item)]
        rules = [rule for item in self._items(said, "places") for rule in self._place(item)]
        return Limits(self._weights(said.get("weights")), critical=frozenset(critical), rules=tuple(rules))

    def _nodes(self, item: Value) -> list[int]:
        found = self._vertices(item)
        channels = [v for v in found if self.graph.elements[v].is_channel]
        if channels and len(channels) == len(found):
            what = f"{shown(item.text)!r} is a {self.graph.elements[channels[0]].kind}"
            self.problem(item.line, what, "name the node that must not wait")
        return [v for v in found if v not in channels]

    def _weights(self, value: Value | None) -> Weights:
        names = [one.name for one in fields(Weights)]
        if value is None or value.kind == "empty":
            return Weights()
        if value.kind != "map":
            self.problem(value.line, f"weights is a map, not a {value.kind}", "write {filter: 10}")
            return Weights()
        return Weights(**{key: self._number(item, key) for key, _, item in self.entries_of(value, tuple(names))})

    def _place(self, item: Value) -> Iterator[LimitRule]:
        if item.kind != "map":
            self.problem(item.line, f"a place is a map, not a {item.kind}", "write {at: /a, never: all}")
            return
        said = self.values_of(item, PLACE)
        if "at" in said and not {"from", "to"} & set(said):
            vertices = frozenset(self._vertices(said["at"]))
            flows = [f for f, flow in enumerate(self.graph.flows) if {flow.source, flow.target} & vertices]
        elif {"from", "to"} <= set(said) and "at" not in said:
            vertices = frozenset[int]()
            sources, targets = (frozenset(self._vertices(said[key])) for key in ("from", "to"))
            between = enumerate(self.graph.flows)
            flows = [f for f, flow in between if flow.source in sources and flow.target in targets]
            if sources and targets and not flows:
                what = f"no flow goes from {shown(said['from'].text)!r} to {shown(said['to'].text)!r}"
                self.problem(item.line, what, "name two elements with a flow between them, in its direction")
        else:
            self.problem(item.line, "a place needs at, or from and to", "write {at: /a, never: all}")
            return
        if not {"never", "factor"} & set(said):
            self.problem(item.line, "a place without never or factor says nothing", "write {at: /a, never: all}")
        never = frozenset(self._kinds(said["never"])) if "never" in said else frozenset[str]()
        factor = self._number(said["factor"], "factor") if "factor" in said else 1
        yield LimitRule(frozenset(flows), vertices, never, factor)

    def _kinds(self, value: Value) -> Iterator[str]:
        """Kinds of change, ``all`` of them, or one."""
        if value.kind == "text" and value.text == "all":
            yield from CHANGES
            return
        for item in value.items if value.kind == "list" else (value,):
            if item.kind == "text" and item.text in CHANGES:
                yield item.text
            else:
                what = f"{shown(item.text or item.kind)!r} is not a kind of change"
                self.problem(item.line, what, f"write all, or a list of {', '.join(CHANGES)}")

    def _number(self, value: Value, key: str) -> int:
        plain = value.kind == "number" and value.text.isascii() and value.text.isdigit()
        number = int(value.text) if plain and len(value.text) <= len(str(LARGEST_COST)) else 0
        if not 1 <= number <= LARGEST_COST:
            problem = f"{key} is {shown(value.text or value.kind)!r}"
            self.problem(value.line, problem, f"write a whole number from 1 to {LARGEST_COST}")
            return 1
        return number

    def _vertices(self, item: Value) -> list[int]:
        """The elements that a name or glob covers."""
        if item.kind != "text":
            self.problem(item.line, f"a {item.kind} where an element is named", "write its name, such as /camera")
            return []
        name = item.text
        found = sorted(v for other in covered(name, self.by_name) for v in self.by_name[other])
        if not found:
            close = [literal(other) for other in nearest(bare_name(name), self.by_name, FEW, A_LITTLE)]
            hint = did_you_mean(close, "name an element of the system")
            self.problem(item.line, f"{shown(name)!r} matches no element of the system", hint)
        return found

    def _items(self, entries: Mapping[str, Value], key: str) -> tuple[Value, ...]:
        return self.list_of(entries[key], key) if key in entries else ()
