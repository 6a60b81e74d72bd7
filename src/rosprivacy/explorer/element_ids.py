"""Short names of elements for a page: a graph goes in, out come ids that stay whatever is labelled (rule S1).

An id is made of what an element is, not of its place in the graph, so that it means the same in every version of a
session. It has letters and digits only, whatever stands in a policy.
"""

from __future__ import annotations

from functools import lru_cache
from hashlib import sha256
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.evidence import whole

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.model import Element, FlowGraph

DIGITS = 16  # hexadecimal: two of a million elements are alike with a chance of one in 30 million


@lru_cache(maxsize=1 << 16)
def element_id(identity: tuple[str, str, str]) -> str:
    """Return the id of an element of this identity; its legs and sides have the same.

    >>> element_id(("", "node", "/camera"))
    'e367b8bde1c84db46'
    """
    return f"e{sha256(chr(0).join(identity).encode('utf-8', 'surrogatepass')).hexdigest()[:DIGITS]}"


def by_id(graph: FlowGraph) -> Mapping[str, Element]:
    """Return the elements of a graph, whole, by their ids, in the order of the graph."""
    return {element_id(element.identity): whole(element) for element in graph.elements}
