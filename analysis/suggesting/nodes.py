"""What nodes do with data, by what goes in and out of them and by their names: sources, leaks, derivations, sanitizers.

A source brings data in: it writes a kind that it does not read, nor makes of what it reads. A node that reads images
and writes only identifiers derives them, and drops the images. A leak lets data out of the robot, whatever gets there.

That it brings data in is in doubt, and no more than ``may``, where its name says that it simulates or that it works on
what others bring in (a detector), where the name of the topic says that somebody made it of other data
(``debug_image``), and where it reads a topic of which nobody knows what goes through it. Of a kind that programs work
out (a pose, a map) the name of the topic says what goes through it, and not where it comes from: it agrees with
nothing, and no type makes its source certain. A goal is where the robot shall go: who writes it or asks for it is no
source of where somebody is.

A node that writes velocities has them from somewhere. If it reads no topic and serves nothing, they come from a person
(keys, a joystick, a page), or the program makes them up: so it ``may`` be a source. The same is true of such a node
that asks for a service or an action, or writes what can be anything or what somebody wants (a goal), and of which
nothing else says what it brings in: to say nothing of it would be to say that nothing comes in there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, Method, interface_of
from rosprivacy.analysis.suggesting.channels import Clue
from rosprivacy.analysis.suggesting.evidence import (
    ANYTHING,
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
from rosprivacy.analysis.suggesting.name_rules import ends_with, has_word, is_silent, of_node, words
from rosprivacy.analysis.suggesting.weighing import SURENESS, weaker

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Rules, Traffic
    from rosprivacy.analysis.suggesting.name_rules import NameRule, NameRules, Spoken

    Clues = Mapping[int, tuple[Clue, ...]]
    ByKind = dict[str, list[Clue]]
SAID, WANTED = "SpeechTranscript", "VoiceCommand"


class _Written(NamedTuple):
    """A channel that a node writes, with the names of its types, and what is thought that goes into it."""

    element: Element
    types: Sequence[str]
    clues: Sequence[Clue]


def of_nodes(graph: FlowGraph, bound: Bound, known: Traffic, clues: Clues, rules: Rules) -> Iterator[Evidence]:
    """Yield what is suggested of each node.

    Parameters
    ----------
    clues
        What types and names suggest of channels.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.channels import Rules, carried_kinds
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.channels import traffic
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
    heard = {at: _for_reader(some, names) for at, some in clues.items()}
    sent = {at: _for_writer(graph.elements[at], some, names) for at, some in heard.items()}
    unknown = _Unknown(graph, types, clues, rules)
    for vertex, element in enumerate(graph.elements):
        if not element.is_node:
            continue
        written, read = known.writes.get(vertex, ()), known.reads.get(vertex, ())
        if read and (spoken := of_node(element.name, names.lets_out)):
            reason = f"{spoken.quoted} in the name of the node: {spoken.rule.why}"
            label = Label(element, LEAK, ANYTHING)
            yield Evidence(label, NAMED, spoken.rule.confidence, reason, spoken.rule.place)
        if written:
            channels = [_Written(graph.elements[one], types.get(one, ()), sent.get(one, ())) for one in written]
            into = _by_kind(heard.get(one, ()) for one in read)
            node = _Node(element, rules, channels, into, unknown.reader(read))
            yield from node.outputs()
            yield from node.by_name()
            yield from node.understood()
            yield from node.dropped()


def unprompted(graph: FlowGraph, known: Traffic, names: NameRules) -> Iterator[Evidence]:
    """Yield what nodes bring in that write a topic of the section ``unprompted``, read none, and serve nothing.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, _ = factory()
    >>> names = replace(NAMES, unprompted={("video",): NAMES.carries["video",]})
    >>> [(one.label.element.name, one.reason) for one in unprompted(graph, traffic(graph, bound), names)]
    [('/camera', "writes 'video' (/video), and reads no topic: pictures")]
    """
    for vertex, written in known.writes.items() if names.unprompted else ():
        topics = (graph.elements[one] for one in written if graph.elements[one].kind == "topic")
        said = ((topic, spoken) for topic in topics if (spoken := of_node(topic.name, names.unprompted)))
        first = next(said, None) if _gets_nothing(vertex, graph, known) else None
        if first:
            topic, spoken = first
            because = f"writes {spoken.quoted} ({topic.name}), and reads no topic"
            yield from _unprompted(graph.elements[vertex], spoken.rule, because)


def of_the_rest(
    graph: FlowGraph, bound: Bound, known: Traffic, rules: Rules, sources: Collection[Element]
) -> Iterator[Evidence]:
    """Yield what nodes may bring in that get nothing, and of which nothing else says what they bring in.

    Parameters
    ----------
    sources
        Nodes that are suggested as sources.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Confidence, MessageType, Place, Suggestion
    >>> from rosprivacy.analysis.suggesting.channels import ANYTHING, Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, hierarchy = factory()
    >>> names = replace(NAMES, unprompted={(): NAMES.carries["video",]})
    >>> at = Place("types.yaml", 1)
    >>> free = {("a/msg/Text", ""): (Suggestion("a/msg/Text", (ANYTHING,), Confidence.MAY, "", "", at),)}
    >>> rules = Rules(free, {}, names, hierarchy)
    >>> typed = replace(bound, types={VIDEO: (MessageType("a/msg/Text", at),)})
    >>> told = traffic(graph, typed)
    >>> [one.reason for one in of_the_rest(graph, typed, told, rules, ())]
    ['writes /video, and reads no topic: pictures']
    >>> list(of_the_rest(graph, typed, told, rules, [graph.elements[CAMERA]]))
    []
    """
    rule, elements = rules.names.unprompted.get(()), graph.elements
    for vertex, written in known.writes.items() if rule else ():
        if rule and elements[vertex] not in sources and _gets_nothing(vertex, graph, known):
            free = [one for one in written if _takes_anything(one, graph, bound, rules)]
            free += [one for one in written if ends_with(elements[one].name, rules.names.wanted)]
            if free:
                does = "asks for" if elements[free[0]].leg else "writes"
                because = f"{does} {elements[free[0]].name}, and reads no topic"
                yield from _unprompted(elements[vertex], rule, because)


def broader_sources(evidence: Iterable[Evidence], rules: Rules) -> Iterator[Evidence]:
    """Yield that a node may be a source of a broader kind that is ``broadened``, for each source of a narrower one.

    What is known names one narrower kind, and persons often another one: a node that is called after a transcript often
    writes a command. So the broader kind is asked about, as long as nobody has named the narrower one.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.channels import Rules
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> graph, _, hierarchy = factory()
    >>> rules = Rules({}, {}, replace(NAMES, broadened=frozenset(["Biometric"])), hierarchy)
    >>> label = Label(graph.elements[CAMERA], "source", "FaceTemplate")
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1))]
    >>> [one.label.kind for one in broader_sources(said, rules)]
    ['Biometric']
    """
    sources = [one for one in evidence if one.label.role == SOURCE]
    labels = {one.label for one in sources}
    for one in sources:
        for kind in sorted(rules.names.broadened & rules.hierarchy.ancestors[one.label.kind].keys()):
            label = one.label._replace(kind=kind)
            if label not in labels:
                labels.add(label)
                reason = f"{one.reason}; it may also be of another sort of {kind}"
                yield Evidence(label, DATA_FLOW, Confidence.MAY, reason, one.place, beside=one.label.kind)


def _gets_nothing(vertex: int, graph: FlowGraph, known: Traffic) -> bool:
    return all(graph.elements[one].leg not in ("", "request") for one in known.reads.get(vertex, ()))


def _takes_anything(channel: int, graph: FlowGraph, bound: Bound, rules: Rules) -> bool:
    """Whether a request goes there, or a message of a type that can carry anything, or that nobody has looked at."""
    element, types = graph.elements[channel], bound.types.get(channel, ())
    if element.kind != "topic":
        return element.leg == "request"
    suggested = [rules.suggestions.get((interface_of(one.name), "")) for one in types]
    return any(one is None or any(ANYTHING in rule.kinds for rule in one) for one in suggested)


def _unprompted(element: Element, rule: NameRule, because: str) -> Iterator[Evidence]:
    for kind in rule.kinds:
        yield Evidence(Label(element, SOURCE, kind), DATA_FLOW, rule.confidence, f"{because}: {rule.why}", rule.place)


def _by_kind(channels: Iterable[Sequence[Clue]]) -> ByKind:
    """What channels are thought to carry, by kind; that they can carry anything says nothing of a node."""
    found: ByKind = {}
    for clues in channels:
        for clue in clues:
            if clue.kind != ANYTHING:
                found.setdefault(clue.kind, []).append(clue)
    return found


def _for_reader(clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """What is thought of a topic, as far as it says something of who reads it: not what only a weak type says."""
    weak = names.not_by_type - {clue.kind for clue in clues if clue.ground == NAMED}
    return tuple(clue for clue in clues if clue.kind not in weak or clue.confidence is not Confidence.MAY)


def _for_writer(channel: Element, clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """What is thought of a channel, for who writes it: what a goal or a request may carry, it does not bring in."""
    if channel.leg != "request" and not ends_with(channel.name, names.wanted):
        return clues
    return tuple(clue for clue in clues if clue.confidence is not Confidence.MAY)


def _doubtful(clue: Clue) -> Clue:
    """A clue as one that is no more than ``may``, and agrees with nothing."""
    return clue._replace(ground=DATA_FLOW, confidence=Confidence.MAY)


def _surest(clues: Sequence[Clue]) -> Clue:
    return min(clues, key=lambda one: SURENESS[one.confidence])  # of several the first


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
        written: Sequence[_Written],
        into: ByKind,
        reads_unknown: Callable[[], bool],
    ) -> None:
        self.element, self.rules, self.names, self.written = element, rules, rules.names, written
        self.out, self.into, self.reads_unknown = _by_kind(one.clues for one in written), into, reads_unknown
        self.named = of_node(element.name, rules.names.brings_in, rules.names.silent)

    def outputs(self) -> Iterator[Evidence]:
        """Yield for each kind that is written whether the node brings it in or makes it of what it reads.

        A kind that it also reads it makes again if programs work it out: where the robot is, by a scan and its wheels.
        """
        for kind, clues in self.out.items():
            made_of = self._made_of(kind)
            if self._reads(kind):
                again = [one for one in made_of if kind in self.names.computed and one not in self.names.computed]
                yield from (self._derived(one, kind, _doubtful(_surest(clues))) for one in again)
            elif made_of:
                yield from (self._derived(one, kind, _surest(clues)) for one in made_of)
            else:
                yield from self._written(kind)

    def _written(self, kind: str) -> Iterator[Evidence]:
        """Yield what its channels say of a source; only its own name, or its code, says that it brings the kind in."""
        clues = [clue for channel in self.written for clue in self._brought_in(kind, channel)]
        if self._in_doubt():
            clues = [*map(_doubtful, clues)]
        names_it = self.named is not None and self.rules.related_to_one(kind, self.named.rule.kinds)
        typed = any(clue.ground == TYPE for clue in clues)
        for clue in clues:
            by_type_only = clue.ground == TYPE and clue.confidence is Confidence.LIKELY and not names_it
            sure = Confidence.MAY if by_type_only else clue.confidence
            alone = clue.ground == NAMED and typed and not names_it
            yield Evidence(self._label(SOURCE, kind), clue.ground, sure, clue.reason, clue.place, alone=alone)

    def _brought_in(self, kind: str, channel: _Written) -> Iterator[Clue]:
        """What is thought of a channel and a kind, as far as it says that who writes it brings that in."""
        clues = [clue for clue in channel.clues if clue.kind == kind]
        others = self.names.reworked | self.names.simulated
        made = bool(clues) and any(not others.isdisjoint(part) for part in map(words, channel.element.name.split("/")))
        for clue in clues:
            if made or (kind in self.names.computed and clue.confidence is Confidence.MAY):
                yield _doubtful(clue)
            elif kind in self.names.computed:
                yield clue._replace(confidence=Confidence.LIKELY)
            else:
                yield clue

    def _made_of(self, kind: str) -> list[str]:
        return [one for one in self.into if kind in self.names.becomes.get(one, ())]

    def _derived(self, source: str, made: str, second: Clue) -> Evidence:
        first = _surest(self.into[source])
        sure = weaker(Confidence.LIKELY, weaker(first.confidence, second.confidence))
        rule = self.names.becomes[source][made]
        reason = f"reads {source} ({first.reason}) and writes {made} ({second.reason}); {rule.why}"
        label = self._label(DERIVATION, source)._replace(to=made)
        return Evidence(label, DATA_FLOW, sure, reason, rule.place)

    def by_name(self) -> Iterator[Evidence]:
        """Yield of which kinds the name of the node says that it brings them in, or makes them of what it reads.

        What it writes has to be able to carry them.
        """
        spoken = self.named
        for kind in spoken.rule.kinds if spoken else ():
            if spoken and not self._reads(kind):
                made_of = self._made_of(kind)
                stays = not made_of and self._stays(kind)
                if spoken.rule.any_type or not (stays or self._cannot_write(kind)):
                    yield from self._by_its_name(kind, spoken, made_of)

    def _by_its_name(self, kind: str, spoken: Spoken, made_of: Sequence[str]) -> Iterator[Evidence]:
        rule = spoken.rule
        clue = Clue(kind, NAMED, rule.confidence, f"{spoken.quoted} in the name of the node: {rule.why}", rule.place)
        yield from (self._derived(one, kind, clue) for one in made_of)
        if not made_of:
            clue = _doubtful(clue) if kind in self.names.computed or self._in_doubt() else clue
            yield Evidence(self._label(SOURCE, kind), clue.ground, clue.confidence, clue.reason, clue.place)

    def understood(self) -> Iterator[Evidence]:
        """Yield that what somebody said becomes a command, where a topic that is written is called so and can be it."""
        rule = self.names.becomes.get(SAID, {}).get(WANTED)
        if rule is None or SAID not in self.into or WANTED in self.out:
            return
        for element, types, _ in self.written:
            named = element.kind == "topic" and has_word(element.name, self.names.understood)
            if named and not self.rules.cannot_carry(WANTED, element, types):
                reason = f"its name, as who writes it reads {SAID}: {element.name}"
                yield self._derived(SAID, WANTED, Clue(WANTED, NAMED, Confidence.MAY, reason, rule.place))
                return

    def dropped(self) -> Iterator[Evidence]:
        """Yield the kinds that come in for sure enough and that nothing that is written is made for."""
        for kind, clues in self.into.items():
            first = _surest(clues)
            if first.ground == TYPE and first.confidence is not Confidence.MAY and self._cannot_write(kind):
                reason = f"reads {kind} ({first.reason}), and no type of what it writes is made for it"
                label = self._label(SANITIZER, kind)._replace(method=Method.DROP)
                yield Evidence(label, DATA_FLOW, Confidence.MAY, reason, first.place)

    def _in_doubt(self) -> bool:
        """Whether what it writes was perhaps not measured by it, by its name or by what it reads."""
        return has_word(self.element.name, self.names.simulated | self.names.reworking) or self.reads_unknown()

    def _stays(self, kind: str) -> bool:
        """Whether data seem to stay in the node: what it writes is made of them (a microphone that writes text)."""
        if self.rules.related_to_one(kind, self.out):
            return False
        return not self.names.becomes.get(kind, {}).keys().isdisjoint(self.out)

    def _reads(self, kind: str) -> bool:
        return self.rules.related_to_one(kind, self.into)

    def _cannot_write(self, kind: str) -> bool:
        return all(self.rules.cannot_carry(kind, element, types) for element, types, _ in self.written)

    def _label(self, role: str, kind: str) -> Label:
        return Label(self.element, role, kind)
