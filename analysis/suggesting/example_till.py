"""A till, whose keys somebody presses to order something, for the examples in docstrings."""

from __future__ import annotations

from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import Category, Confidence, Element, Place
from rosprivacy.analysis.suggesting.carried_kinds import Rules
from rosprivacy.analysis.suggesting.example_names import NAMES
from rosprivacy.analysis.suggesting.library_node import LibraryNode, Spoken
from rosprivacy.analysis.suggesting.library_rules import LibraryRule, NodeUse
from rosprivacy.analysis.suggesting.name_rules import NameRule

_AT = Place("libraries.yaml", 3)
_ORDERED = NameRule(("DeliveryOrder",), Confidence.MAY, "what is brought", _AT)
_RULES = Rules(
    {},
    {},
    NAMES._replace(carries={("order",): _ORDERED, ("orders",): _ORDERED}, entered=frozenset(["DeliveryOrder"])),
    Hierarchy.of([Category(name, "", "", "", "") for name in ("DeliveryOrder", "OperatorInput")]),
)
_KEYS = LibraryRule(("OperatorInput",), Confidence.MAY, "it reads keys", _AT)

ORDER = Element("service", "/order", leg="request")
KEYS = Spoken(_KEYS, NodeUse("input", "python", _AT))
TILL = LibraryNode.of(Element("node", "/till"), _RULES, [(ORDER, [])], [], [], reads=False)
