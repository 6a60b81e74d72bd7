"""A user's file of a package in place of a shipped one: what of the shipped one is asked all the same, and the notice.

In: packages. Out: a package, ``Diagnostic``. That data come in or go out is never taken away in silence: a source or a
leak that the shipped file states and the user's does not is still a question. What else the shipped one says is left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.suggesting.ros_package import Claim, Package, PackageNode

ENDS = (SOURCE, LEAK)
NAMED = 3  # statements in a notice


def left_of(shipped: Package, own: Package, hierarchy: Hierarchy) -> Package:
    """Return of a shipped package the sources and leaks that a user's file of its name does not state of such nodes.

    Nodes are the same by name; who states a kind states all narrower ones.
    """
    nodes = (left for node in shipped.nodes for left in _left(node, own, hierarchy))
    return shipped._replace(nodes=tuple(nodes))


def replacing(own: Package, left: Package) -> Diagnostic:
    """Return the notice that a user's file stands in place of a shipped one, of which so much is left."""
    said = [f"{claim.role} of {claim.kind} at {node.names[0]}" for node in left.nodes for claim in node.claims]
    message = f"it stands in place of the shipped package {own.name}"
    if said:
        more = f" and {len(said) - NAMED} more" if len(said) > NAMED else ""
        message += f"; what it does not state of that is asked all the same: {', '.join(said[:NAMED])}{more}"
    return Diagnostic(own.place, Severity.NOTICE, message)


def _left(node: PackageNode, own: Package, hierarchy: Hierarchy) -> Iterator[PackageNode]:
    """A node by each of its names, with the claims that are left under that name."""
    for name in node.names:
        stated = [claim for other in own.nodes if name in other.names for claim in other.claims]
        ends = (claim for claim in node.claims if claim.role in ENDS)
        claims = tuple(claim for claim in ends if not any(_covers(one, claim, hierarchy) for one in stated))
        if claims:
            yield node._replace(names=(name,), claims=claims)


def _covers(one: Claim, other: Claim, hierarchy: Hierarchy) -> bool:
    return one.role == other.role and hierarchy.distance(other.kind, one.kind) is not None
