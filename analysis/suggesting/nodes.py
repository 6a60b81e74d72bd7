"""What nodes do with data, by what goes in and out of them and by their names: sources, leaks, derivations, sanitizers.

A source brings data in: it writes a kind that it does not read, nor makes of what it reads. A node that reads images
and writes only identifiers derives them, and drops the images. A leak lets data out of the robot, whatever gets there.

That it brings data in is in doubt, and no more than ``may``, where its name says that it simulates or that it works on
what others bring in (a detector), where the name of the topic says that somebody made it of other data
(``debug_image``), and where it reads a topic of which nobody knows what goes through it. Of a kind that programs work
out (a pose, a map) the name of the topic says what goes through it, and not where it comes from: it agrees with
nothing, and no type makes its source certain. A goal is where the robot shall go: who writes it or asks for it is no
source of where somebody is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence, Method, interface_of
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, Clue, cannot_carry
from rosprivacy.analysis.suggesting.clues_of_nodes import (
    WrittenChannel,
    brought_in,
    by_kind,
    doubtful,
    of_reader,
    of_writer,
    surest,
)
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
from rosprivacy.analysis.suggesting.name_rules import has_word, is_silent, of_node
from rosprivacy.analysis.suggesting.weighing import surer

SAID, WANTED = "SpeechTranscript", "VoiceCommand"

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Rules
    from rosprivacy.analysis.suggesting.clues_of_nodes import ByKind
    from rosprivacy.analysis.suggesting.name_rules import Spoken
    from rosprivacy.analysis.suggesting.traffic import Traffic

    Clues = Mapping[int, tuple[Clue, ...]]


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
    names, types = rules.names, {at: [said.name for said in some] for at, some in bound.types.items()}
    heard = {at: of_reader(some, names) for at, some in clues.items()}
    sent = {at: of_writer(graph.elements[at], some, names) for at, some in heard.items()}
    unknown = _Unknown(graph, types, clues, rules)
    for vertex, element in enumerate(graph.elements):
        if not element.is_node:
            continue
        written, read = told.writes.get(vertex, ()), told.reads.get(vertex, ())
        if read and (spoken := of_node(element.name, names.lets_out)):
            reason = f"'{'_'.join(spoken.words)}' in the name of the node: {spoken.rule.why}"
            label = Label(element, LEAK, ANYTHING)
            yield Evidence(label, NAMED, spoken.rule.confidence, reason, spoken.rule.place)
        if written:
            channels = [WrittenChannel(graph.elements[one], types.get(one, ()), sent.get(one, ())) for one in written]
            into = by_kind(heard.get(one, ()) for one in read)
            node = _Node(element, rules, channels, into, unknown.reader(read))
            yield from node.outputs()
            yield from node.by_name()
            yield from node.understood()
            yield from node.dropped()


class _Unknown:
    """Topics of which nobody knows what goes through them, or that can carry anything; each is looked at once."""

    def __init__(self, graph: FlowGraph, types: Mapping[int, Sequence[str]], clues: Clues, rules: Rules) -> None:
        self._elements, self._types, self._clues, self._rules = graph.elements, types, clues, rules
        self._holds: dict[int, bool] = {}

    def reader(self, read: Sequence[int]) -> Callable[[], bool]:
        """Return what tells of a node that reads some channels whether it reads one of these."""
        return lambda: any(map(self._anything, read))

    def _anything(self, channel: int) -> bool:
        if channel not in self._holds:
            self._holds[channel] = self._looked_at(channel)
        return self._holds[channel]

    def _looked_at(self, channel: int) -> bool:
        element, types = self._elements[channel], self._types.get(channel, ())
        if element.kind != "topic" or is_silent(element.name, self._rules.names):
            return False
        if any(clue.kind == ANYTHING for clue in self._clues.get(channel, ())):
            return True
        return not types or any((interface_of(name), "") not in self._rules.suggestions for name in types)


class _Node:
    """One node: what it is thought to write, how far that speaks of a source, and what it is thought to read."""

    def __init__(
        self,
        element: Element,
        rules: Rules,
        written: Sequence[WrittenChannel],
        into: ByKind,
        reads_unknown: Callable[[], bool],
    ) -> None:
        self.element, self.rules, self.written = element, rules, written
        self.out, self.into, self.reads_unknown = by_kind(one.clues for one in written), into, reads_unknown
        self.named = of_node(element.name, rules.names.brings_in, rules.names.silent)

    def outputs(self) -> Iterator[Evidence]:
        """Yield for each kind that is written whether the node brings it in or makes it of what it reads."""
        for kind, clues in self.out.items():
            made_of = self._made_of(kind)
            if self._reads(kind):
                yield from self._made_again(kind, clues, made_of)
                continue
            for one in made_of:
                yield self._derived(one, kind, surest(clues))
            if not made_of:
                yield from self._written(kind)

    def _written(self, kind: str) -> Iterator[Evidence]:
        """Yield what its channels say of a source; only its own name, or its code, says that it brings the kind in."""
        clues = [clue for channel in self.written for clue in brought_in(kind, channel, self.rules.names)]
        clues = [*map(doubtful, clues)] if self._in_doubt() else clues
        names_it = self.named is not None and self.rules.related_to_one(kind, self.named.rule.kinds)
        typed = any(clue.ground == TYPE for clue in clues)
        for clue in clues:
            weaker = clue.ground == TYPE and clue.confidence is Confidence.LIKELY and not names_it
            sure = Confidence.MAY if weaker else clue.confidence
            alone = clue.ground == NAMED and typed and not names_it
            label = self._label(SOURCE, kind)
            yield Evidence(label, clue.ground, sure, clue.reason, clue.place, alone=alone)

    def _made_again(self, kind: str, clues: Sequence[Clue], made_of: Sequence[str]) -> Iterator[Evidence]:
        """Yield what is made of what sensors say and of the same kind: where the robot is, by a scan and its wheels."""
        computed = self.rules.names.computed
        for one in made_of:
            if kind in computed and one not in computed:
                yield self._derived(one, kind, surest(clues))._replace(confidence=Confidence.MAY)

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
        spoken = self.named
        if spoken is None:
            return
        for kind in spoken.rule.kinds:
            if self._reads(kind):
                continue
            made_of = self._made_of(kind)
            stays = not made_of and self._stays(kind)
            if spoken.rule.any_type or not (stays or self._cannot_write(kind)):
                yield from self._by_its_name(kind, spoken, made_of)

    def _by_its_name(self, kind: str, spoken: Spoken, made_of: Sequence[str]) -> Iterator[Evidence]:
        rule = spoken.rule
        reason = f"'{'_'.join(spoken.words)}' in the name of the node: {rule.why}"
        for one in made_of:
            yield self._derived(one, kind, Clue(kind, NAMED, rule.confidence, reason, rule.place))
        if not made_of:
            alone = kind in self.rules.names.computed or self._in_doubt()
            ground, sure = (DATA_FLOW, Confidence.MAY) if alone else (NAMED, rule.confidence)
            yield Evidence(self._label(SOURCE, kind), ground, sure, reason, rule.place)

    def understood(self) -> Iterator[Evidence]:
        """Yield that what somebody said becomes a command, where a topic that is written is called so and can be it."""
        names, rule = self.rules.names, self.rules.names.becomes.get(SAID, {}).get(WANTED)
        if rule is None or SAID not in self.into or WANTED in self.out:
            return
        for element, types, _ in self.written:
            said = element.kind == "topic" and has_word(element.name, names.understood)
            if said and not cannot_carry(WANTED, element, types, self.rules):
                reason = f"its name, as who writes it reads {SAID}: {element.name}"
                yield self._derived(SAID, WANTED, Clue(WANTED, NAMED, Confidence.MAY, reason, rule.place))
                return

    def dropped(self) -> Iterator[Evidence]:
        """Yield the kinds that come in for sure enough and that nothing that is written is made for."""
        for kind, clues in self.into.items():
            first = surest(clues)
            if first.ground == TYPE and first.confidence is not Confidence.MAY and self._cannot_write(kind):
                reason = f"reads {kind} ({first.reason}), and no type of what it writes is made for it"
                label = self._label(SANITIZER, kind)._replace(method=Method.DROP)
                yield Evidence(label, DATA_FLOW, Confidence.MAY, reason, first.place)

    def _in_doubt(self) -> bool:
        """Whether what it writes was perhaps not measured by it, by its name or by what it reads."""
        name, names = self.element.name, self.rules.names
        return has_word(name, names.simulated) or has_word(name, names.reworking) or self.reads_unknown()

    def _stays(self, kind: str) -> bool:
        """Whether data seem to stay in the node: what it writes is made of them (a microphone that writes text)."""
        if self.rules.related_to_one(kind, self.out):
            return False
        return not self.rules.names.becomes.get(kind, {}).keys().isdisjoint(self.out)

    def _reads(self, kind: str) -> bool:
        return self.rules.related_to_one(kind, self.into)

    def _cannot_write(self, kind: str) -> bool:
        return all(cannot_carry(kind, element, types, self.rules) for element, types, _ in self.written)

    def _label(self, role: str, kind: str) -> Label:
        return Label(self.element, role, kind)
