"""Policies -> ``FlowGraph``: along which steps data can go.

In: policies, in any order. Out: elements and flows, sorted; what a DENY takes back is kept apart. Rules S1 to S6:
services and actions have two legs, wildcards are vertices joined to what they match, DENY wins over ALLOW for the
whole enclave of its policy and per direction, and the enforced view gives each node what its enclave may do.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import KINDS, Element, Flow, FlowGraph, Grant, Profile
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.policies.common_names import some_name
from rosprivacy.ingest.policies.names import covers, dds_names, endpoints, is_pattern, literal_prefix, matcher, overlaps

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.policies.names import Endpoint


def build(policies: Iterable[Policy], view: str = View.declared) -> FlowGraph:
    """Make the flow graph of some policies; the same whatever their order.

    Parameters
    ----------
    view
        ``declared``: each node does what its own profile says. ``enforced``: each node may do what any profile of
        its enclave may (rule S6).

    Raises
    ------
    InputErrors
        If the view is neither.

    Notes
    -----
    Linear in the grants; with wildcards also in the channels that share their literal beginning, and quadratic in
    the number of distinct wildcard names.
    """
    policies = tuple(policies)
    profiles = tuple(sorted({p for policy in policies for p in policy.profiles}, key=_profile_key))
    grants = sorted({grant for policy in policies for grant in policy.grants}, key=_grant_key)
    rights = list(_rights([grant for grant in grants if grant.allow], profiles, View(view)))
    denials = _Denials([grant for grant in grants if not grant.allow and not grant.dead])
    drafts = _Drafts()
    for profile in profiles:
        drafts.elements.add(Element("node", profile.node))
    for grant in grants:
        if not grant.allow:  # a channel that is only denied is still there to be seen
            drafts.add_channel(grant)
    for node, grant in rights:
        for endpoint in endpoints(grant.role, grant.kind, grant.name):
            drafts.add(node, grant, endpoint, denials)
    drafts.join()
    return drafts.graph(profiles, str(view))


def _rights(grants: list[Grant], profiles: tuple[Profile, ...], view: View) -> Iterator[tuple[str, Grant]]:
    """(node, grant): which node may use which grant."""
    if view is View.declared:
        yield from ((grant.node, grant) for grant in grants)
        return
    members: dict[str, list[str]] = defaultdict(list)
    for enclave, node in sorted({(profile.enclave, profile.node) for profile in profiles}):
        members[enclave].append(node)
    for grant in grants:
        yield from ((node, grant) for node in members[grant.enclave])


Rule = tuple[str, Grant]  # DDS name or expression, and the line that denies it


class _Denials:
    """DENY lines by policy, enclave and direction (rule S5)."""

    def __init__(self, grants: Iterable[Grant]) -> None:
        self._of: dict[tuple[str, str, bool], list[Rule]] = defaultdict(list)
        for grant in grants:
            for endpoint in endpoints(grant.role, grant.kind, grant.name):
                self._of[grant.policy, grant.enclave, endpoint.writes].append((endpoint.dds, grant))

    def of(self, grant: Grant, endpoint: Endpoint) -> tuple[list[Grant], list[Rule]]:
        """The lines that deny all of what a grant opens, and the rules that deny a part of its wildcard."""
        rules = self._of.get((grant.policy, grant.enclave, endpoint.writes), ())
        whole = [line for dds, line in rules if covers(dds, endpoint.dds)]
        if whole or not is_pattern(endpoint.name):
            return whole, []
        part = [rule for rule in rules if overlaps(rule[0], endpoint.dds)]
        if part and not some_name((endpoint.dds,), tuple(sorted({dds for dds, _ in part}))):
            return [line for _, line in part], []
        return [], part


@dataclass
class _Draft:
    """A flow in the making: one role of one node on one channel may span several DDS topics."""

    allowed: set[Grant]
    overridden: set[Grant]
    denials: set[Grant]


class _Drafts:
    """Elements and flows as they are found, not yet numbered."""

    def __init__(self) -> None:
        self.elements: set[Element] = set()
        self.flows: dict[tuple[Element, Element, str], _Draft] = {}
        self.dds: dict[Element, set[str]] = defaultdict(set)
        self.rules: dict[Element, set[Rule]] = defaultdict(set)  # of a pattern: what denies a part of it
        self.refused: dict[tuple[Element, Element], set[Grant]] = {}  # matches that DENYs take out

    def add_channel(self, grant: Grant) -> None:
        """The concrete channel of a DENY; a denied wildcard grants and names nothing."""
        for endpoint in endpoints(grant.role, grant.kind, grant.name):
            if not is_pattern(endpoint.name):
                self._channel(endpoint, ())

    def add(self, node: str, grant: Grant, endpoint: Endpoint, denials: _Denials) -> None:
        """One DDS topic that a grant opens to a node, unless denied."""
        against, part = denials.of(grant, endpoint)
        channel = self._channel(endpoint, tuple(sorted({dds for dds, _ in part})))
        if part:
            self.rules[channel].update(part)
        ends = Element("node", node), channel
        key = (*(ends if endpoint.writes else ends[::-1]), grant.role)
        draft = self.flows.setdefault(key, _Draft(set(), set(), set()))
        if against:
            draft.overridden.add(grant)
            draft.denials.update(against)
        else:
            draft.allowed.add(grant)

    def _channel(self, endpoint: Endpoint, without: tuple[str, ...]) -> Element:
        if is_pattern(endpoint.name):
            side = "write" if endpoint.writes else "read"
            element = Element(endpoint.kind, endpoint.name, "", endpoint.leg, side, without)
            self.dds[element].add(endpoint.dds)
        else:
            element = Element(endpoint.kind, endpoint.name, "", endpoint.leg)
            if element not in self.elements:
                self.dds[element].update(dds_names(endpoint.kind, endpoint.name, endpoint.leg))
        self.elements.add(element)
        return element

    def join(self) -> None:
        """Join each wildcard to the names that it matches and the wildcards that it can meet (rule S4)."""
        plain = sorted((dds, e) for e in self.elements if not e.is_node and not e.pattern for dds in self.dds[e])
        patterns = sorted((e for e in self.elements if e.pattern), key=Element.sort_key)
        readers = [e for e in patterns if e.side == "read"]
        gone = self._denied_whole()
        for pattern in patterns:
            for channel, lines in self._covered(pattern, plain):
                ends = (pattern, channel) if pattern.side == "write" else (channel, pattern)
                self._match(*ends, lines | gone.get(pattern, set()))
            if pattern.side == "write":
                for reader in readers:
                    if (met := self._met(pattern, reader)) is not None:
                        self._match(pattern, reader, met | gone.get(pattern, set()) | gone.get(reader, set()))

    def _denied_whole(self) -> dict[Element, set[Grant]]:
        """Patterns of which DENYs leave no name, with these lines: nothing is joined to them (rule S4)."""
        found: dict[Element, set[Grant]] = defaultdict(set)
        opened = set()
        for (source, target, _), draft in self.flows.items():
            for end in (source, target):
                if end.pattern and draft.allowed:
                    opened.add(end)
                elif end.pattern:
                    found[end] |= draft.denials
        return {pattern: lines for pattern, lines in found.items() if pattern not in opened}

    def _match(self, source: Element, target: Element, denials: set[Grant]) -> None:
        if denials:
            self.refused[source, target] = denials
        else:
            self.flows[source, target, "matches"] = _Draft(set(), set(), set())

    def _covered(self, pattern: Element, plain: list[tuple[str, Element]]) -> Iterator[tuple[Element, set[Grant]]]:
        """The channels that a pattern covers; with each the lines that take it out, none if it is covered."""
        free: set[Element] = set()
        taken: dict[Element, set[Grant]] = defaultdict(set)
        for expression in self.dds[pattern]:
            prefix, matches = literal_prefix(expression), matcher(expression)
            at = bisect_left(plain, prefix, key=lambda pair: pair[0])
            while at < len(plain) and plain[at][0].startswith(prefix):
                dds, channel = plain[at]
                at += 1
                if matches(dds):
                    lines = {line for denied, line in self.rules.get(pattern, ()) if covers(denied, dds)}
                    taken[channel] |= lines
                    if not lines:
                        free.add(channel)
        for channel, lines in taken.items():
            yield channel, set() if channel in free else lines

    def _met(self, writer: Element, reader: Element) -> set[Grant] | None:
        """The lines that take out all names that two patterns share: none if one is left; None if they share none."""
        rules = {*self.rules.get(writer, ()), *self.rules.get(reader, ())}
        lines: set[Grant] | None = None
        for ours in self.dds[writer]:
            for theirs in self.dds[reader]:
                if not overlaps(ours, theirs):
                    continue
                near = [(dds, line) for dds, line in rules if overlaps(dds, ours) and overlaps(dds, theirs)]
                if not near or some_name((ours, theirs), tuple(sorted({dds for dds, _ in near}))):
                    return set()
                lines = (lines or set()) | {line for _, line in near}
        return lines

    def graph(self, profiles: tuple[Profile, ...], view: str) -> FlowGraph:
        """Number the elements and sort everything (rule S14)."""
        elements = tuple(sorted(self.elements, key=Element.sort_key))
        index = {element: i for i, element in enumerate(elements)}
        allowed, denied = [], []
        for (source, target, role), draft in self.flows.items():
            ends = index[source], index[target], role
            if draft.allowed or role == "matches":
                allowed.append(Flow(*ends, tuple(sorted(draft.allowed, key=_grant_key))))
            else:
                overridden = tuple(sorted(draft.overridden, key=_grant_key))
                denied.append(Flow(*ends, overridden, tuple(sorted(draft.denials, key=_grant_key))))
        refused = [
            Flow(index[source], index[target], "matches", (), tuple(sorted(lines, key=_grant_key)))
            for (source, target), lines in self.refused.items()
        ]
        return FlowGraph(
            elements, tuple(sorted(allowed, key=_ends)), tuple(sorted(denied, key=_ends)), profiles, view,
            tuple(sorted(refused, key=_ends)),
        )  # fmt: skip


def _ends(flow: Flow) -> tuple[int, int, str]:
    return (flow.source, flow.target, flow.role)


def _profile_key(profile: Profile) -> tuple[str, str, str, int]:
    return (profile.enclave, profile.node, profile.place.file, profile.place.line)


def _grant_key(grant: Grant) -> tuple[object, ...]:
    place = grant.place
    kind = KINDS.index(grant.kind)
    line = (place.file, place.line, grant.enclave, grant.node, kind, grant.name, grant.role, grant.allow)
    return (*line, grant.policy, grant.dead)
