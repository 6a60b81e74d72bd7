"""Policies -> ``FlowGraph``: along which steps data can go.

In: policies, in any order. Out: elements and flows, sorted; what a DENY takes back is kept apart. Rules S1 to S6:
services and actions have two legs, wildcards are vertices joined to what they match, DENY wins over ALLOW for the
whole enclave of its policy and per direction, and the enforced view gives each node what its enclave may do.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from itertools import product
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS, Tally
from rosprivacy.analysis.errors import PolicyError
from rosprivacy.analysis.many_flows import Flows, Meeting
from rosprivacy.analysis.model import PARTICIPANT, Element, Flow, FlowGraph, Grant, Place, Profile
from rosprivacy.analysis.modes import View
from rosprivacy.ingest.policies.enclave_rights import alike, enforced, of_each, shared
from rosprivacy.ingest.policies.name_index import Expressions, PlainNames
from rosprivacy.ingest.policies.names import dds_names, endpoints, is_pattern
from rosprivacy.ingest.policies.unsecured import in_one_enclave, network_profiles, read_by_network, unsecured
from rosprivacy.ingest.policies.wildcards import Comparisons, apart, literal_ends, meetings

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.policies.names import Endpoint
    from rosprivacy.ingest.policies.wildcards import MeetingEnds

_ends = attrgetter("source", "target", "role")  # of a flow
NOWHERE = Place("", 0)
STORED = 64  # times its members a group of wildcards that meet may have flows that are stored


def build(policies: Iterable[Policy], view: str = View.declared, bounds: Bounds = BOUNDS) -> FlowGraph:
    """Make the flow graph of some policies; the same whatever their order.

    Parameters
    ----------
    view
        ``declared``: each node does what its own profile says. ``enforced``: each node may do what any profile of
        its enclave may (rule S6); nodes for which nothing is enforced stand in one, and the network reads what they
        write or read.

    Raises
    ------
    InputErrors
        If the view is neither; above a bound.

    Notes
    -----
    Linear in the grants; with wildcards also in the pairs of names whose literal beginnings, or whose literal ends,
    go together: the fewer of both. Where many meet as many, their pairs are not stored (``Flows``). Bounded by
    ``flows`` and ``comparisons``.
    """
    policies = tuple(policies)
    profiles = tuple(sorted({p for policy in policies for p in policy.profiles}, key=_profile_key))
    grants = sorted({grant for policy in policies for grant in policy.grants}, key=_grant_key)
    network: list[Profile] = []
    reading: Iterable[tuple[str, Grant, Endpoint]] = ()
    if View(view) is View.enforced and (nothing_enforced := unsecured(policies)):
        network = network_profiles(profiles, nothing_enforced)
        reading = read_by_network([grant for grant in grants if grant.allow], nothing_enforced)
        profiles, grants = in_one_enclave(profiles, grants, nothing_enforced)
    allowed = [grant for grant in grants if grant.allow]
    work = Comparisons(bounds)
    denials = _Denials([grant for grant in grants if not grant.allow and not grant.dead], work)
    participants = {profile.node: profile.participant for profile in (*profiles, *network) if profile.participant}
    groups = alike(profiles, participants) if View(view) is View.enforced else {}
    rights = enforced(allowed, profiles, groups) if groups else ((grant.node, grant) for grant in allowed)
    drafts = _Drafts(work, bounds, participants)
    for profile in (*profiles, *network):
        drafts.elements.add(drafts.owner(profile.node))
    for grant in grants:
        if not grant.allow:  # a channel that is only denied is still there to be seen
            drafts.add_channel(grant)
    for node, grant in rights:
        for endpoint in endpoints(grant.role, grant.kind, grant.name):
            drafts.add(node, grant, endpoint, denials)
    for node, grant, endpoint in reading:
        drafts.add(node, grant, endpoint, denials)
    drafts.join()
    return drafts.graph(tuple(p for p in profiles if p.node not in participants), str(view), groups)


Rule = tuple[str, Grant]  # DDS name or expression, and the line that denies it


class _Denials:
    """DENY lines by policy, enclave and direction (rule S5)."""

    def __init__(self, grants: Iterable[Grant], work: Comparisons) -> None:
        self._work = work
        rules: dict[tuple[str, str, bool], list[Rule]] = defaultdict(list)
        for grant in grants:
            for endpoint in endpoints(grant.role, grant.kind, grant.name):
                rules[grant.policy, grant.enclave, endpoint.writes].append((endpoint.dds, grant))
        self._of = {key: (found, *apart(found)) for key, found in rules.items()}
        self._of_wildcards: dict[tuple[Grant, str], tuple[list[Grant], list[Rule]]] = {}

    def of(self, grant: Grant, endpoint: Endpoint) -> tuple[list[Grant], list[Rule]]:
        """The lines that deny all of what a grant opens in a leg, and the rules that deny a part of its wildcard."""
        if not self._of:
            return [], []
        rules, plain, patterns = self._of.get((grant.policy, grant.enclave, endpoint.writes), ((), {}, ()))
        self._work.at = grant.place
        if grant.rank:  # of permissions: the first rule that matches decides
            rules, plain, patterns = _before(grant.rank, rules)
        if not is_pattern(endpoint.name):
            return [*plain.get(endpoint.dds, ()), *(g for dds, g in patterns if self._work.hold(dds, endpoint.dds))], []
        if (grant, endpoint.leg) not in self._of_wildcards:
            self._of_wildcards[grant, endpoint.leg] = self._of_leg(rules, endpoint)
        return self._of_wildcards[grant, endpoint.leg]

    def _of_leg(self, rules: Sequence[Rule], endpoint: Endpoint) -> tuple[list[Grant], list[Rule]]:
        """Of a wildcard with all of its DDS topics: a leg of an action has several, and is one element."""
        names = dds_names(endpoint.kind, endpoint.name, endpoint.leg)
        whole = {name: [line for dds, line in rules if self._work.hold(dds, name)] for name in names}
        if all(whole.values()):
            return [line for lines in whole.values() for line in lines], []
        part = [rule for rule in rules if any(self._work.meet(rule[0], name) for name in names)]
        if part and not any(self._work.name_left((name,), part) for name in names if not whole[name]):
            return [line for _, line in part], []
        return [], part


def _before(rank: int, rules: Iterable[Rule]) -> tuple[list[Rule], dict[str, list[Grant]], list[Rule]]:
    """The rules of permissions that are looked at before one of a rank."""
    first = [rule for rule in rules if rule[1].rank < rank]
    return (first, *apart(first))


@dataclass(slots=True, eq=False, repr=False)
class _Draft:
    """A flow in the making: one role of one node on one channel may span several DDS topics.

    Grants come in their order.
    """

    allowed: list[Grant] = field(default_factory=list)
    removed: tuple[set[Grant], set[Grant]] | None = None  # lines that are overridden, and those that deny


_MATCH = _Draft()  # of all flows of role ``matches``: no line states them


class _Drafts:
    """Elements and flows as they are found, not yet numbered."""

    def __init__(self, work: Comparisons, bounds: Bounds, participants: Mapping[str, str]) -> None:
        self.work, self.bounds, self.count = work, bounds, Tally(bounds, "flows", PolicyError)
        self.participants = participants  # whose profiles are of no node -> names outside ROS (rule S16)
        self.flow_statements: dict[Element, Place] = {}  # of a pattern: the first line of it
        self.elements: set[Element] = set()
        self.plain: dict[tuple[str, str, str], Element] = {}
        self.flows: dict[tuple[Element, Element, str], _Draft] = {}
        self.dds: dict[Element, set[str]] = defaultdict(set)  # of patterns
        self.ordered: dict[Element, list[str]] = {}  # the same, for the same steps in every run
        self.rules: dict[Element, set[Rule]] = defaultdict(set)  # of a pattern: what denies a part of it
        self.refused: dict[tuple[Element, Element], set[Grant]] = {}  # matches that DENYs take out
        self.meetings: list[tuple[list[Element], list[Element]]] = []

    def add_channel(self, grant: Grant) -> None:
        """The concrete channel of a DENY; a denied wildcard grants and names nothing."""
        for endpoint in endpoints(grant.role, grant.kind, grant.name):
            if not is_pattern(endpoint.name):
                self._channel(endpoint, ())

    def add(self, node: str, grant: Grant, endpoint: Endpoint, denials: _Denials) -> None:
        """One DDS topic that a grant opens to a node, unless denied."""
        against, part = denials.of(grant, endpoint)
        channel = self._channel(endpoint, tuple(sorted({dds for dds, _ in part})) if part else ())
        if channel.side:
            self.flow_statements.setdefault(channel, grant.place)
        if part:
            self.rules[channel].update(part)
        ends = self.owner(node), channel
        new = _Draft()
        draft = self.flows.setdefault((*(ends if endpoint.writes else ends[::-1]), grant.role), new)
        if draft is new:
            self.count.add(1, grant.place)
        if against:
            draft.removed = draft.removed or (set(), set())
            draft.removed[0].add(grant)
            draft.removed[1].update(against)
        elif not draft.allowed or draft.allowed[-1] is not grant:
            draft.allowed.append(grant)

    def _channel(self, endpoint: Endpoint, without: tuple[str, ...]) -> Element:
        known = self.plain.get((endpoint.kind, endpoint.name, endpoint.leg))
        if known is not None:
            return known
        if is_pattern(endpoint.name):
            side = "write" if endpoint.writes else "read"
            element = Element(endpoint.kind, endpoint.name, "", endpoint.leg, side, without)
            self.dds[element].add(endpoint.dds)
        else:
            element = self._plain(endpoint.kind, endpoint.name, endpoint.leg)
        self.elements.add(element)
        return element

    def owner(self, node: str) -> Element:
        """The element that a profile is of."""
        outside = self.participants.get(node)
        return self._plain(PARTICIPANT, outside, "") if outside else self._plain("node", node, "")

    def _plain(self, kind: str, name: str, leg: str) -> Element:
        """An element that is no pattern; made once."""
        key = kind, name, leg
        if key not in self.plain:
            self.plain[key] = Element(kind, name, "", leg)
        return self.plain[key]

    def join(self) -> None:
        """Join each wildcard to the names that it matches and the wildcards that it can meet (rule S4)."""
        patterns = sorted((e for e in self.elements if e.pattern), key=Element.sort_key)
        if not patterns:
            return
        self.ordered = {e: sorted(self.dds[e]) for e in patterns}
        channels = (e for e in self.elements if e.is_channel and not e.pattern)
        plain = PlainNames(
            ((dds, e) for e in channels for dds in dds_names(e.kind, e.name, e.leg)),
            [dds for e in patterns for dds in self.ordered[e]],
        )
        gone = self._denied_whole()
        by_ends = self._by_ends(gone)
        everyone, others = (
            Expressions((dds, e) for e in some if e.side == "read" for dds in self.ordered[e])
            for some in (patterns, [e for e in patterns if e not in by_ends])
        )
        self._meet(by_ends)
        for pattern in patterns:
            self.work.at = self.flow_statements[pattern]
            for channel, lines in self._covered(pattern, plain):
                ends = (pattern, channel) if pattern.side == "write" else (channel, pattern)
                self._match(*ends, lines | gone.get(pattern, set()))
            if pattern.side == "write":
                readers = others if pattern in by_ends else everyone
                for reader in {near: None for dds in self.ordered[pattern] for near in readers.near(dds)}:
                    if (met := self._met(pattern, reader)) is not None:
                        self._match(pattern, reader, met | gone.get(pattern, set()) | gone.get(reader, set()))

    def _by_ends(self, met: Mapping[Element, set[Grant]]) -> dict[Element, MeetingEnds]:
        """The patterns of which their literal ends tell what they meet: of one DDS topic, and no DENY is about them."""
        alone = (e for e, dds in self.ordered.items() if len(dds) == 1 and not self.rules.get(e) and e not in met)
        return {e: ends for e in alone if (ends := literal_ends(self.ordered[e][0])) is not None}

    def _meet(self, by_ends: Mapping[Element, MeetingEnds]) -> None:
        """Join patterns by their ends; large groups as a whole."""

        def count(element: Element, groups: int) -> None:
            self.work.at = self.flow_statements[element]
            self.work.placed(groups)

        writers, readers = ({e: ends for e, ends in by_ends.items() if e.side == side} for side in ("write", "read"))
        for written, read in meetings(writers, readers, count):
            self.work.at = self.flow_statements[written[0]]
            if len(written) * len(read) > STORED * (len(written) + len(read)):
                self.count.add(len(written) + len(read), self.work.at)
                self.meetings.append((written, read))
                continue
            for writer, reader in product(written, read):
                self._match(writer, reader, set())

    def _denied_whole(self) -> dict[Element, set[Grant]]:
        """Patterns of which DENYs leave no name, with these lines: nothing is joined to them (rule S4)."""
        found: dict[Element, set[Grant]] = defaultdict(set)
        opened = set()
        for (source, target, _), draft in self.flows.items():
            for end in (source, target):
                if end.pattern and draft.allowed:
                    opened.add(end)
                elif end.pattern and draft.removed:
                    found[end] |= draft.removed[1]
        return {pattern: lines for pattern, lines in found.items() if pattern not in opened}

    def _match(self, source: Element, target: Element, denials: set[Grant]) -> None:
        if denials:
            self.refused[source, target] = denials
        else:
            self.count.add(1, self.work.at)
            self.flows[source, target, "matches"] = _MATCH

    def _covered(self, pattern: Element, plain: PlainNames) -> Iterator[tuple[Element, set[Grant]]]:
        """The channels that a pattern covers; with each the lines that take it out, none if it is covered."""
        taken: dict[Element, set[Grant]] = {}
        free, rules = set[Element](), self.rules.get(pattern, ())
        for expression in self.ordered[pattern]:
            for dds, channel in self.work.covered(expression, plain):
                lines = {line for denied, line in rules if self.work.hold(denied, dds)} if rules else set()
                taken.setdefault(channel, set()).update(lines)
                if not lines:
                    free.add(channel)
        for channel, lines in taken.items():
            yield channel, set() if channel in free else lines

    def _met(self, writer: Element, reader: Element) -> set[Grant] | None:
        """The lines that take out all names that two patterns share: none if one is left; None if they share none."""
        rules = {*self.rules.get(writer, ()), *self.rules.get(reader, ())}
        lines: set[Grant] | None = None
        for ours in self.ordered[writer]:
            for theirs in self.ordered[reader]:
                if not self.work.meet(ours, theirs):
                    continue
                near = [(d, line) for d, line in rules if self.work.meet(d, ours) and self.work.meet(d, theirs)]
                if not near or self.work.name_left((ours, theirs), near):
                    return set()
                lines = (lines or set()) | {line for _, line in near}
        return lines

    def graph(
        self, profiles: tuple[Profile, ...], view: str, groups: Mapping[str, Sequence[str]] = MappingProxyType({})
    ) -> FlowGraph:
        """Number the elements and sort everything (rule S14).

        Parameters
        ----------
        groups
            Nodes that share the flows of the first of them, by that one.
        """
        elements = tuple(sorted(self.elements, key=Element.sort_key))
        index = {element: i for i, element in enumerate(elements)}
        allowed, denied = [], []
        for (source, target, role), draft in self.flows.items():
            ends = index[source], index[target], role
            if draft.allowed or role == "matches":
                allowed.append(Flow(*ends, tuple(draft.allowed)))
            else:
                denied.append(Flow(*ends, *map(_in_order, draft.removed or ())))
        refused = [
            Flow(index[source], index[target], "matches", (), _in_order(lines))
            for (source, target), lines in self.refused.items()
        ]
        met = [Meeting(_sorted(written, index), _sorted(read, index)) for written, read in self.meetings]
        place = self.flow_statements[self.meetings[0][0][0]] if met else NOWHERE
        several = {
            index[self.owner(first)]: _sorted(map(self.owner, nodes), index)
            for first, nodes in groups.items()
            if len(nodes) > 1
        }
        if several:
            place = next((flow.grants[0].place for flow in allowed if flow.grants), place)
            before = len(allowed) + len(denied)
            allowed, more = shared(allowed, several)
            denied = list(of_each(denied, several))
            members = sum(len(meeting.written) + len(meeting.read) for meeting in more)
            self.count.add(max(0, len(allowed) + len(denied) + members - before), place)
            met += more
        flows: Sequence[Flow] = tuple(sorted(allowed, key=_ends))
        if met:
            flows = Flows(tuple(flows), tuple(sorted(met, key=lambda m: (m.written, m.read))), self.bounds, place)
        return FlowGraph(
            elements, flows, tuple(sorted(denied, key=_ends)), profiles, view,
            tuple(sorted(refused, key=_ends)), tuple(sorted(self.work.careful, key=lambda at: (at.file, at.line))),
        )  # fmt: skip


def _sorted(elements: Iterable[Element], index: Mapping[Element, int]) -> tuple[int, ...]:
    return tuple(sorted(index[element] for element in elements))


def _profile_key(profile: Profile) -> tuple[str, str, str, int]:
    return (profile.enclave, profile.node, profile.place.file, profile.place.line)


def _in_order(lines: set[Grant]) -> tuple[Grant, ...]:
    return tuple(lines) if len(lines) < 2 else tuple(sorted(lines, key=_grant_key))  # noqa: PLR2004 - nothing to sort


def _grant_key(grant: Grant) -> tuple[object, ...]:
    place = grant.place
    return (
        place.file, place.line, grant.enclave, grant.node, grant.kind, grant.name, grant.role, grant.allow,
        grant.policy, grant.dead, grant.rank,
    )  # fmt: skip
