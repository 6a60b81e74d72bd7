"""An element of the graph and the kinds there are; flows between elements, and the graph (rules S1, S3 to S6, S9)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.python_311 import dataclass_transform

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model.diagnostic import Place
    from rosprivacy.analysis.model.policy import Grant, Profile

C = TypeVar("C")


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def fact(cls: type[C]) -> type[C]:
    """Make a frozen dataclass of a class: the type checker lets nobody change one.

    It is not held at run time, where a frozen one takes several times as long to make.

    Examples
    --------
    >>> class Hop:
    ...     source: int
    ...     target: int
    >>> Hop = fact(Hop)
    >>> Hop(0, 1), Hop(0, 1) in {Hop(0, 1)}
    (Hop(source=0, target=1), True)
    """
    return dataclass(slots=True, unsafe_hash="__hash__" not in cls.__dict__)(cls)


CHANNELS = ("action", "service", "topic")
NETWORK = "network"  # the participant that stands for whoever is on the network, where nothing is enforced (rule S6)
PARTICIPANT = "participant"  # what was seen in a domain and is no node (rule S16)
NON_ROS = (  # rule S9
    "device", "display", "external-system", PARTICIPANT, "person", "shared-memory", "side-channel", "storage",
)  # fmt: skip
KINDS = ("node", *NON_ROS, *CHANNELS)  # channels last: kernel/fixpoint.py sweeps them and the others in turn
_RANKS = {kind: rank for rank, kind in enumerate(KINDS)}


@fact
class Element:
    """Anything in the graph; identity is (robot, kind, name), rule S1.

    Attributes
    ----------
    kind
        One of ``KINDS``.
    name
        Fully qualified; with wildcards where the element is a pattern.
    robot
        Empty where there is only one.
    leg
        ``request`` or ``response`` of a service or action, rule S2; empty otherwise.
    side
        Only of a pattern (rule S4): ``write`` for what is written to names that it matches, ``read`` for what is
        read from them. Two vertices, so that nothing flows from one name to another through a wildcard.
    without
        Only of a pattern: the DDS expressions that a DENY of its enclave takes out of it (rule S5), sorted.
    is_channel
        Whether this is a topic, service or action: it only passes on; all others take part like nodes (rule S9).
    identity
        (robot, kind, name), rule S1: legs and sides are parts of one element.
    shown_as
        What a reader sees: the identity and the leg, without the side of a pattern.
    """

    kind: str
    name: str
    robot: str = ""
    leg: str = ""
    side: str = ""
    without: tuple[str, ...] = ()
    is_channel: bool = field(init=False, repr=False, compare=False)
    identity: tuple[str, str, str] = field(init=False, repr=False, compare=False)
    shown_as: tuple[str, str, str, str] = field(init=False, repr=False, compare=False)
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Reckon once what is asked for most often."""
        object.__setattr__(self, "is_channel", self.kind in CHANNELS)
        object.__setattr__(self, "identity", (self.robot, self.kind, self.name))
        object.__setattr__(self, "shown_as", (self.robot, self.kind, self.name, self.leg))
        object.__setattr__(self, "_hash", hash((self.name, self.robot, self.leg, self.kind)))

    def __hash__(self) -> int:
        return self._hash

    def __reduce__(self) -> tuple[object, ...]:
        """Without the hash, which is another one in another process."""
        return Element, (self.kind, self.name, self.robot, self.leg, self.side, self.without)

    @property
    def pattern(self) -> bool:
        """Whether the name is a wildcard expression."""
        return bool(self.side)

    @property
    def is_node(self) -> bool:
        """Whether this is a ROS node."""
        return self.kind == "node"

    @property
    def full_name(self) -> str:
        """The name, with the robot's where there are several."""
        return f"{self.robot}:{self.name}" if self.robot else self.name

    def sort_key(self) -> tuple[object, ...]:
        """Nodes first, then by robot, name and part: the order of all output (rule S14)."""
        return (_RANKS[self.kind], self.robot, self.name, self.leg, self.side, self.without)


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
