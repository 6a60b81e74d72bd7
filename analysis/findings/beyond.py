"""What a node could do beyond its own profile: findings that only the enforced view has, and what ends them (rule S6).

In: graphs of the declared view, and findings of the enforced one. Out: facts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import MATCHES, one_by_one, parted

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, FlowGraph, Place

Key = tuple[str, str, str]
Right = tuple[Key, str, Key]  # node, role, channel
Ends = tuple[Key, Key, str, tuple[str, ...]]  # of a flow, its role, and what DENYs take out of its wildcard


class DenyLine(NamedTuple):
    """A DENY line that nobody has written yet.

    Attributes
    ----------
    policy
        The file that it would stand in: a DENY counts in its own policy only (rule S5).
    enclave, node
        Of the profile that it would stand in; it holds for the whole enclave.
    """

    policy: str
    enclave: str
    node: str
    role: str
    kind: str
    name: str


class Added(NamedTuple):
    """A finding that only the enforced view has.

    Attributes
    ----------
    finding
        Of a fleet the first one of its pattern.
    plain
        Whether the declared view has it, too, but in pseudonymised form only: then this is about the plain data.
    findings
        Of a fleet those of the graph that differ from it only in the robot, itself first.
    beyond
        The steps of its witness, by number, that the profile of their node does not allow.
    enclaves
        Those that make it possible: they allow these steps to all of their nodes.
    opened
        Lines that make it possible, since they ask nobody for permissions; sorted.
    split
        Enclaves of which splitting into one for each node ends it; empty if none was found.
    move
        (enclave, node): moving this profile alone to an enclave of its own ends it, too; None if none was found.
    deny
        DENY lines that end it; empty if none were found.
    loses
        What nodes could no longer do that their own profiles allow, if these lines were there; sorted.
    robots
        Of a fleet: where it is added, sorted.
    """

    finding: Finding
    beyond: tuple[int, ...]
    enclaves: tuple[str, ...]
    split: tuple[str, ...] = ()
    move: tuple[str, str] | None = None
    deny: tuple[DenyLine, ...] = ()
    loses: tuple[Right, ...] = ()
    robots: tuple[str, ...] = ()
    opened: tuple[Place, ...] = ()
    findings: tuple[Finding, ...] = ()
    plain: bool = False


def rights(graph: FlowGraph) -> frozenset[Right]:
    """Return what each node may do with each channel, through wildcards too.

    Notes
    -----
    O(flows of the graph), each pair of wildcards that meet among them.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> graph, _, _ = factory()
    >>> [(node[2], role, channel[2]) for node, role, channel in sorted(rights(graph))][:2]
    [('/archive', 'subscribe', '/faces'), ('/archive', 'subscribe', '/filtered')]
    """
    elements, flows = graph.elements, one_by_one(graph.flows)
    met: dict[int, set[int]] = {}
    for flow in flows:
        if flow.role == MATCHES:
            met.setdefault(flow.source, set()).add(flow.target)
            met.setdefault(flow.target, set()).add(flow.source)
    found = set()
    for flow in flows:
        ends = (flow.source, flow.target) if elements[flow.target].is_channel else (flow.target, flow.source)
        if elements[ends[1]].is_channel and not elements[ends[0]].is_channel:
            for channel in (ends[1], *(met.get(ends[1], ()) if elements[ends[1]].pattern else ())):
                found.add((elements[ends[0]].identity, flow.role, elements[channel].identity))
    return frozenset(found)


def granted(graph: FlowGraph) -> frozenset[Ends]:
    """Return the flows of grants, by what they go between.

    Notes
    -----
    O(flows of the graph that are stored).

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> source, target, role, _ = sorted(granted(factory()[0]))[0]
    >>> source[2], target[2], role
    ('/archive', 'disk', 'flow')
    """
    elements = graph.elements
    stored = parted(graph.flows)[0]
    return frozenset(ends(elements[f.source], elements[f.target], f.role) for _, f in stored)


def ends(source: Element, target: Element, role: str) -> Ends:
    """Return what a flow goes between: two wildcards that are written alike differ in what DENYs take out of them.

    >>> from rosprivacy.analysis.model import Element
    >>> ends(Element("node", "/a"), Element("topic", "/v*", side="write", without=("rt/vx",)), "publish")[2:]
    ('publish', ('rt/vx',))
    """
    return source.identity, target.identity, role, (*source.without, *target.without)


def beyond(finding: Finding, declared: frozenset[Ends]) -> tuple[int, ...]:
    """Return the steps of a witness that policies allow, but not the profile of the node, by number.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> finding = analyse(*factory()).findings[0]
    >>> beyond(finding, granted(factory()[0])), beyond(finding, frozenset())
    ((), (0, 1, 2, 3))
    """
    keys = (ends(step.source, step.target, step.role) for step in finding.steps)
    return tuple(n for n, key in enumerate(keys) if finding.steps[n].grants and key not in declared)


def enclaves_of(finding: Finding, steps: tuple[int, ...]) -> tuple[str, ...]:
    """Return the enclaves that allow some steps of a witness, sorted.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> enclaves_of(analyse(*factory()).findings[0], (0,))
    ('/factory',)
    """
    return tuple(sorted({grant.enclave for n in steps for grant in finding.steps[n].grants}))
