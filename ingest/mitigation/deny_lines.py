"""Grants set to DENY: which lines would cut some flows, and what else would go with them (rules S3 to S5).

In: policies, the graph that they make, flows. Out: ``Denial``s; policies with some grants set to DENY. A DENY holds for
its policy, enclave and direction, and for all that its name covers; it takes names out of the enclave's wildcards.
One that sros2 does not read takes nothing away: there only the ALLOW goes that it takes the place of (rule S5).

``open_ended`` finds wildcards that take in a channel whatever it is called: there, a filter has nowhere to keep what it
has not cleaned.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import one_by_one
from rosprivacy.analysis.mitigation.candidates import Denial
from rosprivacy.analysis.model import CHANNELS
from rosprivacy.ingest.policies.names import DDS, covers, dds_names, endpoints, is_pattern, overlaps

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import FlowGraph, Grant, Place, Policy
    from rosprivacy.ingest.policies.names import Endpoint

# policy, enclave, whether it writes, DDS name or expression; the line, where sros2 does not read it (rule S5)
Part = tuple[str, str, bool, str, str]
NEW_NAMES = tuple(f"/{first}nfiltered_data/{last}" for first in "uUzZ0_" for last in ("raw", "clean_9"))


def with_denied(policies: Iterable[Policy], grants: Collection[Grant]) -> tuple[Policy, ...]:
    """Return policies with some grants set to DENY."""
    chosen = set(grants)
    return tuple(
        replace(policy, grants=tuple(g._replace(allow=False) if g in chosen else g for g in policy.grants))
        for policy in policies
    )


class Denials:
    """The grants of policies that cut flows of their graph if they are set to DENY; what is found once is kept."""

    def __init__(self, policies: Iterable[Policy], graph: FlowGraph) -> None:
        self._policies, self._graph = policies, graph
        self._touched: dict[frozenset[Part], frozenset[Part]] = {}

    @cached_property
    def _rights(self) -> _DeniedRights:
        return _DeniedRights(self._graph)

    @cached_property
    def _parts(self) -> dict[Grant, frozenset[Part]]:
        """What an enclave may no longer do when a line is set to DENY."""
        lines = (grant for policy in self._policies for grant in policy.grants if grant.allow and grant.kind != DDS)
        return {
            grant: frozenset(_part(grant, end) for end in endpoints(grant.role, grant.kind, grant.name))
            for grant in lines
        }

    def of(self, flows: Collection[int]) -> tuple[Denial, ...]:
        """Return the grants that would cut or touch some flows, one of those that do the same.

        Grants are taken one by one, for their enclave; a line that several profiles include also as a whole; and for a
        flow that none of these cuts (its node stands in several enclaves, or an action is granted by its parts) a set.

        Notes
        -----
        O(lines · flows) within an enclave for lines with wildcards; the others are looked up by name.
        """
        rights, wanted = self._rights, sorted(flows)
        concerned = {part for f in wanted for part in rights.parts[f]}
        first = {grant for f in wanted for grant in self._graph.flows[f].grants}
        found: dict[frozenset[Part], Denial] = {}
        ordered = sorted(self._parts, key=lambda grant: grant not in first)
        by_line: dict[tuple[Place, str, str], list[Grant]] = defaultdict(list)
        for grant in ordered:
            by_line[grant.place, grant.role, grant.name].append(grant)
        for some in (*([grant] for grant in ordered), *by_line.values()):
            parts = frozenset(part for grant in some for part in self._parts[grant])
            if parts not in found and not concerned.isdisjoint(self._touched_by(parts)):
                found[parts] = rights.denial(tuple(some), parts)
        single = list(found.items())
        for f in wanted:
            if rights.parts[f] and not any(f in denial.flows for _, denial in single):
                several = _together(rights.parts[f], single)
                parts = frozenset(part for one, _ in several for part in one)
                grants = tuple(grant for _, denial in several for grant in denial.grants)
                found.setdefault(parts, rights.denial(grants, parts))
        return tuple(found.values())

    def _touched_by(self, denied: frozenset[Part]) -> frozenset[Part]:
        if denied not in self._touched:
            self._touched[denied] = frozenset(self._rights.touched(denied))
        return self._touched[denied]


def _part(grant: Grant, end: Endpoint) -> Part:
    line = f"{grant.place} {grant.role} {grant.name} {grant.node}" if grant.dead else ""
    return (grant.policy, grant.enclave, end.writes, end.dds, line)


def _counts(denied: Part, part: Part) -> bool:
    """Whether a denial says anything about a part: one that sros2 does not read is about its own line only."""
    return denied[:3] == part[:3] and denied[4] in ("", part[4])


def _covered(part: Part, denied: Iterable[Part]) -> bool:
    return any(_counts(one, part) and covers(one[3], part[3]) for one in denied)


def _touched(part: Part, denied: Iterable[Part]) -> bool:
    return any(_counts(one, part) and overlaps(one[3], part[3]) for one in denied)


def _together(
    parts: Iterable[Part], single: Sequence[tuple[frozenset[Part], Denial]]
) -> list[tuple[frozenset[Part], Denial]]:
    """Lines that together deny all parts of a flow: for each part that is left, the first that covers it."""
    chosen: list[tuple[frozenset[Part], Denial]] = []
    for part in parts:
        if not any(_covered(part, one) for one, _ in chosen):
            chosen.append(next(pair for pair in single if _covered(part, pair[0])))
    return chosen


class _DeniedRights:
    """By flow, what of which enclave allows it."""

    def __init__(self, graph: FlowGraph) -> None:
        self.graph = graph
        self.parts = [tuple(dict.fromkeys(self._of(f))) for f, _ in enumerate(one_by_one(graph.flows))]
        self.by_part: dict[Part, list[int]] = defaultdict(list)
        self.matches: dict[int, list[int]] = defaultdict(list)
        for f, parts in enumerate(self.parts):
            for part in parts:
                self.by_part[part].append(f)
            flow = graph.flows[f]
            if flow.role == "matches":
                self.matches[flow.source].append(f)
                self.matches[flow.target].append(f)
        self.patterns = [part for part in self.by_part if is_pattern(part[3]) or part[4]]

    def _of(self, f: int) -> Iterator[Part]:
        flow = self.graph.flows[f]
        writes = self.graph.elements[flow.target].is_channel
        channel = self.graph.elements[flow.target if writes else flow.source]
        if any(grant.kind == DDS for grant in flow.grants):
            return  # permissions are signed: what they allow is changed in the policy that they were made of
        for grant in flow.grants:
            for end in endpoints(grant.role, grant.kind, grant.name):
                if (end.writes, end.kind, end.name, end.leg) == (writes, channel.kind, channel.name, channel.leg):
                    yield _part(grant, end)

    def touched(self, denied: Iterable[Part]) -> Iterator[Part]:
        """The parts that a denial touches."""
        for one in denied:
            near = self.by_part if is_pattern(one[3]) else dict.fromkeys((one, *self.patterns))
            yield from (part for part in near if part in self.by_part and _touched(part, (one,)))

    def denial(self, grants: tuple[Grant, ...], denied: frozenset[Part]) -> Denial:
        """What goes when some lines are set to DENY."""
        flows = {f for part in self.touched(denied) for f in self.by_part[part]}
        gone = {f for f in flows if all(_covered(part, denied) for part in self.parts[f])}
        touched = flows - gone
        for f in flows:
            ends = self.graph.flows[f].source, self.graph.flows[f].target
            touched |= {other for end in ends if self.graph.elements[end].pattern for other in self.matches[end]}
        return Denial(grants, frozenset(gone), frozenset(touched))


def open_ended(graph: FlowGraph) -> dict[str, frozenset[int]]:
    """Return, per kind of channel, the wildcards that also cover a new one, chosen so that as few as possible do."""
    patterns = [(v, e) for v, e in enumerate(graph.elements) if e.pattern]
    expressions = {v: dds_names(e.kind, e.name, e.leg) for v, e in patterns}
    found = {}
    for kind in CHANNELS:
        covering = [
            frozenset(
                v for v, own in expressions.items() if any(covers(one, dds) for one in own for dds in _dds(kind, name))
            )
            for name in NEW_NAMES
        ]
        found[kind] = min(covering, key=lambda vertices: (len(vertices), sorted(vertices)))
    return found


def _dds(kind: str, name: str) -> Iterator[str]:
    for leg in ("",) if kind == "topic" else ("request", "response"):
        yield from dds_names(kind, name, leg)
