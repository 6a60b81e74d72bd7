"""Evidence of libraries: what a node does with data by what its code uses; how it was attached to a node is not known
here.

In: a graph, who writes and reads what, what is thought of channels, the uses of each node, rules. Out: evidence of the
ground ``code``. The rules, in full (docs/suggestions.md):

1. What brings a kind in makes a source of a node that writes something. It is as sure as the rule says if the type of a
   channel that the node writes is made for that kind: code and type agree then. Else it is ``may``: if only the name of
   a channel speaks of it, if it can have any form (a velocity by keys), if nothing is known of its channels, if the
   node reads such data, too, or if its name says that it simulates. If the types are known, and none is made for it,
   the name of the node agrees with nothing. Nor does a window, or a server of pages (``alone``): it shows data to
   somebody, who may do nothing there.
2. If no channel that it writes is made for that kind by its type, the data stay in the node. What it writes of what
   they tell (a detection) comes into ROS there: the node is a source of that, as sure as the channel's type says. If it
   writes nothing of that sort, and a type only does not suggest the kind (a satellite position in a vector of three
   numbers), the node may write it even so: ``may``. And what it writes may tell of persons what nobody has named
   (``tells``): where they are, what they do or said, ``may``.
3. What makes one kind of another derives it, if the node reads the first kind; if it brings that in itself, it is a
   source of the second one. If nobody knows where it has the first one from, both are ``may``; what reads ROS by itself
   (a listener of transforms) makes no source. It is ``likely`` if a channel that the node writes carries the second
   kind by its name, or by a type that says so with more than ``may``. What is made of pictures is ``may`` in any case:
   a library finds what it was taught, and code says not what that is. A rule that says ``may`` says nothing if no such
   channel is thought to carry it. Where one rule names several kinds of one broader kind (a transcript and a command),
   the library does not say which of them goes on: the broader kind is as sure as all is, also where the node is called
   after it, and each of them is ``may`` and agrees with no name.
4. What lets data out makes a leak. It is ``may`` if nothing of what the node reads is thought to carry a kind, and it
   brings in no more than what an operator does. What a driver sends to a network is ``may``: it talks with its device.
5. What a node brings in or makes, it may let out itself. So a node that writes nothing, and whose code lets data out,
   is asked about, too: 1 and 3 hold, and both are ``may``.
6. Somebody who acts on a node (keys, a window, a page) may enter what a request to a service is about, by the name of
   the service: an order, a question to a model. An order is entered at one place and told of at others: so it may be
   one, too, where a channel of the node is called after orders, and where the node asks for any service or action in a
   system of which a name speaks of orders.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, interface_of
from rosprivacy.analysis.suggesting.evidence import (
    ANYTHING,
    CODE,
    DATA_FLOW,
    DERIVATION,
    LEAK,
    NAMED,
    SOURCE,
    TYPE,
    Evidence,
    Label,
)
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, PROGRAM
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node, of_topic
from rosprivacy.analysis.suggesting.weighing import weaker

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Clue, Rules, Traffic
    from rosprivacy.analysis.suggesting.library_rules import LibraryRule, LibraryRules, Names, NodeUse
    from rosprivacy.analysis.suggesting.name_rules import NameRules

MAY = Confidence.MAY
NETWORK = "network"  # where data go
SEEN = "PersonImage"  # pictures of any sort
ENTERED_BY = "OperatorInput"  # what says that somebody acts on a node
ORDERED = "DeliveryOrder"  # what is entered at one place and told of at others
_VERBS = {PROGRAM: "starts", ADDRESS: "names"}  # what code does with a thing of such a name


class Rule(NamedTuple):
    """A rule, and a use that it speaks about."""

    rule: LibraryRule
    use: NodeUse

    def evidence(self, label: Label, sure: Confidence, then: str = "") -> Evidence:
        """Return what it says for a label: no surer than the rule."""
        name = self.use.name
        verb = next((verb for sign, verb in _VERBS.items() if name.startswith(sign)), "")
        what = f"{verb} {name[2:]}" if verb else f"uses {name}"
        reason = f"{what} ({self.use.place}): {self.rule.why}{then}"
        return Evidence(label, CODE, weaker(sure, self.rule.confidence), reason, self.use.place, alone=self.rule.alone)


def library_evidence(
    graph: FlowGraph,
    bound: Bound,
    known: Traffic,
    clues: Mapping[int, tuple[Clue, ...]],
    uses: Mapping[int, Sequence[NodeUse]],
    rules: Rules,
    libraries: LibraryRules,
) -> Iterator[Evidence]:
    """Yield what libraries say of nodes.

    Parameters
    ----------
    clues
        What types and names suggest of channels.
    uses
        By vertex of a node.

    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.channels import Rules, carried_kinds
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.library_rules import LibraryRule, LibraryRules, Names, NodeUse
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, hierarchy = factory()
    >>> rules = Rules({}, {}, NAMES, hierarchy)
    >>> films = LibraryRule(("Video",), Confidence.LIKELY, "it opens a camera", Place("libraries.yaml", 3))
    >>> libraries = LibraryRules({"python": Names({"cv2.VideoCapture": films}, {})}, {}, {}, {})
    >>> uses = {CAMERA: [NodeUse("cv2.VideoCapture", "python", Place("camera.py", 7))]}
    >>> clues = carried_kinds(graph, bound, rules)
    >>> for one in library_evidence(graph, bound, traffic(graph, bound), clues, uses, rules, libraries):
    ...     print(one.label.element.name, one.label.role, one.label.kind, one.confidence, one.reason)
    /camera source Video may uses cv2.VideoCapture (camera.py:7): it opens a camera
    """
    orders = _orders(graph.elements, rules.names) if uses else ()
    for vertex, own in sorted(uses.items()):
        written, read = known.writes.get(vertex, ()), known.reads.get(vertex, ())
        typed = [(graph.elements[one], [said.name for said in bound.types.get(one, ())]) for one in written]
        out, into = ([clue for one in some for clue in clues.get(one, ())] for some in (written, read))
        sections = (libraries.brings_in, libraries.makes, libraries.lets_out)
        speaking = (tuple(_speaking(section, own, libraries)) for section in sections)
        node = _Node(graph.elements[vertex], rules, typed, out, into, *speaking, reads=bool(read))
        if written or node.lets_out:
            near = {graph.elements[one] for one in (*written, *read)}
            yield from node.sources()
            yield from node.telling()
            yield from node.entered()
            yield from node.ordered([one for one in orders if one in near], orders)
            yield from node.made_kinds()
        yield from node.leaks()


def _shared_broader(kinds: Sequence[str], hierarchy: Hierarchy) -> tuple[str, ...]:
    """Return the nearest kinds that are broader than at least two of some; never the broadest one.

    >>> from rosprivacy.analysis.hierarchy import Hierarchy
    >>> from rosprivacy.analysis.model import Category
    >>> kinds = {"Transcript": ("Text",), "Command": ("Text",), "Text": (ANYTHING,), "Voice": (ANYTHING,), ANYTHING: ()}
    >>> hierarchy = Hierarchy.of([Category(name, "", "", "", "", above) for name, above in kinds.items()])
    >>> _shared_broader(("Transcript", "Command"), hierarchy), _shared_broader(("Transcript", "Voice"), hierarchy)
    (('Text',), ())
    """
    above = [[one for one in hierarchy.broader(kind) if one not in (kind, ANYTHING)] for kind in kinds]
    every = dict.fromkeys(one for some in above for one in some)
    return hierarchy.narrowest(one for one in every if sum(one in some for some in above) > 1)


def _speaking(section: Mapping[str, Names], uses: Iterable[NodeUse], libraries: LibraryRules) -> Iterator[Rule]:
    """The rules of a section that speak about some uses, each with the one of these that shows it best."""
    found: dict[LibraryRule, list[NodeUse]] = {}
    for use in uses:
        if rule := libraries.spoken(section, use):
            found.setdefault(rule, []).append(use)
    return (Rule(*rule.of_uses(some)) for rule, some in found.items())


def _orders(elements: Iterable[Element], names: NameRules) -> tuple[Element, ...]:
    """The elements that are called after what is ordered."""
    return tuple(
        element
        for element in elements
        if (spoken := of_node(element.name, names.brings_in if element.is_node else names.carries))
        and ORDERED in spoken.rule.kinds
    )


class _Node:
    """One node: the rules that speak about its code, and what it is thought to write and to read."""

    def __init__(
        self,
        element: Element,
        rules: Rules,
        written: Sequence[tuple[Element, Sequence[str]]],
        out: Sequence[Clue],
        into: Iterable[Clue],
        brings_in: Sequence[Rule],
        makes: Sequence[Rule],
        lets_out: Sequence[Rule],
        *,
        reads: bool,
    ) -> None:
        self.element, self.rules, self.names, self.written, self.reads = element, rules, rules.names, written, reads
        self.brings_in, self.makes, self.lets_out = brings_in, makes, lets_out
        self.out, self.into = {one.kind for one in out}, {one.kind for one in into}
        self.by_type = {one.kind for one in out if one.ground == TYPE}
        self.sure = {one.kind for one in out if one.confidence is not MAY}
        self.named = self.sure.union(one.kind for one in out if one.ground == NAMED)
        self.typed_all = bool(written) and all(types for _, types in written)
        self.keys = [(interface_of(name), channel.leg) for channel, types in written for name in types]
        self.acted = [one for one in brings_in if ENTERED_BY in one.rule.kinds][:1]  # first that somebody acts on it

    def sources(self) -> Iterator[Evidence]:
        """Yield of which kinds the node is a source."""
        simulates = has_word(self.element.name, self.names.simulated)
        for one in self.brings_in:
            for kind in one.rule.kinds:
                label = self._label(SOURCE, kind)
                if one.rule.any_type or self._related(kind, self.out):
                    by_type = self._related(kind, self.by_type)
                    doubtful = not by_type or simulates or self._related(kind, self.into)
                    said = one.evidence(label, MAY if doubtful else one.rule.confidence)
                    other_types = self.typed_all and not by_type and not one.rule.any_type
                    yield said._replace(alone=said.alone or other_types)
                elif self._cannot_write(kind):
                    yield from self._of_what_stays(one, kind)
                elif not self._is_made_of(kind):
                    yield one.evidence(label, MAY)

    def _of_what_stays(self, one: Rule, kind: str) -> Iterator[Evidence]:
        """Yield what is written of what data tell that never come into ROS themselves; or that they may even so."""
        if self._related(kind, self.into):
            return
        made = sorted(self.out & set(self.names.becomes.get(kind, ())))
        written = [other for other in made if not self._related(other, self.into)]
        for other in written:
            sure = one.rule.confidence if other in self.sure else MAY
            yield one.evidence(self._label(SOURCE, other), sure, f"; it writes {other} made of it")
        limited = all(self.rules.limited(kind, key) for key in self.keys)
        if not (written or limited or self._is_made_of(kind)):
            yield one.evidence(self._label(SOURCE, kind), MAY)

    def _is_made_of(self, kind: str) -> bool:
        """Whether the node makes something of a kind that it can write; then the kind itself need not go out."""
        of_it = [one for one in self.makes if self._related(kind, one.rule.kinds)]
        return any(not self._cannot_write(other) for one in of_it for other in one.rule.to)

    def telling(self) -> Iterator[Evidence]:
        """Yield what the node may tell of persons by what it writes of data that it takes or makes, and does not read.

        Where it writes the data themselves, only if it also writes what can be anything; of what it makes, only if it
        reads nothing that it can be made of.
        """
        suggested = [rule for key in self.keys for rule in self.rules.suggestions.get(key, ())]
        anything = any(ANYTHING in rule.kinds for rule in suggested)
        for first, tells in self.names.tells.items() if self.written else ():
            taken = next((one for one in self.brings_in if self._related(first, one.rule.kinds)), None)
            one = taken or next((one for one in self.makes if first in one.rule.to), None)
            if one is None or self._related(first, self.into) or (self._related(first, self.by_type) and not anything):
                continue
            for kind, rule in tells.items():
                if taken or not (ANYTHING in self.into or self._related(kind, self.into)):
                    yield one.evidence(self._label(SOURCE, kind), MAY, f"; {rule.why}")._replace(alone=True)

    def entered(self) -> Iterator[Evidence]:
        """Yield what somebody enters, by the services that the node asks for."""
        for channel, types in self.written if self.acted else ():
            spoken = of_topic(channel.name, self.names) if channel.leg == "request" else None
            for kind in spoken.rule.kinds if spoken else ():
                if kind in self.names.entered and not self.rules.cannot_carry(kind, channel, types):
                    then = f"; it asks for {channel.name}"
                    yield from (one.evidence(self._label(SOURCE, kind), MAY, then) for one in self.acted)

    def ordered(self, near: Sequence[Element], orders: Sequence[Element]) -> Iterator[Evidence]:
        """Yield that somebody orders there, by a channel of the node, or by any name if it asks for a service.

        That name may be the node's own, and so it agrees with nothing.

        Parameters
        ----------
        near, orders
            What is called after orders: of the channels of the node, and of the whole system.
        """
        asks = any(channel.leg == "request" for channel, _ in self.written)
        speaking = near or (orders if asks else ())
        for one in self.acted if speaking and not self._cannot_write(ORDERED) else ():
            said = one.evidence(self._label(SOURCE, ORDERED), MAY, f"; {speaking[0].name} speaks of orders")
            yield said._replace(ground=DATA_FLOW)

    def leaks(self) -> Iterator[Evidence]:
        """Yield what the node lets out."""
        brought = any(not one.rule.any_type for one in self.brings_in)
        drives = has_word(self.element.name, self.names.driving)
        for one in self.lets_out:
            doubtful = not (self.into or brought) or (drives and one.rule.where == NETWORK)
            for kind in one.rule.kinds:
                yield one.evidence(self._label(LEAK, kind), MAY if doubtful else one.rule.confidence)

    def made_kinds(self) -> Iterator[Evidence]:
        """Yield which kinds a node makes of others that it reads, or that it brought in itself."""
        for one in self.makes:
            broader = _shared_broader(one.rule.to, self.rules.hierarchy)
            narrower = [
                kind
                for kind in one.rule.to
                if any(self.rules.hierarchy.distance(kind, of) is not None for of in broader)
            ]
            for kind in (*broader, *one.rule.to):
                if self._is_said(one, kind):
                    which = kind not in broader and kind in narrower
                    for said in self._roles(one, kind, MAY if which else self._how_sure(one, kind)):
                        yield said._replace(alone=said.alone or which)

    def _is_said(self, one: Rule, kind: str) -> bool:
        weak = one.rule.confidence is MAY and not self._related(kind, self.out)
        any_type = one.rule.any_type and kind in self.names.computed  # a picture needs its type
        return not weak and (any_type or not self._cannot_write(kind))

    def _how_sure(self, one: Rule, kind: str) -> Confidence:
        if self._related(SEEN, one.rule.kinds):
            return MAY
        own = of_node(self.element.name, self.names.brings_in) if kind not in one.rule.to else None
        named = own is not None and self._related(kind, own.rule.kinds)
        return Confidence.LIKELY if named or self._related(kind, self.named) else MAY

    def _roles(self, one: Rule, kind: str, sure: Confidence) -> Iterator[Evidence]:
        """What the node is, by where it has the first kind from."""
        read = [first for first in one.rule.kinds if self._related(first, self.into)]
        came = [rule for rule in self.brings_in if any(self._related(own, one.rule.kinds) for own in rule.rule.kinds)]
        for first in read:
            yield one.evidence(self._label(DERIVATION, first, kind), sure)
        if came and not read:
            of = next((rule for rule in came if rule.rule.confidence is not MAY), came[0])
            then = f"; made of what comes from {of.use.name} ({of.use.place})"
            yield one.evidence(self._label(SOURCE, kind), weaker(sure, of.rule.confidence), then)
        if not read and not came:
            derives = self.reads or one.rule.by_itself
            label = self._label(DERIVATION, one.rule.kinds[0], kind) if derives else self._label(SOURCE, kind)
            yield one.evidence(label, MAY, "; where it has that from is not known")

    def _related(self, kind: str, kinds: Iterable[str]) -> bool:
        """Whether data of a kind can be of one of some others; that they can be anything says nothing."""
        return self.rules.related_to_one(kind, (one for one in kinds if one != ANYTHING))

    def _cannot_write(self, kind: str) -> bool:
        """Whether none of its channels can carry a kind; of a node that writes nothing, that is not so."""
        return bool(self.written) and all(
            self.rules.cannot_carry(kind, channel, types) for channel, types in self.written
        )

    def _label(self, role: str, kind: str, to: str = "") -> Label:
        return Label(self.element, role, kind, to=to)
