"""A system of which little is said yet -> what gets out of it if suggestions are right; nothing is written.

In: an answer, as it is stated. Out: ``Trial``. The verdict stays that of what is stated, and at best undetermined.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.type_limits import under_limits
from rosprivacy.analysis.suggesting.channels import traffic
from rosprivacy.analysis.suggesting.data_ends import data_ends, only_reads, unlikely_kinds
from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, PACKAGE, SOURCE, written
from rosprivacy.analysis.suggesting.trial import MAKING, opening, ways_out
from rosprivacy.labelling.asking import with_more
from rosprivacy.labelling.knowledge import NO_FILES, what_is_known
from rosprivacy.labelling.suggesting import suggested_by

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.evidence import LabelProposal
    from rosprivacy.analysis.suggesting.trial import WayOut
    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

ORIGIN = "what is suggested"  # in place of the name of a label file


class Trial(NamedTuple):
    """What comes of a system if suggestions are right.

    Attributes
    ----------
    stated
        The answer without them, which is the answer.
    supposed
        The proposals that count: none of them closes a way.
    left_out
        Proposals of the same sort that go against what is stated.
    unsure
        Proposals of what may bring data in or make it; beside a surer source none of them counts.
    ways
        Places where data gets out, what weighs most first.
    ends
        Nodes at which data ends and of which nobody says what they do with it, in the same order.
    unreached
        Elements that let data out, if suggestions are right, and that nothing gets to as far as it is known.
    unknown
        Further nodes of which neither labels nor suggestions say what they do with data that they get; first those that
        only read, then those that get the heaviest data.
    """

    stated: Result
    supposed: tuple[LabelProposal, ...]
    left_out: tuple[LabelProposal, ...]
    unsure: tuple[LabelProposal, ...]
    ways: tuple[WayOut, ...]
    ends: tuple[WayOut, ...]
    unreached: tuple[Element, ...]
    unknown: tuple[Element, ...]


def tried(stated: Result, settings: Settings, files: UserFiles = NO_FILES) -> Trial:
    """Return what comes of a system if suggestions are right.

    Parameters
    ----------
    stated
        Of a robot, read from files.

    Raises
    ------
    InputErrors
        With every problem of the rules and packages.
    """
    vocabulary = stated.vocabulary
    knowledge = what_is_known(vocabulary, settings, files)
    proposals = suggested_by(knowledge, stated, files.sources).proposals
    candidates = opening(proposals, sourced=bool(stated.analysis.emitted))
    fitting, after = supposed(stated, candidates)
    silent = _silent(stated, proposals, fitting)
    graph, limits = after.analysis.graph, unlikely_kinds(knowledge.rules, vocabulary.categories)
    carried = spread(graph, under_limits(graph, after.bound, vocabulary.hierarchy, limits), vocabulary.hierarchy)
    ending = tuple(data_ends(carried, traffic(graph, after.bound), silent))
    both = (*fitting, *ending)
    whole = _with(stated, both)
    under = under_limits(graph, whole.bound, vocabulary.hierarchy, limits)
    likely = {finding.id: finding for finding in analyse(graph, under, vocabulary.hierarchy).findings}
    stands = frozenset(finding.id for finding in stated.analysis.findings)
    ways = ways_out(whole.analysis.findings, both, vocabulary.categories, stands, likely)
    at_ends = {one.label.element for one in ending}
    exits = {one.label.element for one in fitting if one.label.role == LEAK}
    left_out = tuple(one for one in candidates if one not in fitting)
    unsure = tuple(one for one in proposals if one.label.role in MAKING and one not in candidates)
    return Trial(
        stated, fitting, left_out, unsure,
        tuple(way for way in ways if way.exit not in at_ends),
        tuple(way for way in ways if way.exit in at_ends),
        tuple(sorted(exits - {way.exit for way in ways}, key=lambda exit_: exit_.full_name)),
        _by_weight(_unsettled(stated, proposals, carried) - at_ends - exits, after),
    )  # fmt: skip


def _unspoken(stated: Result, proposals: Iterable[LabelProposal]) -> frozenset[Element]:
    """Nodes of which neither labels nor proposals say anything."""
    elements = stated.analysis.graph.elements
    spoken = {one.label.element.identity for one in proposals}
    spoken |= {elements[vertex].identity for vertex, said in stated.bound.elements.items() if said}
    return frozenset(node for node in elements if node.is_node and node.identity not in spoken)


def _unsettled(stated: Result, proposals: Collection[LabelProposal], carried: Spread) -> frozenset[Element]:
    """Nodes of which nobody says what they do with what they get: a source that gets data lets it out or not."""
    silent, elements = _unspoken(stated, proposals), stated.analysis.graph.elements
    getting = {elements[vertex] for vertex, kinds in carried.arrives.items() if kinds}
    begins = _unspoken(stated, (one for one in proposals if one.label.role not in (SOURCE, DERIVATION)))
    return silent | (begins & getting)


def _silent(
    stated: Result, proposals: Iterable[LabelProposal], fitting: Collection[LabelProposal]
) -> frozenset[Element]:
    """Nodes of which nobody says what they do with data: no label, no known package, no proposal that counts."""
    of_packages = (one for one in proposals if any(reason.ground == PACKAGE for reason in one.evidence))
    return _unspoken(stated, (*of_packages, *fitting))


def _by_weight(nodes: Iterable[Element], after: Result) -> tuple[Element, ...]:
    """Nodes in the order in which to ask what they do."""
    analysis, categories = after.analysis, after.vocabulary.categories
    carried = {item.element: item.categories for item in analysis.carried}
    ends, graph = traffic(analysis.graph, after.bound), analysis.graph
    sinks = {graph.elements[vertex] for vertex in ends.reads if only_reads(graph, ends, vertex)}

    def weight(node: Element) -> tuple[bool, bool, Any, str]:
        kinds = sorted(categories[name].weight for name in carried.get(node, ()))
        return node not in sinks, not kinds, kinds[:1], node.name

    return tuple(sorted(nodes, key=weight))


def supposed(stated: Result, proposals: Sequence[LabelProposal]) -> tuple[tuple[LabelProposal, ...], Result]:
    """Return all proposals that can be said beside what is stated, and the answer with them."""
    try:
        return tuple(proposals), _with(stated, proposals)
    except InputErrors:
        pass
    fitting: list[LabelProposal] = []
    for one in proposals:
        try:
            _with(stated, [*fitting, one])
        except InputErrors:
            continue
        fitting.append(one)
    return tuple(fitting), _with(stated, fitting)


def _with(stated: Result, proposals: Sequence[LabelProposal]) -> Result:
    after = with_more(stated, (written(one.label) for one in proposals), ORIGIN)
    assert after is not None
    return after
