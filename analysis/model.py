"""The facts that the rooms hand to each other, as frozen dataclasses. Names are those of the glossary.

Nothing here reads or writes anything; validation is done where a fact is made.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.durations import Duration

CHANNELS = ("action", "service", "topic")
NON_ROS = ("device", "display", "external-system", "person", "shared-memory", "side-channel", "storage")  # rule S9
KINDS = ("node", *NON_ROS, *CHANNELS)  # channels last: flow.py sweeps them and the others in turn
DISCLOSURE, STORAGE_LIMITATION, THIRD_COUNTRY = "disclosure", "storage-limitation", "third-country-transfer"  # S10


@dataclass(frozen=True, slots=True)
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
    """

    kind: str
    name: str
    robot: str = ""
    leg: str = ""
    side: str = ""
    without: tuple[str, ...] = ()

    @property
    def pattern(self) -> bool:
        """Whether the name is a wildcard expression."""
        return bool(self.side)

    @property
    def is_node(self) -> bool:
        """Whether this is a ROS node."""
        return self.kind == "node"

    @property
    def is_channel(self) -> bool:
        """Whether this is a topic, service or action: it only passes on; all others take part like nodes (rule S9)."""
        return self.kind in CHANNELS

    @property
    def full_name(self) -> str:
        """The name, with the robot's where there are several."""
        return f"{self.robot}:{self.name}" if self.robot else self.name

    @property
    def identity(self) -> tuple[str, str, str]:
        """(robot, kind, name), rule S1: legs and sides are parts of one element."""
        return (self.robot, self.kind, self.name)

    @property
    def shown_as(self) -> tuple[str, str, str, str]:
        """What a reader sees: the identity and the leg, without the side of a pattern."""
        return (self.robot, self.kind, self.name, self.leg)

    def sort_key(self) -> tuple[object, ...]:
        """Nodes first, then by robot, name and part: the order of all output (rule S14)."""
        return (KINDS.index(self.kind), self.robot, self.name, self.leg, self.side, self.without)


@dataclass(frozen=True, slots=True)
class Place:
    """A line of a file; line 0 where there is none."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


@dataclass(frozen=True, slots=True)
class Profile:
    """A node's entry in an enclave, ``<profile ns node>``."""

    enclave: str
    node: str
    place: Place


@dataclass(frozen=True, slots=True)
class Grant:
    """What one policy line allows or denies to one profile.

    Attributes
    ----------
    allow
        False for DENY.
    role
        As written: ``publish``, ``subscribe``, ``reply``, ``request``, ``call`` or ``execute``.
    kind
        Of the channel as written: ``topic``, ``service`` or ``action``.
    name
        Fully qualified.
    policy
        The policy file that was read, whatever it includes: a DENY counts in its own policy only (rule S5).
    dead
        Whether the line stands after the first ``<profiles>`` of the first ``<enclave>`` of its path: sros2 does not
        read it there. An ALLOW is taken all the same, a DENY takes nothing away (rule S5).
    absolute
        Whether the policy writes the name so: then it stays as it is under a namespace that is pushed (rule S1).
    """

    allow: bool
    role: str
    kind: str
    name: str
    enclave: str
    node: str
    place: Place
    policy: str = ""
    dead: bool = False
    absolute: bool = False


NOT_READ = "not-read"  # a file that was passed over, or read only where a policy includes it
UNREAD_FILE = "unread-file"  # grants that no policy brings in: what they allow is not known (rule S11)
DEAD_DENY = "dead-deny"
SHARED_ENCLAVE = "shared-enclave"
MERGED = "merged"  # policies that make one graph, and may not have been meant to
FALLBACK_TAKEN = "fallback-taken"
EMPTY_GROUP = "empty-group"
REFUSED_NAME = "refused-name"
NO_SOURCE = "no-source"  # what 'no leak found' lacks, so that it says nothing (rules S11, S12)
GOES_NOWHERE = "goes-nowhere"
NO_LEAK_NAMED = "no-leak-named"
NOTHING_FOLLOWED = (NO_SOURCE, GOES_NOWHERE)


class Severity(StrEnum):
    """How much a diagnostic weighs. An error ends the run, so a report shows warnings and notices only."""

    ERROR = "error"
    WARNING = "warning"
    NOTICE = "notice"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """Something that the reader of a report has to know about an input.

    Attributes
    ----------
    code
        What it is, for programs: ``UNREAD_FILE`` and others; empty where nobody has to tell it from others.
    """

    place: Place
    severity: Severity
    message: str
    code: str = ""


def unread(diagnostics: Iterable[Diagnostic]) -> tuple[Place, ...]:
    """Return where grants stand that were not read (rule S11), sorted."""
    places = {said.place for said in diagnostics if said.code == UNREAD_FILE}
    return tuple(sorted(places, key=lambda place: (place.file, place.line)))


@dataclass(frozen=True, slots=True)
class Policy:
    """What one policy file grants, with everything that it includes.

    Attributes
    ----------
    sources
        (file, SHA-256) of the policy and of all that it includes, sorted.
    """

    file: str
    sources: tuple[tuple[str, str], ...]
    profiles: tuple[Profile, ...]
    grants: tuple[Grant, ...]
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, slots=True)
class Flow:
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
        Allowed flows, sorted by (source, target, role); at most one of each.
    denied
        Flows that an ALLOW grants and a DENY takes back (rule S5), sorted alike.
    profiles
        Of all policies, sorted.
    view
        ``declared`` or ``enforced``, rule S6.
    denied_matches
        Flows of role ``matches`` that a DENY took out (rules S4, S5): between a pattern and what it would cover or
        meet. Sorted alike; ``grants`` is empty, ``denials`` are the DENY lines.
    """

    elements: tuple[Element, ...]
    flows: tuple[Flow, ...]
    denied: tuple[Flow, ...]
    profiles: tuple[Profile, ...]
    view: str = "declared"
    denied_matches: tuple[Flow, ...] = ()

    @property
    def taken_back(self) -> tuple[Flow, ...]:
        """All that a DENY takes away: flows of grants, and what a wildcard would cover or meet."""
        return (*self.denied, *self.denied_matches)


ARTICLE_9 = "GDPR Art. 9(1)"
ARTICLE_9_VERDICTS = ("always", "conditional", "may-reveal", "no", "unknown")


@dataclass(frozen=True, slots=True)
class Legal:
    """That data of a category can be what a provision speaks of.

    Attributes
    ----------
    iri, name, meaning
        Of the provision; its meaning in one sentence of our own.
    as_of
        Date of the law, ``YYYY-MM-DD``.
    verdict
        ``always``, ``conditional`` or ``may-reveal``.
    condition
        When, where it is not always.
    sources
        Names of the provisions and guidelines that the verdict rests on, sorted.
    stated_of
        Name of the category that the ontology says it of: this one, a broader one, or narrower ones.
    translations
        Language -> ``meaning``, ``condition``, ``name`` and ``sources`` (in a row) in it.
    """

    iri: str
    name: str
    meaning: str
    as_of: str
    verdict: str
    condition: str = ""
    sources: tuple[str, ...] = ()
    stated_of: str = ""
    translations: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    @property
    def special(self) -> bool:
        """Whether it is Article 9(1) GDPR."""
        return self.name == ARTICLE_9 or self.name.startswith(f"{ARTICLE_9} ")

    def text(self, what: str, language: str) -> str:
        """Return its ``meaning``, ``condition`` or ``name`` in a language, in English if there is no translation."""
        return self.translations.get(language, {}).get(what) or str(getattr(self, what))


@dataclass(frozen=True, slots=True)
class Category:
    """A kind of personal data.

    Attributes
    ----------
    name
        Short name, the IRI's last part; used in label files.
    iri
        Full IRI.
    label
        Neo4j label name, an identifier, unique.
    title
        English name for people.
    definition
        One sentence.
    broader
        Names of the direct broader categories (``skos:broader``), sorted.
    synonyms
        Other names that find it, in any language, sorted.
    law
        Provisions that it falls under, sorted by name.
    reason
        Why it does not fall under Article 9(1), where the ontology says so.
    stated_of
        Names of the categories that ``law`` and ``reason`` are stated of; empty as read from the ontology.
    data_types
        How it is represented: image, audio, position, …, sorted.
    gdpr
        Name of the provision that defines its GDPR category.
    same_as, within
        IRIs of other vocabularies: the same concept, broader ones; sorted.
    note
        For readers of the ontology.
    translations
        Language -> ``title``, ``definition``, ``reason`` and ``gdpr`` in it.
    """

    name: str
    iri: str
    label: str
    title: str
    definition: str
    broader: tuple[str, ...] = ()
    synonyms: tuple[str, ...] = ()
    law: tuple[Legal, ...] = ()
    reason: str = ""
    stated_of: tuple[str, ...] = ()
    data_types: tuple[str, ...] = ()
    gdpr: str = ""
    same_as: tuple[str, ...] = ()
    within: tuple[str, ...] = ()
    note: str = ""
    translations: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """All that it is called: a text that is one of them, in upper or lower case, means it."""
        return tuple(filter(None, (self.name, self.iri, self.label, self.title, *self.synonyms)))

    @property
    def article9(self) -> str:
        """The strongest verdict under Article 9(1) GDPR: one of ``ARTICLE_9_VERDICTS``."""
        verdicts = {legal.verdict for legal in self.law if legal.special}
        stated = "no" if self.reason else "unknown"
        return next((verdict for verdict in ARTICLE_9_VERDICTS[:3] if verdict in verdicts), stated)

    def text(self, what: str, language: str) -> str:
        """Return its ``title``, ``definition``, ``reason`` or ``gdpr`` in a language, else in English."""
        return self.translations.get(language, {}).get(what) or str(getattr(self, what))


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
STATED = "flow"  # the role of a flow that a person states (rule S9)


@dataclass(frozen=True, slots=True)
class Statement:
    """One thing that a label says of an element or a flow.

    Attributes
    ----------
    role
        Of a node: ``source``, ``leak``, ``sanitizer``, ``conduit``, ``derivation``, and ``no-source`` and ``no-leak``,
        which take back what is said by lower ranks. Of a channel: ``mundane``, ``sensitive``, ``only``, ``never``. Of a
        flow: ``only``, ``never``.
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
        Of a node that is not on the robot: a person's reason.
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

    @property
    def by_name(self) -> bool:
        """Whether a user says it of a full name."""
        return self.naming == NAME and self.rank[0] > STANDARD

    @property
    def glob(self) -> bool:
        """Whether a glob names what it is about."""
        return self.naming != NAME


NOWHERE = Place("", 0)


@dataclass(frozen=True, slots=True)
class NonRosFacts:
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
    country
        ISO 3166-1 alpha-2 code.
    area
        Where that lies: ``INSIDE`` the EEA, outside with an adequacy decision (``ADEQUATE``), with one for some
        recipients (``PARTLY``), or ``THIRD``.
    adequacy
        Whom a partial decision covers.
    until
        The last day of an adequacy decision that ends by itself, ``YYYY-MM-DD``.
    encrypted
        Whether it is at rest; None where nothing is said.
    operator
        Who runs it.
    recipient
        One of ``RECIPIENTS``.
    transfer
        Basis of a transfer out of the EEA, one of ``TRANSFERS``, as a person states it.
    place
        Where it is stated.
    """

    retention: tuple[tuple[str, Duration], ...] = ()
    limits: tuple[tuple[str, Duration], ...] = ()
    backups: Duration | bool | None = None
    country: str = ""
    area: str = ""
    adequacy: str = ""
    until: str = ""
    encrypted: bool | None = None
    operator: str = ""
    recipient: str = ""
    transfer: str = ""
    place: Place = NOWHERE


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
    """

    elements: Mapping[int, tuple[Statement, ...]]
    flows: Mapping[int, tuple[Statement, ...]] = field(default_factory=dict)
    through: Mapping[tuple[int, tuple[str, ...]], tuple[int, ...]] = field(default_factory=dict)
    outside: Mapping[int, NonRosFacts] = field(default_factory=dict)
    subjects: Mapping[int, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class UnknownEnd:
    """An element at which data's way ends without anybody known, rule S11.

    Attributes
    ----------
    element
        A channel, or a leg of one, with data; or an element outside ROS.
    what
        What is not known: the ``reader`` of a channel, of a service's leg its server or client; the ``flow`` that
        leads to an element outside ROS.
    categories
        What is on the channel, sorted.
    """

    element: Element
    what: str
    categories: tuple[str, ...] = ()
