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
3. What makes one kind of another derives it (``made_kinds``).
4. What lets data out makes a leak. It is ``may`` if nothing of what the node reads is thought to carry a kind, and it
   brings in no more than what an operator does. What a driver sends to a network is ``may``: it talks with its device.
5. What a node brings in or makes, it may let out itself. So a node that writes nothing, and whose code lets data out,
   is asked about, too: 1 and 3 hold, and both are ``may``.
6. Somebody who acts on a node may enter an order, or a question to a model (``entered_data``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING
from rosprivacy.analysis.suggesting.entered_data import entered, ordered, orders_of
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE
from rosprivacy.analysis.suggesting.library_node import LibraryNode, Spoken
from rosprivacy.analysis.suggesting.made_kinds import made_kinds
from rosprivacy.analysis.suggesting.name_rules import has_word

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Clue, Rules
    from rosprivacy.analysis.suggesting.evidence import Evidence
    from rosprivacy.analysis.suggesting.library_rules import LibraryRule, LibraryRules, Names, NodeUse
    from rosprivacy.analysis.suggesting.traffic import Traffic

NETWORK = "network"  # where data go


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
    /camera source Video may uses cv2.VideoCapture (camera.py:7): it opens a camera
    """
    orders = orders_of(graph.elements, rules.names) if uses else ()
    for vertex, own in sorted(uses.items()):
        written, read = told.writes.get(vertex, ()), told.reads.get(vertex, ())
        typed = [(graph.elements[one], [said.name for said in bound.types.get(one, ())]) for one in written]
        out, into = ([clue for one in some for clue in clues.get(one, ())] for some in (written, read))
        near = {graph.elements[one] for one in (*written, *read)}
        node = LibraryNode.of(graph.elements[vertex], rules, typed, out, into, reads=bool(read))
        brought, made, let_out = (
            _spoken(section, own, libraries) for section in (libraries.brings_in, libraries.makes, libraries.lets_out)
        )
        if written or let_out:
            yield from _brought_in(node, brought, made)
            yield from _telling(node, brought, made)
            yield from entered(node, brought)
            yield from ordered(node, brought, [one for one in orders if one in near], orders)
            yield from made_kinds(node, made, brought)
        yield from _let_out(node, let_out, brought)


def _spoken(section: Mapping[str, Names], uses: Iterable[NodeUse], libraries: LibraryRules) -> tuple[Spoken, ...]:
    """The rules of a section that speak about some uses, each with the one of these that shows it best."""
    found: dict[LibraryRule, list[NodeUse]] = {}
    for use in uses:
        if rule := libraries.spoken(section, use):
            found.setdefault(rule, []).append(use)
    return tuple(Spoken(*rule.of_uses(some)) for rule, some in found.items())


def _brought_in(node: LibraryNode, brought: Sequence[Spoken], made: Sequence[Spoken]) -> Iterator[Evidence]:
    """Yield of which kinds the node is a source."""
    for one in brought:
        for kind in one.rule.kinds:
            label = node.label(SOURCE, kind)
            if one.rule.any_type or node.related(kind, node.out):
                by_type = node.related(kind, node.by_type)
                doubtful = not by_type or node.related(kind, node.into) or node.simulates
                said = one.evidence(label, Confidence.MAY if doubtful else one.rule.confidence)
                other_types = node.typed_all and not by_type and not one.rule.any_type
                yield said._replace(alone=said.alone or other_types)
            elif node.cannot_write(kind):
                told = [*_told_of(node, one, kind)]
                yield from told
                stays = _is_made_of(node, kind, made) or node.is_limited(kind)
                if not (told or stays or node.related(kind, node.into)):
                    yield one.evidence(label, Confidence.MAY)
            elif not _is_made_of(node, kind, made):
                yield one.evidence(label, Confidence.MAY)


def _told_of(node: LibraryNode, one: Spoken, kind: str) -> Iterator[Evidence]:
    """What is written of what data tell that never come into ROS themselves."""
    becomes = {} if node.related(kind, node.into) else node.rules.names.becomes.get(kind, {})
    for other in sorted(node.out & set(becomes)):
        if not node.related(other, node.into):
            sure = one.rule.confidence if other in node.surely_typed else Confidence.MAY
            yield one.evidence(node.label(SOURCE, other), sure, f"; it writes {other} made of it")


def _is_made_of(node: LibraryNode, kind: str, made: Iterable[Spoken]) -> bool:
    """Whether the node makes something of a kind that it can write; then the kind itself need not go out."""
    of_it = [one for one in made if node.related(kind, one.rule.kinds)]
    return any(not node.cannot_write(other) for one in of_it for other in one.rule.to)


def _telling(node: LibraryNode, brought: Sequence[Spoken], made: Sequence[Spoken]) -> Iterator[Evidence]:
    """Yield what the node may tell of persons by what it writes of data that it takes or makes, and does not read.

    Where it writes the data themselves, only if it also writes what can be anything; of what it makes, only if it reads
    nothing that it can be made of.
    """
    for first, tells in node.rules.names.tells.items() if node.written else ():
        taken = next((one for one in brought if node.related(first, one.rule.kinds)), None)
        makes = next((one for one in made if first in one.rule.to), None)
        said = taken or makes
        if said is None or node.related(first, node.into):
            continue
        if node.related(first, node.by_type) and not node.writes_anything():
            continue
        for kind, rule in tells.items():
            if taken or not (ANYTHING in node.into or node.related(kind, node.into)):
                told = said.evidence(node.label(SOURCE, kind), Confidence.MAY, f"; {rule.why}")
                yield told._replace(alone=True)


def _let_out(node: LibraryNode, let_out: Sequence[Spoken], brought: Sequence[Spoken]) -> Iterator[Evidence]:
    """Yield what the node lets out."""
    known = bool(node.into) or any(not one.rule.any_type for one in brought)
    drives = has_word(node.element.name, node.rules.names.driving)
    for one in let_out:
        doubtful = not known or (drives and one.rule.where == NETWORK)
        for kind in one.rule.kinds:
            yield one.evidence(node.label(LEAK, kind), Confidence.MAY if doubtful else one.rule.confidence)
