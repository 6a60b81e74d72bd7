"""Flows between elements, and the graph that they make (rules S3 to S6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model.diagnostic import Place
    from rosprivacy.analysis.model.element import Element
    from rosprivacy.analysis.model.policy import Grant, Profile


class Flow(NamedTuple):
    """A directed step along which data can go, by index into ``FlowGraph.elements``.

    Attributes
    ----------
    role
        Of the grant behind it, or ``matches`` between a pattern and what it covers.
    grants
        The policy lines that allow it, or that a DENY overrides; empty for ``matches``.
    denials
        The DENY lines, for a denied flow.
    """

    source: int
    target: int
    role: str
    grants: tuple[Grant, ...] = ()
    denials: tuple[Grant, ...] = ()


@dataclass(frozen=True, slots=True)
class FlowGraph:
    """Elements and the flows between them.

    Attributes
    ----------
    elements
        The vertices, sorted by ``Element.sort_key``.
    flows
        Allowed flows, sorted by (source, target, role); at most one of each. Where many wildcards meet as many, these
        are ``Flows``, which stores none of the pairs.
    denied
        Flows that an ALLOW grants and a DENY takes back (rule S5), sorted alike.
    profiles
        Of all policies, sorted.
    view
        ``declared`` or ``enforced``, rule S6.
    denied_matches
        Flows of role ``matches`` that a DENY took out (rules S4, S5): between a pattern and what it would cover or
        meet. Sorted alike; ``grants`` is empty, ``denials`` are the DENY lines.
    careful
        DENY lines with wildcards that were too much to follow: a name is taken to be left, and flows with it.
    """

    elements: tuple[Element, ...]
    flows: Sequence[Flow]
    denied: tuple[Flow, ...]
    profiles: tuple[Profile, ...]
    view: str = "declared"
    denied_matches: tuple[Flow, ...] = ()
    careful: tuple[Place, ...] = ()

    @property
    def taken_back(self) -> tuple[Flow, ...]:
        """All that a DENY takes away: flows of grants, and what a wildcard would cover or meet."""
        return (*self.denied, *self.denied_matches)
