"""One reason to label an element, what all reasons for one label come to, and the label as a label file has it.

All of it are questions for a person, never facts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Element, Method, Place

SOURCE, LEAK, DERIVATION, SENSITIVE = "source", "leak", "derivation", "sensitive"
SANITIZER, CONDUIT, MUNDANE, NEVER = "sanitizer", "conduit", "mundane", "never"
ROLES = (SOURCE, LEAK, DERIVATION, SENSITIVE, SANITIZER, CONDUIT, MUNDANE, NEVER)  # in the order in which they are told
TAKING_AWAY = frozenset([SANITIZER, MUNDANE, NEVER])  # a wrong one can hide a leak
HIDING = TAKING_AWAY | {CONDUIT}  # or that nobody looked
CODE, PACKAGE, TYPE, NAMED, DATA_FLOW, NEIGHBOUR = "code", "package", "type", "name", "data-flow", "neighbour"
MODEL = "model"  # a language model, which read names and types; it makes nothing surer than may
GLOBBED = "glob"  # a label that says otherwise, and names no element
SURE = (Confidence.CERTAIN, Confidence.LIKELY)
GROUNDS = (GLOBBED, CODE, PACKAGE, TYPE, NAMED, DATA_FLOW, NEIGHBOUR, MODEL)  # in the order of reasons
SORTS = (  # of what lies outside ROS
    "cloud", "language-model", "speech", "vision", "broker", "database", "file", "socket", "web-server", "http",
    "screen", "loudspeaker", "process",
)  # fmt: skip
WHERE = ("network", "display", "file", "loudspeaker", "device", "domain")  # to which a node sends what leaves ROS
ANYTHING = "PersonalData"  # the broadest category: a type that can carry it can carry anything

Identity = tuple[str, str, str]  # of an element


class SuggestedLabel(NamedTuple):
    """What is proposed for an element.

    Attributes
    ----------
    element
        Without leg and side: ``whole`` gives it. A node, or, of ``sensitive``, ``mundane`` and ``never``, a channel.
    kind
        Name of the category; empty for every one, of a conduit and of a mundane channel only.
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
        A few words that quote the input as it is, so whoever prints it makes it harmless.
    place
        Of the rule, or the line of code.
    family
        Of what says that a channel is made for other things than any kind: the family of its types, or the package that
        knows them. Of channels of one family it can be said in one list; empty if it is for each by itself.
    alone
        Whether it agrees with no other ground.
    where
        Of what lets data out: where to, one of ``WHERE``; empty where that is not known.
    """

    label: SuggestedLabel
    ground: str
    confidence: Confidence
    reason: str
    place: Place
    family: str = ""
    alone: bool = False
    where: str = ""


class LabelProposal(NamedTuple):
    """A label that a person is asked about, how sure all evidence makes it, and the evidence: the surest first."""

    label: SuggestedLabel
    confidence: Confidence
    evidence: tuple[Evidence, ...]


class WrittenLabel(NamedTuple):
    """What stands in a label file: ``section: {name: said}``."""

    section: str
    name: str
    roles: dict[str, Any]


def whole(element: Element) -> Element:
    """Return the element that a label speaks of: legs and sides are parts of one (rule S1).

    >>> from rosprivacy.analysis.model import Element
    >>> whole(Element("service", "/map", leg="request"))
    Element(kind='service', name='/map', robot='', leg='', side='', without=())
    """
    if not element.leg and not element.side:
        return element
    return type(element)(element.kind, element.name, element.robot)


def written(label: SuggestedLabel) -> WrittenLabel:
    """Return what a label is in a label file.

    ``mundane`` is ``never`` of the broadest category, and a conduit for every kind is one of the broadest: it means the
    same, and there is room for a note beside it.

    >>> from rosprivacy.analysis.model import Element, Method
    >>> node = Element("node", "/n")
    >>> written(SuggestedLabel(node, "source", "Video")).roles
    {'source': ['Video']}
    >>> written(SuggestedLabel(node, "sanitizer", "Video", Method.DROP)).roles
    {'sanitizer': {'Video': 'drop'}}
    >>> written(SuggestedLabel(Element("topic", "/a*"), "mundane"))
    WrittenLabel(section='topics', name='=/a*', roles={'never': ['PersonalData']})
    """
    kind = label.kind or ANYTHING
    said: dict[str, Any] = {NEVER if label.role == MUNDANE else label.role: [kind]}
    if label.role == SANITIZER:
        said = {SANITIZER: {kind: str(label.method)}}
    elif label.role == DERIVATION:
        said = {"derives": [{"from": kind, "to": label.to}]}
    return WrittenLabel(f"{label.element.kind}s", literal(label.element.name), said)
