"""One reason to label an element, and what all reasons for one label come to: questions for a person, never facts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Confidence, Element, Method, Place

SOURCE, LEAK, DERIVATION, SENSITIVE = "source", "leak", "derivation", "sensitive"
SANITIZER, CONDUIT, MUNDANE, NEVER = "sanitizer", "conduit", "mundane", "never"
ROLES = (SOURCE, LEAK, DERIVATION, SENSITIVE, SANITIZER, CONDUIT, MUNDANE, NEVER)  # in the order in which they are told
TAKING_AWAY = frozenset([SANITIZER, MUNDANE, NEVER])  # a wrong one can hide a leak
HIDING = TAKING_AWAY | {CONDUIT}  # or that nobody looked
OF_NODES = frozenset([SOURCE, LEAK, DERIVATION, SANITIZER, CONDUIT])  # the others are said of channels
CODE, PACKAGE, TYPE, NAMED, DATA_FLOW, NEIGHBOUR = "code", "package", "type", "name", "data-flow", "neighbour"
MODEL = "model"  # a language model, which read names and types; it makes nothing surer than may
GLOBBED = "glob"  # a label that says otherwise, and names no element
GROUNDS = (
    GLOBBED,
    CODE,
    PACKAGE,
    TYPE,
    NAMED,
    DATA_FLOW,
    NEIGHBOUR,
    MODEL,
)  # what evidence comes from, in the order of reasons
INDEPENDENT = frozenset([CODE, TYPE, NAMED])  # the others know types and names, or are drawn from them


class Label(NamedTuple):
    """What is proposed for an element.

    Attributes
    ----------
    element
        Without leg and side: ``whole`` gives it. A node for the roles ``OF_NODES``, else a channel.
    role
        One of ``ROLES``.
    kind
        Name of the category; empty for every one, of a conduit and of a mundane channel only.
    method
        Of a sanitizer.
    to
        Of a derivation: the category that comes out.
    """

    element: Element
    role: str
    kind: str = ""
    method: Method | None = None
    to: str = ""


class Evidence(NamedTuple):
    """One reason for a label.

    Attributes
    ----------
    ground
        One of ``GROUNDS``: the provider.
    reason
        A few words that quote the input, such as ``type sensor_msgs/msg/Image of /camera``; text of the input is
        shown as it is, so whoever prints it makes it harmless.
    place
        Of the rule, or the line of code.
    family
        Of what says that a channel is made for other things than any kind: the family of its types, or the package that
        knows them. Of channels of one family it can be said in one list; empty if it is for each by itself.
    alone
        Whether it agrees with no other ground.
    beside
        A narrower kind, beside which it is said: who has named that one is not asked.
    """

    label: Label
    ground: str
    confidence: Confidence
    reason: str
    place: Place
    family: str = ""
    alone: bool = False
    beside: str = ""


class Proposal(NamedTuple):
    """A label that a person is asked about.

    Attributes
    ----------
    confidence
        What all evidence comes to.
    evidence
        The surest first; each reason once.
    """

    label: Label
    confidence: Confidence
    evidence: tuple[Evidence, ...]


def whole(element: Element) -> Element:
    """Return the element that a label speaks of: legs and sides are parts of one (rule S1).

    >>> from rosprivacy.analysis.model import Element
    >>> whole(Element("service", "/map", leg="request"))
    Element(kind='service', name='/map', robot='', leg='', side='', without=())
    """
    if not element.leg and not element.side:
        return element
    return type(element)(element.kind, element.name, element.robot)
