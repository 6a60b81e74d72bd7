"""Channels that a governance leaves in the open, joined to what is bound to a graph (rule S10).

In: a graph, what is bound to it, and its policies. Out: what is bound, with them. Light, since every analysis asks it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Bound, FlowGraph, Policy


def with_exposed(graph: FlowGraph, bound: Bound, policies: Iterable[Policy]) -> Bound:
    """Return what is bound to a graph with the channels that a governance leaves in the open (rule S10)."""
    policies = [policy for policy in policies if policy.protections]
    if not policies:
        return bound
    from rosprivacy.ingest.keystore.protections import exposed_channels  # noqa: PLC0415 - light start

    return replace(bound, exposed=exposed_channels(graph, policies))
