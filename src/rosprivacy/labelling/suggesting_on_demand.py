"""Suggestions about single elements of a system that is labelled step by step: what no label changes is found once.

In: what is known, then one ``Result`` after the other. Out: for an element, or for a role, the proposals that
``suggested_by`` gives; a test holds that. Evidence from names, types and packages rests on the graph; only what is said
of open elements is found anew, and only for those that are asked about.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.channels import standard_in, traffic
from rosprivacy.analysis.suggesting.evidence import GLOBBED, LEAK
from rosprivacy.analysis.suggesting.open_elements import of_open
from rosprivacy.analysis.suggesting.packages import nodes_of_packages
from rosprivacy.labelling.knowledge import lasting_evidence
from rosprivacy.labelling.suggesting import asked_by, in_review_order, refused_in, review_places, with_findings

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from rosprivacy.analysis.findings.review_order import Behind, Shown
    from rosprivacy.analysis.model import FlowGraph, MessageType
    from rosprivacy.analysis.suggesting.channels import Traffic
    from rosprivacy.analysis.suggesting.evidence import Evidence, Identity, LabelProposal
    from rosprivacy.labelling.knowledge import KnownOfSystem
    from rosprivacy.labelling.suggesting import Refused
    from rosprivacy.result import Result


class _Lasting(NamedTuple):
    """What was found in a graph, by the identity of the element that it speaks of, with all that it rests on."""

    graph: FlowGraph
    types: Mapping[int, tuple[MessageType, ...]]
    standard: Collection[int]
    traffic: Traffic
    evidence: Mapping[Identity, Sequence[Evidence]]

    def holds(self, result: Result) -> bool:
        """Whether the same would be found now."""
        same = self.graph is result.analysis.graph and self.types == result.bound.types
        return same and self.standard == standard_in(result.bound)


class Suggester:
    """What suggests labels for one answer after the other.

    Parameters
    ----------
    knowledge
        What suggestions are made by.
    """

    def __init__(self, knowledge: KnownOfSystem) -> None:
        self.knowledge = knowledge
        self._last: _Lasting | None = None

    def under(self, result: Result, order: Mapping[Shown, Behind]) -> Suggestions:
        """Return the suggestions for an answer.

        Parameters
        ----------
        order
            ``result.review_order``, which others have need of, too.
        """
        if self._last is None or not self._last.holds(result):
            self._last = self._build(result)
        return Suggestions(self.knowledge, self._last, result, order)

    def _build(self, result: Result) -> _Lasting:
        graph, bound = result.analysis.graph, result.bound
        ends = traffic(graph, bound)
        found: dict[Identity, list[Evidence]] = defaultdict(list)
        of_packages = nodes_of_packages(graph, bound.types, self.knowledge.packages)
        for one in lasting_evidence(graph, bound, ends, of_packages, self.knowledge, {}):
            found[one.label.element.identity].append(one)
        return _Lasting(graph, bound.types, standard_in(bound), ends, dict(found))


class Suggestions:
    """What could be said of the elements of one answer; made by ``Suggester.under``."""

    def __init__(
        self, knowledge: KnownOfSystem, lasting: _Lasting, result: Result, order: Mapping[Shown, Behind]
    ) -> None:
        self._knowledge, self._lasting, self._result, self._order = knowledge, lasting, result, order

    def of(self, identity: Identity) -> tuple[LabelProposal, ...]:
        """Return what could be said of one element."""
        return self._of({identity})

    def of_role(self, *roles: str) -> tuple[tuple[LabelProposal, ...], ...]:
        """Return for each element of which one of some roles could be said all that could be, in review order."""
        there = {at for at, said in self._lasting.evidence.items() if any(one.label.role in roles for one in said)}
        if LEAK in roles:  # where data ends; of no other role of these is anything said of what is open
            there |= {question.element.identity for question in self._result.analysis.open}
        asked = self._of(there)
        found: dict[Identity, list[LabelProposal]] = defaultdict(list)
        for one in asked:
            found[one.label.element.identity].append(one)
        wanted = dict.fromkeys(one.label.element.identity for one in asked if one.label.role in roles)
        return tuple(tuple(found[at]) for at in wanted)

    def although_a_glob(self) -> tuple[LabelProposal, ...]:
        """Return what says of nodes that they let data out although a glob calls them conduits."""
        there = {at for at, said in self._lasting.evidence.items() if any(one.label.role == LEAK for one in said)}
        return tuple(one for one in self._of(there) if one.evidence[0].ground == GLOBBED)

    def _of(self, identities: Collection[Identity]) -> tuple[LabelProposal, ...]:
        if not identities:
            return ()
        result, lasting = self._result, self._lasting
        said = [one for at in identities for one in lasting.evidence.get(at, ())]
        questions = [one for one in result.analysis.open if one.element.identity in identities]
        if questions:
            said += of_open(questions, lasting.graph, result.bound, lasting.traffic, self._knowledge.rules)
        asked = tuple(asked_by(said, result, self._found_kinds, self._refused))
        alone = len({one.label.element.identity for one in asked}) <= 1  # then its place decides nothing
        return in_review_order(asked, {} if alone else self._places, result.vocabulary.categories)

    @cached_property
    def _found_kinds(self) -> frozenset[str]:
        return with_findings(self._result)

    @cached_property
    def _refused(self) -> Refused:
        return refused_in(self._result)

    @cached_property
    def _places(self) -> Mapping[Identity, int]:
        return review_places(self._result, self._order)
