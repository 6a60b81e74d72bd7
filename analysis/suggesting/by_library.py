"""Evidence of libraries: what a node does with data by what its code uses; how it was attached to a node is not known
here.

In: a graph, who writes and reads what, what is thought of channels, the uses of each node, rules. Out: evidence of the
ground ``code``. The rules, in full (docs/suggestions.md):

1. What brings a kind in makes a source of a node that writes something. It is as sure as the rule says if a channel
   that the node writes is thought to carry that kind, or if it can have any form; ``may`` if nothing is known of its
   channels, if the node reads such data, too, or if its name says that it simulates. A window, or a server of pages,
   agrees with nothing (``alone``): it shows data to somebody, who may do nothing there.
2. If no channel that it writes is made for that kind by its type, the data stay in the node. What it writes of what
   they tell (a detection) comes into ROS there: the node is a source of that, as sure as the channel's type says. If it
   writes nothing of that sort, and a type only does not suggest the kind (a satellite position in a vector of three
   numbers), the node may write it even so: ``may``.
3. What makes one kind of another derives it, if the node reads the first one; if it brings the first one in itself, the
   node is a source of the second one. It is ``likely`` if a channel that the node writes carries the second one by its
   name, or by a type that says so with more than ``may``. What is made of pictures is ``may`` in any case: a library
   finds what it was taught, and code says not what that is, nor how much of it goes on. A rule that says ``may`` says
   nothing if no such channel is thought to carry it. If nobody knows where the node has the first one from, both are
   ``may``; what reads ROS by itself (a listener of transforms) makes no source.
4. What lets data out makes a leak. It is ``may`` if nothing of what the node reads is thought to carry a kind, and it
   brings in no more than what an operator does. What a driver sends to a network is ``may``: it talks with its device.
5. What a node brings in or makes, it may let out itself. So a node that writes nothing, and whose code lets data out,
   is asked about, too: 1 and 3 hold, and both are ``may``.
6. Somebody who acts on a node (keys, a window, a page) may enter what its request to a service is about, by the name of
   the service: an order, a question to a model. An order is entered at one place and told of at others: so it may be
   one, too, where a channel of the node is called after orders (``/order_status``), and where the node asks for any
   service or action in a system of which a name speaks of orders. It is ``may``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, interface_of
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, cannot_carry
from rosprivacy.analysis.suggesting.evidence import CODE, DATA_FLOW, DERIVATION, LEAK, NAMED, SOURCE, Evidence, Label
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, PROGRAM
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node, of_topic
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Clue, Rules
    from rosprivacy.analysis.suggesting.library_rules import LibraryRule, LibraryRules, Names, NodeUse
    from rosprivacy.analysis.suggesting.name_rules import NameRules
    from rosprivacy.analysis.suggesting.traffic import Traffic

ENTERED_BY = "OperatorInput"  # what says that somebody acts on a node
ORDERED = "DeliveryOrder"  # what is entered at one place and told of at others
SEEN = "PersonImage"  # pictures of any sort
FOUND = "PersonDetection"  # what pictures are mostly taken for, where they are not written
NETWORK = "network"  # where data go
_VERBS = {PROGRAM: "starts", ADDRESS: "names"}  # what code does with a thing of such a name


class Spoken(NamedTuple):
    """A rule, and a use that it speaks about."""

    rule: LibraryRule
    use: NodeUse

    def evidence(self, label: Label, sure: Confidence, then: str = "") -> Evidence:
        """Return what it says for a label: no surer than the rule."""
        sure = sure if surer(self.rule.confidence, sure) else self.rule.confidence
        name = self.use.name
        how = next((verb for sign, verb in _VERBS.items() if name.startswith(sign)), "uses")
        what = f"{how} {name[2:] if how != 'uses' else name}"
        reason = f"{what} ({self.use.place}): {self.rule.why}{then}"
        return Evidence(label, CODE, sure, reason, self.use.place, alone=self.rule.alone)


def library_evidence(
    graph: FlowGraph,
    bound: Bound,
    told: Traffic,
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

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Rules, carried_kinds
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.library_rules import LibraryRule, LibraryRules, Names, NodeUse
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> graph, bound, hierarchy = factory()
    >>> rules = Rules({}, {}, NAMES, hierarchy)
    >>> films = LibraryRule(("Video",), Confidence.LIKELY, "it opens a camera", Place("libraries.yaml", 3))
    >>> libraries = LibraryRules({"python": Names({"cv2.VideoCapture": films}, {})}, {}, {}, {})
    >>> uses = {CAMERA: [NodeUse("cv2.VideoCapture", "python", Place("camera.py", 7))]}
    >>> clues = carried_kinds(graph, bound, rules)
    >>> for one in library_evidence(graph, bound, traffic(graph, bound), clues, uses, rules, libraries):
    ...     print(one.label.element.name, one.label.role, one.label.kind, one.confidence, one.reason)
    /camera source Video likely uses cv2.VideoCapture (camera.py:7): it opens a camera
    """
    orders = _orders(graph.elements, rules.names) if uses else ()
    for vertex, own in sorted(uses.items()):
        written, read = told.writes.get(vertex, ()), told.reads.get(vertex, ())
        typed = [(graph.elements[one], [said.name for said in bound.types.get(one, ())]) for one in written]
        out, into = ([clue for one in some for clue in clues.get(one, ())] for some in (written, read))
        near = {graph.elements[one] for one in (*written, *read)}
        node = _Node(graph.elements[vertex], rules, typed, out, into, bool(read))
        brought, made, let_out = (
            _spoken(section, own, libraries) for section in (libraries.brings_in, libraries.makes, libraries.lets_out)
        )
        if written or let_out:
            yield from node.brought_in(brought, made)
            yield from node.seen(brought)
            yield from node.entered(brought)
            yield from node.ordered(brought, [one for one in orders if one in near], orders)
            yield from node.made(made, brought)
        yield from node.let_out(let_out, brought)


def _spoken(section: Mapping[str, Names], uses: Iterable[NodeUse], libraries: LibraryRules) -> tuple[Spoken, ...]:
    """The rules of a section that speak about some uses, each with the one of these that shows it best."""
    found: dict[LibraryRule, list[NodeUse]] = {}
    for use in uses:
        if rule := libraries.spoken(section, use):
            found.setdefault(rule, []).append(use)
    return tuple(Spoken(*rule.of_uses(some)) for rule, some in found.items())


def _orders(elements: Iterable[Element], names: NameRules) -> tuple[Element, ...]:
    """The elements that are called after what is ordered."""
    return tuple(
        element
        for element in elements
        if (spoken := of_node(element.name, names.brings_in if element.is_node else names.carries))
        and ORDERED in spoken.rule.kinds
    )


class _Node:
    """One node: what it is thought to write and to read."""

    def __init__(
        self,
        element: Element,
        rules: Rules,
        written: Sequence[tuple[Element, list[str]]],
        out: Sequence[Clue],
        into: Sequence[Clue],
        reads: bool,  # noqa: FBT001 - a fact, and no switch
    ) -> None:
        self.element, self.rules, self.written = element, rules, written
        self.out, self.into = ({one.kind for one in some} for some in (out, into))
        self.typed = {one.kind for one in out if one.confidence is not Confidence.MAY}
        self.told = self.typed | {one.kind for one in out if one.ground == NAMED}
        self.reads = reads
        self.simulates = has_word(element.name, rules.names.simulated)

    def brought_in(self, brought: Sequence[Spoken], made: Sequence[Spoken]) -> Iterator[Evidence]:
        """Yield of which kinds the node is a source."""
        for one in brought:
            for kind in one.rule.kinds:
                if one.rule.any_type or self._related(kind, self.out):
                    doubtful = self._related(kind, self.into) or not self.written or self.simulates
                    sure = Confidence.MAY if doubtful else one.rule.confidence
                    yield one.evidence(self._label(SOURCE, kind), sure)
                elif self._cannot_write(kind):
                    told = [*self._told_of(one, kind)]
                    yield from told
                    stays = self._is_made_of(kind, made) or self._is_limited(kind)
                    if not (told or stays or self._related(kind, self.into)):
                        yield one.evidence(self._label(SOURCE, kind), Confidence.MAY)
                elif not self._is_made_of(kind, made):
                    yield one.evidence(self._label(SOURCE, kind), Confidence.MAY)

    def seen(self, brought: Sequence[Spoken]) -> Iterator[Evidence]:
        """Yield that the node may tell of persons in pictures that it takes and does not write."""
        taken = [one for one in brought if any(self.rules.related(kind, SEEN) for kind in one.rule.kinds)][:1]
        for one in taken if self.written else ():
            if self._related(SEEN, self.out | self.into) or self._cannot_write(FOUND):
                return
            label = self._label(SOURCE, FOUND)
            yield one.evidence(label, Confidence.MAY, "; it writes no pictures")._replace(alone=True)

    def entered(self, brought: Sequence[Spoken]) -> Iterator[Evidence]:
        """Yield what somebody enters, by the services that the node asks for."""
        acted, names = self._acted(brought), self.rules.names
        for element, types in self.written if acted else ():
            spoken = of_topic(element.name, names) if element.leg == "request" else None
            for kind in spoken.rule.kinds if spoken else ():
                if kind in names.entered and not cannot_carry(kind, element, types, self.rules):
                    then = f"; it asks for {element.name}"
                    yield from (one.evidence(self._label(SOURCE, kind), Confidence.MAY, then) for one in acted)

    def ordered(
        self, brought: Sequence[Spoken], near: Sequence[Element], orders: Sequence[Element]
    ) -> Iterator[Evidence]:
        """Yield that somebody orders there, by a channel of the node, or by any name if it asks for a service.

        That name may be the node's own, and so it agrees with nothing.
        """
        asks = any(element.leg == "request" for element, _ in self.written)
        speaking = near or (orders if asks else ())
        for one in self._acted(brought) if speaking and not self._cannot_write(ORDERED) else ():
            said = one.evidence(self._label(SOURCE, ORDERED), Confidence.MAY, f"; {speaking[0].name} speaks of orders")
            yield said._replace(ground=DATA_FLOW)

    def _acted(self, brought: Sequence[Spoken]) -> Sequence[Spoken]:
        """What says first that somebody acts on the node."""
        return [one for one in brought if ENTERED_BY in one.rule.kinds][:1]

    def _told_of(self, one: Spoken, kind: str) -> Iterator[Evidence]:
        """What is written of what data tell that never come into ROS themselves."""
        becomes = {} if self._related(kind, self.into) else self.rules.names.becomes.get(kind, {})
        for other in sorted(self.out & set(becomes)):
            if not self._related(other, self.into):
                sure = one.rule.confidence if other in self.typed else Confidence.MAY
                yield one.evidence(self._label(SOURCE, other), sure, f"; it writes {other} made of it")

    def _is_made_of(self, kind: str, made: Iterable[Spoken]) -> bool:
        """Whether the node makes something of a kind that it can write; then the kind itself need not go out."""
        of_it = [one for one in made if self._related(kind, one.rule.kinds)]
        return any(not self._cannot_write(other) for one in of_it for other in one.rule.to)

    def made(self, made: Sequence[Spoken], brought: Sequence[Spoken]) -> Iterator[Evidence]:
        """Yield which kinds the node makes of others that it reads, or that it brought in itself."""
        own = {kind: one for one in brought for kind in one.rule.kinds}
        for one in made:
            read = [first for first in one.rule.kinds if self._related(first, self.into)]
            seen = self._related(SEEN, one.rule.kinds)
            came = next((own[first] for first in own if self._related(first, one.rule.kinds)), None)
            for kind in one.rule.to:
                sure = Confidence.LIKELY if not seen and self._related(kind, self.told) else Confidence.MAY
                weak = one.rule.confidence is Confidence.MAY and not self._related(kind, self.out)
                any_type = one.rule.any_type and kind in self.rules.names.computed  # a picture needs its type
                if weak or (self._cannot_write(kind) and not any_type):
                    continue
                for first in read:
                    yield one.evidence(self._derived(first, kind), sure)
                if came and not read:
                    then = f"; made of what comes from {came.use.name} ({came.use.place})"
                    weaker = sure if surer(came.rule.confidence, sure) else came.rule.confidence
                    yield one.evidence(self._label(SOURCE, kind), weaker, then)
                if not read and not came:
                    reads = self.reads or one.rule.by_itself
                    label = self._derived(one.rule.kinds[0], kind) if reads else self._label(SOURCE, kind)
                    yield one.evidence(label, Confidence.MAY, "; where it has that from is not known")

    def let_out(self, let_out: Sequence[Spoken], brought: Sequence[Spoken]) -> Iterator[Evidence]:
        """Yield what the node lets out."""
        known = bool(self.into) or any(not one.rule.any_type for one in brought)
        drives = has_word(self.element.name, self.rules.names.driving)
        for one in let_out:
            doubtful = not known or (drives and one.rule.where == NETWORK)
            for kind in one.rule.kinds:
                yield one.evidence(self._label(LEAK, kind), Confidence.MAY if doubtful else one.rule.confidence)

    def _derived(self, first: str, kind: str) -> Label:
        return self._label(DERIVATION, first)._replace(to=kind)

    def _related(self, kind: str, kinds: Iterable[str]) -> bool:
        return any(one != ANYTHING and self.rules.related(kind, one) for one in kinds)

    def _cannot_write(self, kind: str) -> bool:
        """Whether none of its channels can carry a kind; of a node that writes nothing, that is not the reason."""
        every = [cannot_carry(kind, element, types, self.rules) for element, types in self.written]
        return bool(every) and all(every)

    def _is_limited(self, kind: str) -> bool:
        """Whether the types of all that it writes exclude a kind; those that only suggest others do not."""
        keys = [(interface_of(name), element.leg) for element, types in self.written for name in types]
        limits = [self.rules.limits.get(key) for key in keys]
        return all(limit and kind in limit.kinds for limit in limits)

    def _label(self, role: str, kind: str) -> Label:
        return Label(self.element, role, kind)
