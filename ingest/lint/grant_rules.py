"""Rules that a line breaks by what it grants: wildcards, names in the wrong namespace, what a DENY takes back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Breach
from rosprivacy.ingest.lint.rule_table import RULES
from rosprivacy.ingest.policies.names import is_pattern

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import FlowGraph, Grant

EVERYTHING = ("*", "/*", "rt/*", "rq/*", "rr/*")
STANDARD = ("rosout", "parameter_events", "clock")  # of every node, under one name in all namespaces


def grant_breaches(grants: Iterable[Grant], graph: FlowGraph) -> Iterator[Breach]:
    """Yield the rules that lines break; a line that several profiles include breaks a rule once.

    Parameters
    ----------
    graph
        Of the same policies, in the declared view.
    """
    for grant in grants:
        yield from _of_name(grant)
    taken: dict[Grant, None] = {}
    for flow in graph.denied:
        taken.update(dict.fromkeys(flow.grants))
    denials = {grant: flow.denials[0].place for flow in graph.denied for grant in flow.grants}
    for grant in taken:
        message = f"{grant.role} {shown(grant.name)} of {shown(grant.node)} is allowed here and denied at"
        yield Breach(RULES["overridden-allow"], grant.place, f"{message} {denials[grant]}: it grants nothing")


def _of_name(grant: Grant) -> Iterator[Breach]:
    if grant.allow and is_pattern(grant.name):
        rule = RULES["wildcard-everything" if grant.name in EVERYTHING else "wildcard"]
        message = f"{grant.role} {shown(grant.name)}: write out the names that are meant"
        yield Breach(rule, grant.place, message)
    base = grant.name.rpartition("/")[2]
    if grant.kind == "topic" and not grant.absolute and base in STANDARD and grant.name != f"/{base}":
        message = f"{grant.role} {shown(grant.name)}: nodes use /{base}, whatever their namespace; write it so"
        yield Breach(RULES["relative-standard-name"], grant.place, message)
