"""The channels of a graph that a governance leaves in the open (rule S10).

In: policies with what their governance protects, and a graph. Out: ``Exposure``s by vertex. Only ``ENCRYPT`` and
``ENCRYPT_WITH_ORIGIN_AUTHENTICATION`` hide what is sent, of a message, of the data in it or of all of a domain; what
is signed can be read. Where an expression of a wildcard may meet a rule, it is taken to.

Source: DDS-Security 1.1, 9.4.1.2: the first topic rule that matches decides; without one a middleware opens no topic.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import Exposure, Protection, TopicProtection
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, STRANGERS
from rosprivacy.ingest.policies.names import covers, overlaps

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from rosprivacy.analysis.model import Bound, FlowGraph, Grant, Policy


def with_exposed(graph: FlowGraph, bound: Bound, policies: Iterable[Policy]) -> Bound:
    """Return what is bound to a graph with the channels that a governance leaves in the open (rule S10)."""
    protected = [policy for policy in policies if policy.protections]
    return replace(bound, exposed=exposed_channels(graph, protected)) if protected else bound


def exposed_channels(graph: FlowGraph, policies: Iterable[Policy]) -> dict[int, tuple[Exposure, ...]]:
    """Return the channels that who is on the network can read, by vertex, with the lines by which it can.

    A channel stands under the governances of those who may write or read it, under the names of its DDS topics that
    they are granted. What is read through a wildcard is told where it is written.
    """
    of = {policy.file: policy.protections for policy in policies if policy.protections}
    under: dict[int, set[tuple[str, tuple[Protection, ...]]]] = defaultdict(set)
    for channel, grants in _granted(graph) if of else ():
        under[channel].update((grant.name, of[grant.policy]) for grant in grants if grant.policy in of)
    found = {}
    for vertex, some in sorted(under.items()):
        element = graph.elements[vertex]
        if element.side != "read":
            each = ((name, rules) for name, domains in some for rules in domains)
            exposures = {one for name, rules in each for one in _exposures(rules, name, element.without)}
            if exposures:
                found[vertex] = tuple(sorted(exposures))
    return found


def _granted(graph: FlowGraph) -> Iterator[tuple[int, Iterable[Grant]]]:
    """(channel, the lines that allow a flow there); what the nodes of an enclave share is told once (rule S6)."""
    flows, meetings = parted(graph.flows)
    for _, flow in flows:
        yield flow.target if graph.elements[flow.target].is_channel else flow.source, flow.grants
    for meeting in meetings:
        for channels, rights in ((meeting.written, meeting.of_written), (meeting.read, meeting.of_read)):
            yield from ((channel, right.grants) for channel, right in zip(channels, rights, strict=False))


def _exposures(rules: Protection, name: str, without: Collection[str]) -> Iterator[Exposure]:
    """Why a DDS topic, or one of those that an expression names, can be read."""
    first = list(_that_decide(rules, name, without))
    if rules.strangers and first:
        yield Exposure(STRANGERS, rules.strangers)
    yield from (Exposure(NOT_ENCRYPTED, rule.place) for rule in first if not rule.encrypted)


def _that_decide(rules: Protection, name: str, without: Collection[str]) -> Iterator[TopicProtection]:
    """The rule that is the first for a name; of an expression all that are the first for some name of it."""
    for rule in rules.topics:
        if overlaps(rule.expression, name) and not any(covers(denied, rule.expression) for denied in without):
            yield rule
        if covers(rule.expression, name):
            return
