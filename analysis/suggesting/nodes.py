"""What nodes do with data, by what goes in and out of them and by their names: sources, leaks, derivations, sanitizers.

A source brings data in: it writes a kind that it does not read, nor makes of what it reads. A node that reads images
and writes only identifiers derives them, and drops the images. A leak lets data out of the robot, whatever gets there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence, Method
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, cannot_carry
from rosprivacy.analysis.suggesting.evidence import (
    DATA_FLOW,
    DERIVATION,
    LEAK,
    NAMED,
    SANITIZER,
    SOURCE,
    TYPE,
    Evidence,
    Label,
)
from rosprivacy.analysis.suggesting.name_rules import of_node
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Clue, Rules
    from rosprivacy.analysis.suggesting.traffic import Traffic

    Clues = Mapping[int, tuple[Clue, ...]]
    ByKind = dict[str, list[Clue]]
    Typed = Sequence[tuple[Element, list[str]]]  # channels with the names of their types


def of_nodes(graph: FlowGraph, bound: Bound, told: Traffic, clues: Clues, rules: Rules) -> Iterator[Evidence]:
    """Yield what is suggested of each node.

    Parameters
    ----------
    clues
        What types and names suggest of channels.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Rules, carried_kinds
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> graph, bound, hierarchy = factory()
    >>> rules = Rules({}, {}, NAMES, hierarchy)
    >>> said = of_nodes(graph, bound, traffic(graph, bound), carried_kinds(graph, bound, rules), rules)
    >>> for one in said:
    ...     print(one.label.element.name, one.label.role, one.label.kind, one.label.to or one.reason)
    /archive leak PersonalData 'archive' in the name of the node: it keeps what it gets
    /camera source Video 'video' in the name /video
    /camera source Video 'camera' in the name of the node: pictures
    /face_id derivation Video FaceTemplate
    """
    for vertex, element in enumerate(graph.elements):
        if not element.is_node:
            continue
        written, read = told.writes.get(vertex, ()), told.reads.get(vertex, ())
        typed = [(graph.elements[one], [said.name for said in bound.types.get(one, ())]) for one in written]
        node = _Node(element, rules, typed, _by_kind(written, clues), _by_kind(read, clues))
        if read and (spoken := of_node(element.name, rules.names.lets_out)):
            reason = f"'{'_'.join(spoken.words)}' in the name of the node: {spoken.rule.why}"
            label = Label(element, LEAK, ANYTHING)
            yield Evidence(label, NAMED, spoken.rule.confidence, reason, spoken.rule.place)
        if written:
            yield from node.outputs()
            yield from node.by_name()
            yield from node.dropped()


def _by_kind(channels: Sequence[int], clues: Clues) -> ByKind:
    """What channels are thought to carry; that they can carry anything says nothing of a node."""
    found: ByKind = {}
    for channel in channels:
        for clue in clues.get(channel, ()):
            if clue.kind != ANYTHING:
                found.setdefault(clue.kind, []).append(clue)
    return found


class _Node:
    """One node: what it is thought to write and to read."""

    def __init__(self, element: Element, rules: Rules, written: Typed, out: ByKind, into: ByKind) -> None:
        self.element, self.rules, self.written, self.out, self.into = element, rules, written, out, into

    def outputs(self) -> Iterator[Evidence]:
        """Yield for each kind that is written whether the node brings it in or makes it of what it reads."""
        for kind, clues in self.out.items():
            if self._reads(kind):
                continue
            made_of = [one for one in self.into if kind in self.rules.names.becomes.get(one, ())]
            for one in made_of:
                yield self._derived(one, kind)
            if not made_of:
                for clue in clues:
                    yield Evidence(self._label(SOURCE, kind), clue.ground, clue.confidence, clue.reason, clue.place)

    def _derived(self, source: str, made: str) -> Evidence:
        first, second = surest(self.into[source]), surest(self.out[made])
        sure = first.confidence if surer(second.confidence, first.confidence) else second.confidence
        sure = Confidence.LIKELY if sure is Confidence.CERTAIN else sure
        rule = self.rules.names.becomes[source][made]
        reason = f"reads {source} ({first.reason}) and writes {made} ({second.reason}); {rule.why}"
        return Evidence(self._label(DERIVATION, source)._replace(to=made), DATA_FLOW, sure, reason, rule.place)

    def by_name(self) -> Iterator[Evidence]:
        """Yield of which kinds the name of the node says that it brings them in; what it writes has to be able to."""
        spoken = of_node(self.element.name, self.rules.names.brings_in)
        for kind in spoken.rule.kinds if spoken else ():
            if spoken and not self._reads(kind) and not self._cannot_write(kind):
                reason = f"'{'_'.join(spoken.words)}' in the name of the node: {spoken.rule.why}"
                yield Evidence(self._label(SOURCE, kind), NAMED, spoken.rule.confidence, reason, spoken.rule.place)

    def dropped(self) -> Iterator[Evidence]:
        """Yield the kinds that come in for sure enough and that nothing that is written is made for."""
        for kind, clues in self.into.items():
            first = surest(clues)
            if first.ground == TYPE and first.confidence is not Confidence.MAY and self._cannot_write(kind):
                reason = f"reads {kind} ({first.reason}), and no type of what it writes is made for it"
                label = self._label(SANITIZER, kind)._replace(method=Method.DROP)
                yield Evidence(label, DATA_FLOW, Confidence.MAY, reason, first.place)

    def _reads(self, kind: str) -> bool:
        return any(self.rules.related(kind, one) for one in self.into)

    def _cannot_write(self, kind: str) -> bool:
        return all(cannot_carry(kind, element, types, self.rules) for element, types in self.written)

    def _label(self, role: str, kind: str) -> Label:
        return Label(self.element, role, kind)


def surest(clues: Sequence[Clue]) -> Clue:
    """Return the surest of some clues, of several the first.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> one = Clue("Video", "name", Confidence.MAY, "a word", Place("names.yaml", 1))
    >>> surest([one, one._replace(confidence=Confidence.LIKELY)]).confidence.value
    'likely'
    """
    first = clues[0]
    for clue in clues[1:]:
        if surer(clue.confidence, first.confidence):
            first = clue
    return first
