"""What labels take away of the data that a newly accepted label brings: they were said when nobody knew of that.

In: the labels that were accepted; the answers before and after, or, where no policies are named, the label files alone.
Out: remarks, one line each. No label is refused by it and no verdict changes: a person has said both. But who accepted
a ``never`` when there was no source was told of no finding, and who accepts the source has to hear of the ``never``.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.search import present, search
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.ingest.suggestions.accepting import LIMITING
from rosprivacy.ingest.suggestions.choosing import overlap

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.meeting import Meeting
    from rosprivacy.analysis.model import Element, Statement
    from rosprivacy.analysis.suggesting.written import WrittenLabel
    from rosprivacy.analysis.whatif.ledger import TakenAway
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.suggestions.accepting import NewLabel
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result

    Said = TypeVar("Said", NewLabel, WrittenLabel)
    What = tuple[object, ...]  # what one row takes away of one kind, whatever the line is that says so

BRINGING = ("source", "derives", "leak")
HINT = "see whether it is still so"
LOOK = "name the policies as well, and what of it is on the way is told"


def brings(labels: Iterable[Said]) -> tuple[Said, ...]:
    """Return the labels by which there are data, or an end of data, that were not there."""
    return tuple(one for one in labels if any(role in BRINGING for role in one.said))


def limits_on_the_way(before: Result, after: Result) -> Iterator[str]:
    """Yield what labels take away after that they did not take away before, one line each.

    What is taken away of a new source is new, also where the same line took the same kind of another source before.
    """
    old = {what for row in before.taken_away for what, _ in _whats(row)}
    new = _newly_there(before, after)
    for row in after.taken_away:
        there = new.get(row.element, ()) if row.element else ()
        kinds = [kind for what, kind in _whats(row) if what not in old or kind in there]
        if kinds and row.by in LIMITING and row.element:
            to = f" -> {shown(row.to.name)}" if row.to else ""
            end = f"; behind it lies the leak {shown(row.leak.name)}" if row.leak else ""
            where = f"{row.element.kind} {shown(row.element.name)}{to}"
            at = ", ".join(map(str, row.places))
            yield f"{at}: {row.by} of {where} takes {', '.join(kinds)} away, which is accepted now{end}; {HINT}"


def _newly_there(before: Result, after: Result) -> Mapping[Element, Collection[str]]:
    """Where data of sources gets that were no sources of it before, kind by kind: at limits, too, where it ends."""
    old, new = before.analysis.spread, after.analysis.spread
    known = {old.graph.elements[vertex]: set(old.names(old.begins(vertex))) for vertex in old.facts}
    starts: dict[int, list[int]] = defaultdict(list)  # by the bits that are followed
    elements, net = new.graph.elements, Net.kept(new)
    for vertex in sorted(new.facts):
        begun = set(new.names(new.begins(vertex)))
        again = begun & known.get(elements[vertex], set())
        if begun - again:
            starts[new.all_bits & ~sum(map(new.both, again))].append(vertex)
    found: dict[Element, set[str]] = defaultdict(set)
    for bits, some in starts.items():
        reach = search(net, some, bits, {})
        for vertex, there in _reached(net, reach, bits):
            found[elements[vertex]].update(new.names(there))
    return found


def _reached(net: Net, reach: Search, allowed: int) -> Iterator[tuple[int, int]]:
    """Vertices and the bits that get there, also where nothing of them is taken up: there limits are."""
    spread = net.spread
    met: dict[int, tuple[Meeting, int]] = {}
    for vertex in {*reach.seen, *reach.begun}:
        yield vertex, present(reach, vertex)
    for vertex in {*reach.gone, *reach.begun}:
        leaving = reach.gone.get(vertex, 0)
        for index, target, _ in net.flows.get(vertex, ()):
            begun = spread.flow_emits.get(index, 0) & allowed if vertex in reach.begun else 0
            yield target, (leaving | begun) & spread.flow_keeps.get(index, spread.all_bits)
        for meeting in net.meetings.get(vertex, ()):
            met[id(meeting)] = meeting, met.get(id(meeting), (meeting, 0))[1] | leaving
    for meeting, bits in met.values():
        yield from ((target, bits) for target in meeting.read)


def limits_said(accepted: Sequence[NewLabel], files: Iterable[Labels], vocabulary: Vocabulary) -> Iterator[str]:
    """Yield what label files take away of data that accepted labels are about: where, nobody knows without policies."""
    for file in files:
        said = [(one, shown(entry.name)) for entry in file.entries for one in entry.statements]
        said += [
            (one, f"{shown(flow.source)} -> {shown(flow.target)}") for flow in file.flows for one in flow.statements
        ]
        there = [
            f"{one.role} of {name} (line {one.place.line})"
            for one, name in said
            if one.role in LIMITING and any(_limits(one, label, vocabulary) for label in accepted)
        ]
        if there:
            what = ", ".join(dict.fromkeys(kind for label in accepted for kind in _kinds(label)))
            yield f"{file.file}: {what} is accepted, and such data may be taken away by {', '.join(there)}; {LOOK}"


def _limits(said: Statement, label: NewLabel, vocabulary: Vocabulary) -> bool:
    """Whether a statement may take away data that a label is about."""
    if said.role == "only":
        kinds = [vocabulary.find(kind) for kind in _kinds(label)]
        through = set(said.categories)
        return any(not kind or not through & set(vocabulary.hierarchy.ancestors[kind.name]) for kind in kinds)
    return not said.categories or overlap(list(said.categories), _kinds(label), vocabulary)


def _kinds(label: NewLabel) -> list[str]:
    """What there is more of: of a derivation what it makes."""
    ((_, value),) = label.said.items()
    return [str(one["to"] if isinstance(one, dict) else one) for one in value]


def _whats(row: TakenAway) -> Iterator[tuple[What, str]]:
    for kind in row.categories:
        yield (row.by, row.element, row.to, kind, row.leak), kind
