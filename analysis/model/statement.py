"""What labels state of elements and flows, and what nobody states (rules S7 to S9, S11)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model.diagnostic import Place
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.model.element import Element
    from rosprivacy.analysis.model.message_type import MessageType
    from rosprivacy.analysis.model.protection import Exposure
    from rosprivacy.analysis.model.recording import Recording


class Method(StrEnum):
    """What a sanitizer does, rule S8. Pseudonymise does not end the category (recital 26), the others do."""

    ANONYMISE = "anonymise"
    AGGREGATE = "aggregate"
    DROP = "drop"
    PSEUDONYMISE = "pseudonymise"
    ABSENT = "absent"  # no cleaning: a label says that the node is not on the robot, so nothing gets to it

    @property
    def ends(self) -> bool:
        """Whether nothing of the category leaves the sanitizer."""
        return self is not Method.PSEUDONYMISE


CLEANS = tuple(method for method in Method if method is not Method.ABSENT)  # what a label of a sanitizer can say
NAME, SEGMENT, GLOB = "name", "segment", "glob"  # how a label names an element
STANDARD = 0  # the tier of the file of standard channels (rule S13); users' files are above it
CHANGED = 3  # the tier of what a proposal changes: above all that is said now, in files and in a database
CANNOT, OF_TYPES = "cannot", (-2, 0)  # role and rank of what a type cannot carry: below all that anybody says (S15)
BY_TYPE, OF_LINES = "by-type", (-3, 0)  # role and rank of what 'only: by-type' closes: below what types cannot carry
TYPE_LINE = "type-line"  # the role of that line as it is written: by itself it closes nothing and reviews nothing
STATED = "flow"  # the role of a flow that a person states (rule S9)


class Statement(NamedTuple):
    """One thing that a label says of an element or a flow.

    Attributes
    ----------
    role
        Of a node: ``source``, ``leak``, ``sanitizer``, ``conduit``, ``derivation``, and ``no-source`` and ``no-leak``,
        which take back what is said by lower ranks. Of a channel: ``mundane``, ``sensitive``, ``only``, ``never``. Of a
        flow: ``only``, ``never``. Of the type of a channel: ``CANNOT``, of exactly the kinds that it names. Of
        ``only: by-type``: ``TYPE_LINE`` for the line, and ``BY_TYPE``, which closes exactly the kinds that it names.
    categories
        Names; empty means every category. One name for the roles of a node.
    rank
        (tier, specificity): shipped files below the user's own, globs below names; the higher wins.
    place
        Of the label.
    method
        Of a sanitizer.
    stated
        Whether the label states the method.
    to
        Of a derivation: the category that comes out.
    through
        Of a source: name expressions of the channels that carry it; empty means all.
    shipped
        Whether it comes from a file of mundane channels that is not the user's (rule S13).
    naming
        How the label names the element: by a full ``NAME``, by a glob with its last ``SEGMENT`` written out, or by
        another ``GLOB``.
    why
        A person's reason: the note beside it, or why a node is not on the robot.
    author
        Who says it, and answers for it; empty where nobody is named.
    pinned
        Of what has to be ``seen``, in a file with pins: the kinds, as they are emitted, that a person has seen at this
        element or flow; None in a file without. Of what was said of other code than there is now none: then what
        ``adds`` data holds, and reviews nothing. Of a ``TYPE_LINE``: the types and writers with which a person took
        it, as texts (``by_type.py``); none of a channel that is not pinned, None in a file without such pins.
    """

    role: str
    categories: tuple[str, ...]
    rank: tuple[int, int]
    place: Place
    method: Method | None = None
    stated: bool = True
    to: str = ""
    through: tuple[str, ...] = ()
    shipped: bool = False
    naming: str = NAME
    why: str = ""
    author: str = ""
    pinned: tuple[str, ...] | None = None

    @property
    def by_name(self) -> bool:
        """Whether a user says it of a full name."""
        return self.naming == NAME and self.rank[0] > STANDARD

    @property
    def glob(self) -> bool:
        """Whether a glob names what it is about."""
        return self.naming != NAME

    @property
    def to_be_seen(self) -> bool:
        """Whether a glob takes away or reviews: a person has to have seen what gets there (rule S11)."""
        return self.glob and not self.adds

    @property
    def adds(self) -> bool:
        """Whether it brings data in, lets it out or makes it of other: that holds whether or not it was seen."""
        return self.role in ("source", "leak", "derivation")

    def counts_for(self, category: str) -> bool:
        """Return whether it holds for a kind that gets there, as far as pins say (rule S11)."""
        return self.pinned is None or category in self.pinned

    @property
    def line(self) -> Statement:
        """What the label file says, which is the same wherever it holds, whatever is pinned there."""
        return self if self.pinned is None else self._replace(pinned=None)


NOWHERE = Place("", 0)


NO_BASIS = "none"  # in place of the basis of a transfer


class NonRosFacts(NamedTuple):
    """What is stated about a non-ROS element (rule S9).

    Attributes
    ----------
    retention
        (category, or ``EVERY``; how long it is kept), sorted.
    limits
        (category, or ``EVERY``; how long it may be kept), sorted; where several hold, the shortest counts.
    backups
        How long data stays in backups after it is deleted; True where that is not known, False without backups,
        None where nothing is said.
    encrypted
        Whether it is at rest; None where nothing is said.
    country
        ISO 3166-1 alpha-2 code.
    area
        Where that lies: ``INSIDE`` the EEA, outside with an adequacy decision (``ADEQUATE``), with one for some
        recipients (``PARTLY``), or ``THIRD``.
    adequacy
        Whom a partial decision covers.
    until
        The last day of an adequacy decision that ends by itself, ``YYYY-MM-DD``.
    operator
        Who runs it.
    recipient
        One of ``RECIPIENTS``.
    transfer
        Basis of a transfer out of the EEA, one of ``TRANSFERS``, as a person states it; ``NO_BASIS`` where a person
        states that there is none.
    contract
        On what it is operated for the controller, such as a contract under Article 28, in a person's words.
    place
        Where it is stated.
    recording
        Of a storage that is a bag: its size, its time, how much is in it.
    day
        The day that the age of a recording is held against, ``YYYY-MM-DD``; empty for none.
    """

    retention: tuple[tuple[str, Duration], ...] = ()
    limits: tuple[tuple[str, Duration], ...] = ()
    backups: Duration | bool | None = None
    encrypted: bool | None = None
    country: str = ""
    area: str = ""
    adequacy: str = ""
    until: str = ""
    operator: str = ""
    recipient: str = ""
    transfer: str = ""
    contract: str = ""
    place: Place = NOWHERE
    recording: Recording | None = None
    day: str = ""

    @property
    def basis(self) -> str:
        """The stated basis of a transfer; empty where none is stated, and where it is stated that there is none."""
        return "" if self.transfer == NO_BASIS else self.transfer


CONTEXTS = ("care", "public-space", "school", "union", "workplace", "worship")  # those of ontology/contexts.ttl
GDPR_APPLIES, GDPR_OPEN, GDPR_DENIED = "applies", "open", "denied"  # whether it does, Article 3


class Surroundings(NamedTuple):
    """Where an element of a robot works, as labels state it: what data reveals there, and whose law is to be looked at.

    Attributes
    ----------
    contexts
        Some of ``CONTEXTS``, sorted.
    country
        ISO 3166-1 alpha-2 code of the country where it runs; empty where nobody states it.
    abroad
        Whether that country is outside the EEA.
    established
        Whether the processing belongs to an establishment of the controller or a processor in the Union (GDPR, Article
        3(1)); None where nobody states it.
    targeted
        Whether persons in the Union are offered goods or services, or monitored there (Article 3(2)); as before.
    """

    contexts: tuple[str, ...] = ()
    country: str = ""
    abroad: bool = False
    established: bool | None = None
    targeted: bool | None = None

    def __bool__(self) -> bool:
        """Whether anything is stated."""
        return self != Surroundings()

    @property
    def gdpr(self) -> str:
        """Whether the GDPR applies (Article 3), as far as it is stated.

        Outside the EEA that is a question until one of its two grounds is affirmed or both are denied.

        >>> robot = Surroundings(country="US", abroad=True)
        >>> robot.gdpr, robot._replace(established=False).gdpr, robot._replace(established=False, targeted=False).gdpr
        ('open', 'open', 'denied')
        """
        if not self.abroad or self.established or self.targeted:
            return GDPR_APPLIES
        return GDPR_DENIED if self.established is False and self.targeted is False else GDPR_OPEN


ByCategory = tuple[tuple[str, tuple[str, ...]], ...]  # (category, or ``EVERY``; what is stated of it), sorted


class Processing(NamedTuple):
    """Who is responsible for processing, what it is for and on which legal basis, as people state it.

    It changes no flow, no finding and no verdict. Source: GDPR, Articles 5(1)(b), 6, 9(2), 30(1)(a) and (b).

    Attributes
    ----------
    controller, dpo
        Of a robot or a system; empty of an element.
    purposes
        In a person's words.
    bases
        Such as ``6(1)(f)`` and ``9(2)(h)``.
    place
        Where it is stated.
    """

    controller: str = ""
    dpo: str = ""
    purposes: ByCategory = ()
    bases: ByCategory = ()
    place: Place = NOWHERE

    def __bool__(self) -> bool:
        """Whether anything is stated."""
        return bool(self.controller or self.dpo or self.purposes or self.bases)


UNSTATED = Processing()


@dataclass(frozen=True, slots=True)
class Bound:
    """Statements joined to a graph.

    Attributes
    ----------
    elements
        By vertex.
    flows
        By index of an allowed flow.
    through
        (vertex, ``Statement.through``) -> the flows out of the vertex that these name expressions mean.
    outside
        What is stated about non-ROS elements, by vertex (rule S9).
    subjects
        By vertex: whom the data of a source are about, sorted. It changes no flow.
    surroundings
        By vertex: where an element works, its own with those of its system. It changes no flow.
    elsewhere
        (kind, name) -> contexts of elements on robots for which those of the graph stand, and which are not in it.
    scopes
        (kind, name) -> whether the GDPR applies where sources of such robots work.
    processing
        By vertex: what the data there are processed for, and on which basis.
    of_robots
        By robot: the same of all that is on it; with who is responsible.
    types
        By vertex: the message types of a channel (rule S15), sorted.
    exposed
        By vertex: why who is on the network can read what flows on a channel, sorted.
    """

    elements: Mapping[int, tuple[Statement, ...]]
    flows: Mapping[int, tuple[Statement, ...]] = field(default_factory=dict)
    through: Mapping[tuple[int, tuple[str, ...]], tuple[int, ...]] = field(default_factory=dict)
    outside: Mapping[int, NonRosFacts] = field(default_factory=dict)
    subjects: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    surroundings: Mapping[int, Surroundings] = field(default_factory=dict)
    processing: Mapping[int, Processing] = field(default_factory=dict)
    of_robots: Mapping[str, Processing] = field(default_factory=dict)
    elsewhere: Mapping[tuple[str, str], frozenset[str]] = field(default_factory=dict)
    scopes: Mapping[tuple[str, str], frozenset[str]] = field(default_factory=dict)
    types: Mapping[int, tuple[MessageType, ...]] = field(default_factory=dict)
    exposed: Mapping[int, tuple[Exposure, ...]] = field(default_factory=dict)


class UnknownEnd(NamedTuple):
    """An element at which data's way ends without anybody known, rule S11.

    Attributes
    ----------
    element
        A channel, or a leg of one, with data; or an element outside ROS.
    missing
        What is not known: the ``reader`` of a channel, of a service's leg its server or client; the ``flow`` that
        leads to an element outside ROS.
    categories
        What is on the channel, sorted.
    """

    element: Element
    missing: str
    categories: tuple[str, ...] = ()
