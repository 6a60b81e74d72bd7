"""Rules that a line breaks by what it grants: wildcards, names in the wrong namespace, what a DENY takes back."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Breach
from rosprivacy.ingest.lint.rule_table import RULES
from rosprivacy.ingest.policies.names import DDS, covers, is_pattern

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import FlowGraph, Grant, Place

EVERYTHING = ("*", "/*", "rt/*", "rq/*", "rr/*")
NAMED = 3  # of the names that a line stands for
RELATIVE, WRITE_OUT = "relative-standard-name", "write out the names that are meant"
OTHER_END = {
    "publish": "subscribe", "subscribe": "publish", "request": "reply", "reply": "request", "call": "execute",
    "execute": "call",
}  # fmt: skip
STANDARD = ("rosout", "parameter_events", "clock")  # of every node, under one name in all namespaces


def grant_breaches(grants: Iterable[Grant], graph: FlowGraph) -> Iterator[Breach]:
    """Yield the rules that lines break; a line that several profiles include breaks a rule once.

    Parameters
    ----------
    graph
        Of the same policies, in the declared view.

    Notes
    -----
    Linear; beside that O(relative names of shared fragments, times the wildcards at the other end), and of permissions
    O(DENY times ALLOW lines of a subject).
    """
    grants = tuple(grants)
    of_line: dict[tuple[str, Place], list[Grant]] = defaultdict(list)
    for grant in grants:
        if rule := _rule(grant):
            of_line[rule, grant.place].append(grant)
    for (rule, place), some in of_line.items():
        roles, named = ", ".join(dict.fromkeys(grant.role for grant in some)), _few(grant.name for grant in some)
        base = some[0].name.rpartition("/")[2]
        hint = f"nodes use /{base}, whatever their namespace; write it so" if rule == RELATIVE else WRITE_OUT
        yield Breach(RULES[rule], place, f"{roles} {named}: {hint}")
    yield from _overridden(graph)
    yield from _alone_in_a_namespace(grants)
    yield from _too_late(grants)


def _rule(grant: Grant) -> str:
    """The rule that a line breaks by its name alone; empty if none."""
    base = grant.name.rpartition("/")[2]
    if grant.allow and is_pattern(grant.name):
        return "wildcard-everything" if grant.name in EVERYTHING else "wildcard"
    if grant.kind == "topic" and not grant.absolute and base in STANDARD and grant.name != f"/{base}":
        return RELATIVE
    return ""


def _overridden(graph: FlowGraph) -> Iterator[Breach]:
    taken: dict[tuple[Place, str, str], dict[str, Place]] = defaultdict(dict)
    for flow in graph.denied:
        for grant in flow.grants:
            taken[grant.place, grant.role, grant.name].setdefault(grant.node, flow.denials[0].place)
    for (place, role, name), nodes in taken.items():
        message = f"{role} {shown(name)} of {_few(nodes)} is allowed here and denied at {next(iter(nodes.values()))}"
        yield Breach(RULES["overridden-allow"], place, f"{message}: it grants nothing")


def _too_late(grants: Iterable[Grant]) -> Iterator[Breach]:
    """DENYs of permissions after an ALLOW of all that they name: the first rule that matches decides."""
    allowed: dict[tuple[str, str, str], list[Grant]] = defaultdict(list)
    for grant in grants:
        if grant.allow and grant.kind == DDS:
            allowed[grant.policy, grant.enclave, grant.role].append(grant)
    for grant in grants:
        if not (grant.allow or grant.dead):
            before = allowed.get((grant.policy, grant.enclave, grant.role), ())
            first = next((one for one in before if one.rank < grant.rank and covers(one.name, grant.name)), None)
            if first:
                message = f"{grant.role} {shown(grant.name)} is allowed at {first.place}, and the first rule decides"
                yield Breach(RULES["dead-deny"], grant.place, f"{message}; move the deny_rule before it")


def _alone_in_a_namespace(grants: Iterable[Grant]) -> Iterator[Breach]:
    """Lines that are other names in other namespaces: at the other end of some somebody is, of others nobody."""
    ends: dict[tuple[str, str], list[str]] = defaultdict(list)
    shared: dict[tuple[Place, str, str], dict[str, None]] = defaultdict(dict)
    for grant in grants:
        if not grant.allow:
            continue
        ends[grant.role, grant.kind].append(grant.name)
        own = grant.name.startswith(f"{grant.node}/")  # ~/name
        standard = grant.name.rpartition("/")[2] in STANDARD
        if grant.place.file != grant.policy and not (grant.absolute or own or standard or is_pattern(grant.name)):
            shared[grant.place, grant.role, grant.kind][grant.name] = None
    plain = {key: set(names) for key, names in ends.items()}
    patterns = {key: [name for name in names if is_pattern(name)] for key, names in plain.items()}
    for (place, role, kind), names in shared.items():
        if len(names) == 1:
            continue
        other = OTHER_END[role], kind
        met = {
            name: None
            for name in names
            if name in plain.get(other, ()) or any(covers(pattern, name) for pattern in patterns.get(other, ()))
        }
        if lone := [name for name in names if name not in met] if met else []:
            message = f"{role} {_few(lone)}: no other end, as {_few(met)} has; write it absolute, if that one is meant"
            yield Breach(RULES["relative-shared-name"], place, message)


def _few(names: Iterable[str]) -> str:
    unlike = list(dict.fromkeys(names))
    return ", ".join(map(shown, unlike[:NAMED])) + (", …" if len(unlike) > NAMED else "")
