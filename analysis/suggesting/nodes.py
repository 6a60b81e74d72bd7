"""What nodes do with data, by the types and names of their channels, their own names, and the libraries they use.

A *source* writes a kind that it neither reads nor makes of what it reads: by the type of a channel, by its name, by the
node's own name, or by a library that takes it in. What a library takes in and no channel can carry stays in the node:
the node is a source of what it writes that is made of it. A *derivation* is a kind that is read and another one that is
made of it (``becomes``, or a library). A *leak* is a node whose name says that data leave the robot, or whose code lets
them out. A *sanitizer* reads a kind for sure and writes nothing that is made for it.

How sure all reasons together are is said by the table of ``weighing.py``. A reason agrees with no other one (``alone``)
where it does not say that the node itself measured the data: the name of a topic; anything of a node that simulates, of
a kind that it reads, too, or that programs work out (``computed``); a name where the types are known and none is made
for the kind.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, Method, interface_of
from rosprivacy.analysis.suggesting.channels import Clue
from rosprivacy.analysis.suggesting.evidence import (
    ANYTHING,
    CODE,
    DATA_FLOW,
    DERIVATION,
    LEAK,
    NAMED,
    SANITIZER,
    SOURCE,
    TYPE,
    Evidence,
    SuggestedLabel,
)
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node
from rosprivacy.analysis.suggesting.weighing import SURENESS, weaker

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Rules, Traffic
    from rosprivacy.analysis.suggesting.library_rules import LibraryRules, NodeUse, RuleOfUse
    from rosprivacy.analysis.suggesting.name_rules import NameRule, NameRules

    Clues = Mapping[int, tuple[Clue, ...]]
MAY, LIKELY = Confidence.MAY, Confidence.LIKELY
PICTURES = "PersonImage"  # of any sort: what is made of them depends on what a detector was taught
SPEECH, COMMAND = "SpeechTranscript", "VoiceCommand"


def node_evidence(
    graph: FlowGraph,
    bound: Bound,
    ends: Traffic,
    clues: Clues,
    rules: Rules,
    uses: Mapping[int, Sequence[NodeUse]],
    libraries: LibraryRules,
    sources: Collection[Element] = (),
) -> Iterator[Evidence]:
    """Yield what is suggested of each node.

    Parameters
    ----------
    clues
        What types and names suggest of channels.
    uses
        By vertex of a node: what its code uses of libraries.
    sources
        Nodes of which packages say what they bring in.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.channels import Rules, carried_kinds, traffic
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    >>> graph, bound, hierarchy = factory()
    >>> rules = Rules({}, {}, NAMES, hierarchy)
    >>> clues = carried_kinds(graph, bound, rules)
    >>> found = node_evidence(graph, bound, traffic(graph, bound), clues, rules, {}, LibraryRules({}, {}, {}, {}))
    >>> for one in found:
    ...     print(one.label.element.name, one.label.role, one.label.kind, one.label.to or one.reason)
    /archive leak PersonalData 'archive' in the name of the node: it keeps what it gets
    /camera source Video 'video' in the name /video
    /camera source Video 'camera' in the name of the node: pictures
    /face_id derivation Video FaceTemplate
    """
    heard = {at: _for_nodes(of_channel, rules.names) for at, of_channel in clues.items()}
    sent = {at: _for_writers(graph.elements[at], of_channel, rules.names) for at, of_channel in heard.items()}
    for vertex, element in enumerate(graph.elements):
        if not element.is_node:
            continue
        read = ends.reads.get(vertex, ())
        into = [clue for at in read for clue in heard.get(at, ())]
        written = [
            _Channel(graph.elements[at], [one.name for one in bound.types.get(at, ())], sent.get(at, ()))
            for at in ends.writes.get(vertex, ())
        ]
        node = _Node(element, rules, written, into, libraries.of_node(uses.get(vertex, ())), reads=bool(read))
        yield from node.leaks()
        found = [*node.sources(), *node.derivations()] if written or node.lets_out else []
        yield from found
        yield from node.dropped() if written else ()
        if written and all(graph.elements[at].leg not in ("", "request") for at in read):  # it gets nothing
            other = element in sources or any(one.label.role == SOURCE for one in found)
            yield from node.unprompted(nothing_else=not other)


class _Channel(NamedTuple):
    """A channel that a node writes, with the names of its types, and what is thought that goes into it."""

    element: Element
    types: Sequence[str]
    clues: Sequence[Clue]


class _Node:
    """One node: what it is thought to write and to read, and which rules speak about its code."""

    def __init__(
        self,
        element: Element,
        rules: Rules,
        written: Sequence[_Channel],
        into: Sequence[Clue],
        uses: Mapping[str, Sequence[RuleOfUse]],
        *,
        reads: bool,
    ) -> None:
        self.element, self.rules, self.names, self.written, self.reads = element, rules, rules.names, written, reads
        self.brings_in, self.makes, self.lets_out = (uses[one] for one in ("brings_in", "makes", "lets_out"))
        self.out, self.into = (_by_kind(clues) for clues in ([clue for one in written for clue in one.clues], into))
        self.typed = {kind for kind, clues in self.out.items() if any(one.ground == TYPE for one in clues)}
        self.hears = bool(into)
        self.reads_anything = any(clue.kind == ANYTHING for clue in into)
        self.simulates = has_word(element.name, self.names.simulated)
        self.name_clues = list(self._clues_of_name()) if written else []

    def _clues_of_name(self) -> Iterator[Clue]:
        """Yield what the node's own name says that it writes, and that its channels can carry."""
        named = of_node(self.element.name, self.names.brings_in, self.names.silent)
        for kind in named.rule.kinds if named else ():
            if named and (named.rule.any_type or not self._cannot_write(kind)):
                reason = f"{named.quoted} in the name of the node: {named.rule.why}"
                yield Clue(kind, NAMED, named.rule.confidence, reason, named.rule.place)

    def leaks(self) -> Iterator[Evidence]:
        """Yield what the node lets out: by its name only if it reads something."""
        named = of_node(self.element.name, self.names.lets_out) if self.reads else None
        if named:
            reason = f"{named.quoted} in the name of the node: {named.rule.why}"
            label, rule = SuggestedLabel(self.element, LEAK, ANYTHING), named.rule
            yield Evidence(label, NAMED, rule.confidence, reason, rule.place, where=rule.where)
        personal = self.hears or any(not one.rule.any_type for one in self.brings_in)
        for one in self.lets_out:
            yield from (
                one.evidence(SuggestedLabel(self.element, LEAK, kind), MAY if not personal else LIKELY)
                for kind in one.rule.kinds
            )

    def sources(self) -> Iterator[Evidence]:
        """Yield of which kinds the node is a source."""
        for channel in self.written:
            simulated = has_word(channel.element.name, self.names.simulated)
            for clue in channel.clues:
                if clue.kind != ANYTHING and not self._reads(clue.kind) and not self._made_of(clue.kind):
                    said = Evidence(self._label(clue.kind), *clue[1:], alone=clue.ground == NAMED)
                    yield self._agreeing(said, doubtful=simulated)
        yield from self._by_name()
        for use in self.brings_in:
            for kind in use.rule.kinds:
                yield from self._by_code(use, kind)
        yield from self._of_persons()

    def _by_name(self) -> Iterator[Evidence]:
        for clue in self.name_clues:
            if not self._reads(clue.kind) and not self._made_of(clue.kind):
                yield self._agreeing(Evidence(self._label(clue.kind), *clue[1:]))

    def _by_code(self, use: RuleOfUse, kind: str) -> Iterator[Evidence]:
        """Yield what the node brings in by a library; what cannot be written is the source of what is made of it."""
        if use.rule.any_type or not self._cannot_write(kind):
            typed = self._related(kind, self.typed) or use.rule.any_type
            refuted = not typed and bool(self.written) and all(one.types for one in self.written)
            sure = LIKELY if self._related(kind, self.typed) else MAY
            yield self._agreeing(use.evidence(self._label(kind), sure), doubtful=refuted)
        elif not self._reads(kind):
            results = sorted(self.out.keys() & self.names.becomes.get(kind, {}).keys())
            for made in results:
                if not self._reads(made):
                    then = f"; it writes {made} made of it"
                    yield self._agreeing(use.evidence(self._label(made), MAY, then))
            keys = [(interface_of(name), one.element.leg) for one in self.written for name in one.types]
            if not (results or all(self.rules.limited(kind, key) for key in keys)):
                yield use.evidence(self._label(kind), MAY)._replace(alone=True)

    def _of_persons(self) -> Iterator[Evidence]:
        """Yield what the node may tell of persons by data that it takes or makes, and does not read (``tells``).

        Where it writes the data themselves, only if it also writes what can be anything.
        """
        if not self.written or not (self.brings_in or self.makes):
            return
        anything = any(clue.kind == ANYTHING for one in self.written for clue in one.clues)
        for first, tells in self.names.tells.items():
            taken = next((one for one in self.brings_in if self._related(first, one.rule.kinds)), None)
            use = taken or next((one for one in self.makes if first in one.rule.to), None)
            if use is None or self._reads(first) or (self._related(first, self.typed) and not anything):
                continue
            for kind, rule in tells.items():
                if taken or not (self.reads_anything or self._reads(kind)):
                    yield use.evidence(self._label(kind), MAY, f"; {rule.why}")._replace(alone=True)

    def unprompted(self, *, nothing_else: bool) -> Iterator[Evidence]:
        """Yield what a node brings in that gets nothing: by a topic that it writes, or since it asks for something.

        Parameters
        ----------
        nothing_else
            Whether nothing says what it brings in; then a request, or what can be anything, comes from somewhere.
        """
        topics = [one.element for one in self.written if one.element.kind == "topic"]
        for topic in topics:
            if spoken := of_node(topic.name, self.names.unprompted):
                yield from self._unprompted(spoken.rule, f"writes {spoken.quoted} ({topic.name})")
                return
        rule = self.names.unprompted.get(())
        free = next((one for one in self.written if self._takes_anything(one)), None)
        if rule and free and nothing_else:
            yield from self._unprompted(rule, f"{'asks for' if free.element.leg else 'writes'} {free.element.name}")

    def _unprompted(self, rule: NameRule, does: str) -> Iterator[Evidence]:
        reason = f"{does}, and reads no topic: {rule.why}"
        yield from (Evidence(self._label(kind), DATA_FLOW, rule.confidence, reason, rule.place) for kind in rule.kinds)

    def _takes_anything(self, channel: _Channel) -> bool:
        """Whether a request goes there, or a message that can be anything, or that nobody has looked at."""
        if channel.element.kind != "topic":
            return channel.element.leg == "request"
        suggested = [self.rules.suggestions.get((interface_of(name), "")) for name in channel.types]
        return any(one is None or any(ANYTHING in rule.kinds for rule in one) for one in suggested)

    def derivations(self) -> Iterator[Evidence]:
        """Yield which kinds the node makes of others; of what it brought in itself, it is a source of the second."""
        for kind, clues in self.out.items():
            first = clues[0]
            for one in self._made_of(kind):
                if not self._reads(kind):
                    yield self._derived(one, kind, first.confidence, first.reason)
                elif kind in self.names.computed and one not in self.names.computed:
                    yield self._derived(one, kind, MAY, first.reason)
        for clue in self.name_clues:
            if not self._reads(clue.kind):
                yield from (self._derived(one, clue.kind, MAY, clue.reason) for one in self._made_of(clue.kind))
        for use in self.makes:
            for kind in use.rule.to:
                yield from self._by_library(use, kind)
        yield from self._understood()

    def _derived(self, source: str, result: str, sure: Confidence, why: str) -> Evidence:
        first, rule = self.into[source][0], self.names.becomes[source][result]
        reason = f"reads {source} ({first.reason}) and writes {result} ({why}); {rule.why}"
        sure = weaker(LIKELY, weaker(first.confidence, sure))
        return Evidence(self._label(source, result), DATA_FLOW, sure, reason, rule.place)

    def _by_library(self, use: RuleOfUse, kind: str) -> Iterator[Evidence]:
        """Yield that a library makes a kind: likely where a channel carries it by its name or by a sure type."""
        speaking = [clue for one in self.out if self._related(kind, [one]) for clue in self.out[one]]
        any_type = use.rule.any_type and kind in self.names.computed
        if (self._cannot_write(kind) and not any_type) or (use.rule.confidence is MAY and not speaking):
            return
        surely = any(one.ground == NAMED or one.confidence is not MAY for one in speaking)
        sure = LIKELY if surely and not self._related(PICTURES, use.rule.kinds) else MAY
        read = [one for one in use.rule.kinds if self._reads(one)]
        own = next((one for one in self.brings_in if self._overlap(one.rule.kinds, use.rule.kinds)), None)
        if read:
            yield from (use.evidence(self._label(one, kind), sure) for one in read)
        elif own:
            then = f"; made of what comes from {own.use.name} ({own.use.place})"
            yield self._agreeing(use.evidence(self._label(kind), MAY, then))
        else:
            label = self._label(use.rule.kinds[0], kind) if self.reads or use.rule.by_itself else self._label(kind)
            yield use.evidence(label, MAY, "; where it has that from is not known")._replace(alone=True)

    def _understood(self) -> Iterator[Evidence]:
        """Yield that what somebody said becomes a command, where a topic that is written is called so and can be it."""
        if COMMAND not in self.names.becomes.get(SPEECH, {}) or SPEECH not in self.into or COMMAND in self.out:
            return
        for element, types, _ in self.written:
            named = element.kind == "topic" and has_word(element.name, self.names.understood)
            if named and not self.rules.cannot_carry(COMMAND, element, types):
                yield self._derived(SPEECH, COMMAND, MAY, f"its name, as who writes it reads {SPEECH}: {element.name}")
                return

    def dropped(self) -> Iterator[Evidence]:
        """Yield the kinds that come in for sure enough and that nothing that is written is made for."""
        for kind, clues in self.into.items():
            first = clues[0]
            if first.ground == TYPE and first.confidence is not MAY and self._cannot_write(kind):
                reason = f"reads {kind} ({first.reason}), and no type of what it writes is made for it"
                label = SuggestedLabel(self.element, SANITIZER, kind, Method.DROP)
                yield Evidence(label, DATA_FLOW, MAY, reason, first.place)

    def _agreeing(self, reason: Evidence, *, doubtful: bool = False) -> Evidence:
        """A reason for a source; one in doubt is no more than may, and agrees with no other one."""
        computed = self._computed(reason.label.kind) and reason.ground != CODE
        if doubtful or computed or self.simulates or self._reads(reason.label.kind):
            return reason._replace(confidence=MAY, alone=True)
        return reason

    def _computed(self, kind: str) -> bool:
        return kind in self.names.computed

    def _made_of(self, kind: str) -> list[str]:
        return [one for one in self.into if kind in self.names.becomes.get(one, ())]

    def _reads(self, kind: str) -> bool:
        return self._related(kind, self.into)

    def _related(self, kind: str, kinds: Iterable[str]) -> bool:
        return self.rules.related_to_one(kind, kinds)

    def _overlap(self, first: Iterable[str], second: Sequence[str]) -> bool:
        return any(self._related(kind, second) for kind in first)

    def _cannot_write(self, kind: str) -> bool:
        """Whether none of its channels can carry a kind; of a node that writes nothing, that is not so."""
        return bool(self.written) and all(self.rules.cannot_carry(kind, one, types) for one, types, _ in self.written)

    def _label(self, kind: str, to: str = "") -> SuggestedLabel:
        return SuggestedLabel(self.element, DERIVATION if to else SOURCE, kind, to=to)


def _by_kind(clues: Iterable[Clue]) -> dict[str, list[Clue]]:
    """What channels are thought to carry, by kind, the surest first; that they can carry anything says nothing."""
    found: dict[str, list[Clue]] = {}
    for clue in clues:
        if clue.kind != ANYTHING:
            found.setdefault(clue.kind, []).append(clue)
    return {kind: sorted(of_kind, key=lambda one: SURENESS[one.confidence]) for kind, of_kind in found.items()}


def _for_nodes(clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """What is thought of a channel, as far as it says something of nodes: not what only a weak type says."""
    weak = names.not_by_type - {clue.kind for clue in clues if clue.ground == NAMED}
    return tuple(clue for clue in clues if clue.kind not in weak or clue.confidence is not MAY)


def _for_writers(channel: Element, clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """What is thought of a channel, for who writes it: what a goal may carry is where somebody wants the robot."""
    if not of_node(channel.name, names.unprompted):
        return clues
    return tuple(clue for clue in clues if clue.confidence is not MAY or clue.kind == ANYTHING)
