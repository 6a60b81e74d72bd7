"""Policies under a namespace that is pushed, as a robot's launch file does it (rule S1).

In: policies as they are written, and a namespace. Out: what they grant when they run under it; and what a reader has to
know of names that a policy writes absolute, which no namespace is put before.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.written_names import listed
from rosprivacy.ingest.policies.names import is_pattern, overlaps

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Grant, Place, Policy

EVERYTHING = "/*"  # means the same under every namespace


def pushed(policy: Policy, namespace: str) -> Policy:
    """Return a policy as it runs: nodes, relative and ``~`` names get the namespace, names written absolute stay."""
    if not namespace:
        return policy
    return replace(
        policy,
        profiles=tuple(p._replace(node=_under(namespace, p.node)) for p in policy.profiles),
        grants=tuple(
            g._replace(node=_under(namespace, g.node), name=g.name if g.absolute else _under(namespace, g.name))
            for g in policy.grants
        ),
    )


def _under(namespace: str, name: str) -> str:
    return namespace + name if name.startswith("/") else f"{namespace}/{name}"


def as_written(grant: Grant, namespace: str) -> Grant:
    """Return a grant of ``pushed`` without the namespace."""
    name = grant.name if grant.absolute else grant.name.removeprefix(namespace)
    return grant._replace(name=name, node=grant.node.removeprefix(namespace))


def depends(policies: Iterable[Policy], namespace: str) -> bool:
    """Whether it matters which namespace is pushed: absolute names lie in it, or are those of relative names."""
    grants = [grant for policy in policies for grant in policy.grants]
    absolute = {grant.name for grant in grants if grant.absolute}
    return any(_meets(name, namespace) for name in absolute) or bool(_twice(grants))


def _meets(name: str, namespace: str) -> bool:
    if is_pattern(name):
        return name != EVERYTHING and overlaps(name, f"{namespace}/*")
    return name.startswith(f"{namespace}/")


def _twice(grants: Iterable[Grant]) -> set[tuple[str, str]]:
    """(kind, name) of channels that are written in both ways, so that there are two under a namespace."""
    written: dict[bool, set[tuple[str, str]]] = {True: set(), False: set()}
    for grant in grants:
        written[grant.absolute].add((grant.kind, grant.name))
    return written[True] & written[False]


def notices(policies: Sequence[Policy], owner: str, namespace: str) -> Iterator[Diagnostic]:
    """Yield what a reader has to know of a namespace that is pushed.

    Parameters
    ----------
    owner
        Robot or model, as a message begins.
    """
    grants = [grant for policy in policies for grant in policy.grants]
    absolute = [grant for grant in grants if grant.absolute]
    if not namespace or not absolute:
        return
    names = sorted({grant.name for grant in absolute})
    stay = (
        "1 name is written absolute and stays"
        if len(names) == 1
        else f"{len(names)} names are written absolute and stay"
    )
    message = f"{owner}: {stay} outside the namespace that is pushed: {listed(names)}"
    yield Diagnostic(_first(absolute), Severity.NOTICE, message)
    if twice := sorted({name for _, name in _twice(grants)}):
        both = [grant for grant in absolute if grant.name in twice]
        message = (
            f"{owner}: {listed(twice)} written absolute and relative, under the namespace that is pushed two channels "
            "each; labels mean the absolute one, and the other by its full name"
        )
        yield Diagnostic(_first(both), Severity.WARNING, message)


def _first(grants: Iterable[Grant]) -> Place:
    return min((grant.place for grant in grants), key=lambda place: (place.file, place.line))
