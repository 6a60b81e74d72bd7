"""What may be changed to remove findings, and at what cost; stated by the user."""

from __future__ import annotations

from dataclasses import dataclass, field

REVIEW, FILTER, DENY = "review", "filter", "deny"
CHANGES = (REVIEW, FILTER, DENY)
LARGEST_COST = 1_000_000


@dataclass(frozen=True, slots=True)
class Weights:
    """What changes cost, in whole numbers of the user's choice.

    Attributes
    ----------
    review, filter, deny
        One of them; a DENY per line.
    node
        Each node that is no leak and would get filtered data, or lose some, directly.
    """

    review: int = 1
    filter: int = 10
    node: int = 10
    deny: int = 20


@dataclass(frozen=True, slots=True)
class LimitRule:
    """What the user says of some places.

    Attributes
    ----------
    flows, vertices
        The places.
    excluded
        Kinds of change that are not made there.
    factor
        How many times as dear a change is there.
    """

    flows: frozenset[int]
    vertices: frozenset[int]
    excluded: frozenset[str] = frozenset()
    factor: int = 1


@dataclass(frozen=True, slots=True)
class Limits:
    """What may be changed, and at what cost.

    Attributes
    ----------
    kinds
        Of changes that are allowed at all.
    critical
        Nodes for which data may not come late: nothing on a path to them is filtered or cut. What comes back from
        a leak is not counted, as in rule S10.
    """

    weights: Weights = field(default_factory=Weights)
    kinds: frozenset[str] = frozenset(CHANGES)
    critical: frozenset[int] = frozenset()
    rules: tuple[LimitRule, ...] = ()
