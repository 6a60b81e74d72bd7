"""What makes one kind of data of another, by the libraries that code uses: a node derives it, or is a source of it.

1. If the node reads the first kind, it derives the second one; if it brings the first one in itself, it is a source of
   the second one. If nobody knows where it has the first one from, both are ``may``; what reads ROS by itself (a
   listener of transforms) makes no source.
2. It is ``likely`` if a channel that the node writes carries the second kind by its name, or by a type that says so
   with more than ``may``. What is made of pictures is ``may`` in any case: a library finds what it was taught, and code
   says not what that is, nor how much of it goes on. A rule that says ``may`` says nothing if no such channel is
   thought to carry it.
3. Where one rule names several kinds of one broader kind (a transcript and a command, both what somebody said as text),
   the library does not say which of them goes on. So the broader kind is as sure as all is, also where the node is
   called after it, and each of them is ``may`` and agrees with no name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING
from rosprivacy.analysis.suggesting.evidence import DERIVATION, SOURCE
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.suggesting.evidence import Evidence
    from rosprivacy.analysis.suggesting.library_node import LibraryNode, Spoken

SEEN = "PersonImage"  # pictures of any sort


def made_kinds(node: LibraryNode, made: Sequence[Spoken], brought: Sequence[Spoken]) -> Iterator[Evidence]:
    """Yield which kinds a node makes of others that it reads, or that it brought in itself.

    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.hierarchy import Hierarchy
    >>> from rosprivacy.analysis.model import Category, Confidence, Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.library_node import LibraryNode, Spoken
    >>> from rosprivacy.analysis.suggesting.library_rules import LibraryRule, NodeUse
    >>> graph = factory()[0]
    >>> kinds = ("PersonImage", "Voice", "SpeechTranscript")
    >>> hierarchy = Hierarchy.of([Category(name, "", "", "", "") for name in kinds])
    >>> at = Place("libraries.yaml", 3)
    >>> node = LibraryNode.of(
    ...     graph.elements[CAMERA], Rules({}, {}, NAMES, hierarchy), [(graph.elements[VIDEO], [])], [], [], reads=False
    ... )
    >>> rule = LibraryRule(("Voice",), Confidence.LIKELY, "it writes speech down", at, to=("SpeechTranscript",))
    >>> made = [Spoken(rule, NodeUse("vosk", "python", at))]
    >>> [(one.label.role, one.label.kind, str(one.confidence)) for one in made_kinds(node, made, [])]
    [('source', 'SpeechTranscript', 'may')]
    """
    for one in made:
        broader = shared_broader(one.rule.to, node.rules.hierarchy)
        for kind in (*broader, *one.rule.to):
            if _is_said(node, one, kind):
                sure = _sureness(node, one, kind)
                which = kind not in broader and any(
                    node.rules.hierarchy.distance(kind, above) is not None for above in broader
                )
                for said in _roles(node, one, kind, Confidence.MAY if which else sure, brought):
                    yield said._replace(alone=said.alone or which)


def shared_broader(kinds: Sequence[str], hierarchy: Hierarchy) -> tuple[str, ...]:
    """Return the nearest kinds that are broader than at least two of some; never the broadest one.

    >>> from rosprivacy.analysis.hierarchy import Hierarchy
    >>> from rosprivacy.analysis.model import Category
    >>> kinds = {"Transcript": ("Text",), "Command": ("Text",), "Text": (ANYTHING,), "Voice": (ANYTHING,), ANYTHING: ()}
    >>> hierarchy = Hierarchy.of([Category(name, "", "", "", "", above) for name, above in kinds.items()])
    >>> shared_broader(("Transcript", "Command"), hierarchy), shared_broader(("Transcript", "Voice"), hierarchy)
    (('Text',), ())
    """
    above = [[one for one in hierarchy.broader(kind) if one not in (kind, ANYTHING)] for kind in kinds]
    every = dict.fromkeys(one for some in above for one in some)
    return hierarchy.narrowest(one for one in every if sum(one in some for some in above) > 1)


def _is_said(node: LibraryNode, one: Spoken, kind: str) -> bool:
    weak = one.rule.confidence is Confidence.MAY and not node.related(kind, node.out)
    any_type = one.rule.any_type and kind in node.rules.names.computed  # a picture needs its type
    return not weak and (any_type or not node.cannot_write(kind))


def _sureness(node: LibraryNode, one: Spoken, kind: str) -> Confidence:
    if node.related(SEEN, one.rule.kinds):
        return Confidence.MAY
    named = kind not in one.rule.to and node.is_named_after(kind)
    return Confidence.LIKELY if named or node.related(kind, node.told) else Confidence.MAY


def _roles(
    node: LibraryNode, one: Spoken, kind: str, sure: Confidence, brought: Sequence[Spoken]
) -> Iterator[Evidence]:
    """What the node is, by where it has the first kind from."""
    read = [first for first in one.rule.kinds if node.related(first, node.into)]
    came = _surest([first for first in brought if any(node.related(own, one.rule.kinds) for own in first.rule.kinds)])
    for first in read:
        yield one.evidence(node.label(DERIVATION, first)._replace(to=kind), sure)
    if came and not read:
        then = f"; made of what comes from {came.use.name} ({came.use.place})"
        weaker = sure if surer(came.rule.confidence, sure) else came.rule.confidence
        yield one.evidence(node.label(SOURCE, kind), weaker, then)
    if not read and not came:
        derives = node.reads or one.rule.by_itself
        first = one.rule.kinds[0]
        label = node.label(DERIVATION, first)._replace(to=kind) if derives else node.label(SOURCE, kind)
        yield one.evidence(label, Confidence.MAY, "; where it has that from is not known")


def _surest(some: Sequence[Spoken]) -> Spoken | None:
    """The first of the surest of some rules."""
    return next((one for one in some if one.rule.confidence is not Confidence.MAY), some[0] if some else None)
