"""An element in the JSON document."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Element
    from rosprivacy.report.contract.records import ElementEntry


def element_dict(element: Element) -> ElementEntry:
    """Return E of the contract.

    >>> from rosprivacy.analysis.model import Element
    >>> element_dict(Element("service", "/add", leg="request"))
    {'robot': '', 'kind': 'service', 'name': '/add', 'leg': 'request'}
    """
    shown: ElementEntry = {"robot": element.robot, "kind": element.kind, "name": element.name}
    if element.leg:
        shown["leg"] = element.leg
    if element.pattern:
        shown["pattern"] = True
    return shown
