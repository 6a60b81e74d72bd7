"""What somebody enters who acts on a node (keys, a window, a page), by the names of channels and services.

What a request to a service is about, by the name of the service: an order, a question to a model. An order is entered
at one place and told of at others: so it may be one, too, where a channel of the node is called after orders
(``/order_status``), and where the node asks for any service or action in a system of which a name speaks of orders. It
is ``may``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.carried_kinds import cannot_carry
from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, SOURCE
from rosprivacy.analysis.suggesting.name_rules import of_node, of_topic

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.evidence import Evidence
    from rosprivacy.analysis.suggesting.library_node import LibraryNode, Spoken
    from rosprivacy.analysis.suggesting.name_rules import NameRules

ENTERED_BY = "OperatorInput"  # what says that somebody acts on a node
ORDERED = "DeliveryOrder"  # what is entered at one place and told of at others


def orders_of(elements: Iterable[Element], names: NameRules) -> tuple[Element, ...]:
    """Return the elements that are called after what is ordered.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.example_till import TILL
    >>> [one.name for one in orders_of([Element("topic", "/orders"), Element("topic", "/map")], TILL.rules.names)]
    ['/orders']
    """
    return tuple(
        element
        for element in elements
        if (spoken := of_node(element.name, names.brings_in if element.is_node else names.carries))
        and ORDERED in spoken.rule.kinds
    )


def entered(node: LibraryNode, brought: Sequence[Spoken]) -> Iterator[Evidence]:
    """Yield what somebody enters, by the services that the node asks for.

    >>> from rosprivacy.analysis.suggesting.example_till import KEYS, TILL
    >>> [one.label.kind for one in entered(TILL, [KEYS])]
    ['DeliveryOrder']
    """
    acted, names = _acted(brought), node.rules.names
    for element, types in node.written if acted else ():
        spoken = of_topic(element.name, names) if element.leg == "request" else None
        for kind in spoken.rule.kinds if spoken else ():
            if kind in names.entered and not cannot_carry(kind, element, types, node.rules):
                then = f"; it asks for {element.name}"
                yield from (one.evidence(node.label(SOURCE, kind), Confidence.MAY, then) for one in acted)


def ordered(
    node: LibraryNode, brought: Sequence[Spoken], near: Sequence[Element], orders: Sequence[Element]
) -> Iterator[Evidence]:
    """Yield that somebody orders there, by a channel of the node, or by any name if it asks for a service.

    That name may be the node's own, and so it agrees with nothing.

    Parameters
    ----------
    near, orders
        What is called after orders: of the channels of the node, and of the whole system.

    Examples
    --------
    >>> from rosprivacy.analysis.suggesting.example_till import KEYS, ORDER, TILL
    >>> [one.reason for one in ordered(TILL, [KEYS], [ORDER], [])]
    ['uses input (libraries.yaml:3): it reads keys; /order speaks of orders']
    """
    asks = any(element.leg == "request" for element, _ in node.written)
    speaking = near or (orders if asks else ())
    for one in _acted(brought) if speaking and not node.cannot_write(ORDERED) else ():
        said = one.evidence(node.label(SOURCE, ORDERED), Confidence.MAY, f"; {speaking[0].name} speaks of orders")
        yield said._replace(ground=DATA_FLOW)


def _acted(brought: Sequence[Spoken]) -> Sequence[Spoken]:
    """What says first that somebody acts on the node."""
    return [one for one in brought if ENTERED_BY in one.rule.kinds][:1]
