"""What nodes do with data, by what goes in and out of them and by their names: sources, leaks, derivations, sanitizers.

A source brings data in: it writes a kind that it does not read, nor makes of what it reads. A node that reads images
and writes only identifiers derives them, and drops the images. A leak lets data out of the robot, whatever gets there.

That it brings data in is in doubt, and no more than ``may``, where its name says that it simulates, and where the name
of the topic says that somebody made it of other data (``debug_image``). Of a kind that programs work out (a pose, a
map) the name of the topic says what goes through it, and not where it comes from: it agrees with nothing. A goal is
where the robot shall go: who writes it is no source of where somebody is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence, Method
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, Clue, cannot_carry
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
from rosprivacy.analysis.suggesting.name_rules import ends_with, has_word, of_node
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Rules
    from rosprivacy.analysis.suggesting.name_rules import Spoken
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
        into = _by_kind([_of_node(clues[one], rules) for one in read if one in clues])
        if read and (spoken := of_node(element.name, rules.names.lets_out)):
            reason = f"'{'_'.join(spoken.words)}' in the name of the node: {spoken.rule.why}"
            label = Label(element, LEAK, ANYTHING)
            yield Evidence(label, NAMED, spoken.rule.confidence, reason, spoken.rule.place)
        if written:
            typed = [(graph.elements[one], [said.name for said in bound.types.get(one, ())]) for one in written]
            told_of = [(graph.elements[one].name, clues[one]) for one in written if one in clues]
            carried = [(name, _of_writer(name, some, rules)) for name, some in told_of]
            brought = _by_kind([_brought_in(element.name, name, some, rules) for name, some in carried])
            node = _Node(element, rules, typed, _by_kind([some for _, some in carried]), brought, into)
            yield from node.outputs()
            yield from node.by_name()
            yield from node.dropped()


def _by_kind(clues: Sequence[tuple[Clue, ...]]) -> ByKind:
    """What channels are thought to carry; that they can carry anything says nothing of a node."""
    found: ByKind = {}
    for some in clues:
        for clue in some:
            if clue.kind != ANYTHING:
                found.setdefault(clue.kind, []).append(clue)
    return found


def _of_node(clues: tuple[Clue, ...], rules: Rules) -> tuple[Clue, ...]:
    """What is thought of a topic, as far as it says something of who writes or reads it."""
    alone = rules.names.not_by_type
    if not any(clue.kind in alone for clue in clues):
        return clues
    alone -= {clue.kind for clue in clues if clue.ground == NAMED}
    return tuple(clue for clue in clues if clue.kind not in alone or clue.confidence is not Confidence.MAY)


def _of_writer(topic: str, clues: tuple[Clue, ...], rules: Rules) -> tuple[Clue, ...]:
    """What is thought of a topic, for who writes it: what a goal may carry, it does not bring in."""
    if not ends_with(topic, rules.names.wanted):
        return _of_node(clues, rules)
    return tuple(clue for clue in _of_node(clues, rules) if clue.confidence is not Confidence.MAY)


def _brought_in(node: str, topic: str, clues: tuple[Clue, ...], rules: Rules) -> tuple[Clue, ...]:
    """What is thought of a topic, as far as it says that who writes it brings it in."""
    names = rules.names
    if has_word(node, names.simulated) or has_word(topic, names.reworked):
        return tuple(clue._replace(ground=DATA_FLOW, confidence=Confidence.MAY) for clue in clues)
    return tuple(
        clue._replace(ground=DATA_FLOW) if clue.ground == NAMED and clue.kind in names.computed else clue
        for clue in clues
    )


class _Node:
    """One node: what it is thought to write, how far that speaks of a source, and what it is thought to read."""

    def __init__(
        self, element: Element, rules: Rules, written: Typed, out: ByKind, brought: ByKind, into: ByKind
    ) -> None:
        self.element, self.rules, self.written = element, rules, written
        self.out, self.brought, self.into = out, brought, into

    def outputs(self) -> Iterator[Evidence]:
        """Yield for each kind that is written whether the node brings it in or makes it of what it reads."""
        for kind, clues in self.out.items():
            if self._reads(kind):
                continue
            made_of = self._made_of(kind)
            for one in made_of:
                yield self._derived(one, kind, surest(clues))
            if not made_of:
                for clue in self.brought[kind]:
                    yield Evidence(self._label(SOURCE, kind), clue.ground, clue.confidence, clue.reason, clue.place)

    def _made_of(self, kind: str) -> list[str]:
        return [one for one in self.into if kind in self.rules.names.becomes.get(one, ())]

    def _derived(self, source: str, made: str, second: Clue) -> Evidence:
        first = surest(self.into[source])
        sure = first.confidence if surer(second.confidence, first.confidence) else second.confidence
        sure = Confidence.LIKELY if sure is Confidence.CERTAIN else sure
        rule = self.rules.names.becomes[source][made]
        reason = f"reads {source} ({first.reason}) and writes {made} ({second.reason}); {rule.why}"
        label = Label(self.element, DERIVATION, source, to=made)
        return Evidence(label, DATA_FLOW, sure, reason, rule.place)

    def by_name(self) -> Iterator[Evidence]:
        """Yield of which kinds the name of the node says that it brings them in, or makes them of what it reads.

        What it writes has to be able to carry them.
        """
        names = self.rules.names
        spoken = of_node(self.element.name, names.brings_in, names.silent)
        for kind in spoken.rule.kinds if spoken else ():
            if spoken and not self._reads(kind) and (spoken.rule.any_type or not self._cannot_write(kind)):
                yield from self._by_its_name(kind, spoken)

    def _by_its_name(self, kind: str, spoken: Spoken) -> Iterator[Evidence]:
        rule = spoken.rule
        reason = f"'{'_'.join(spoken.words)}' in the name of the node: {rule.why}"
        made_of = self._made_of(kind)
        for one in made_of:
            yield self._derived(one, kind, Clue(kind, NAMED, rule.confidence, reason, rule.place))
        if not made_of:
            simulated = has_word(self.element.name, self.rules.names.simulated)
            ground, sure = (DATA_FLOW, Confidence.MAY) if simulated else (NAMED, rule.confidence)
            yield Evidence(self._label(SOURCE, kind), ground, sure, reason, rule.place)

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
