"""A line of a file, and what a reader of a report has to know about it; rules of how a policy is written."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Iterable

NOT_READ = "not-read"  # a file that was passed over, or read only where a policy includes it
UNREAD_FILE = "unread-file"  # grants that no policy brings in: what they allow is not known (rule S11)
DEAD_DENY = "dead-deny"
PATHS_NOT_COUNTED = "paths-not-counted"  # of some findings: a number of paths that share no flow is a lower bound
CAREFUL_DENY = "careful-deny"  # with others too much to follow: a name is taken to be left
SHARED_ENCLAVE = "shared-enclave"
MERGED = "merged"  # policies that make one graph, and may not have been meant to
FALLBACK_TAKEN = "fallback-taken"
EMPTY_GROUP = "empty-group"
EMPTY_INCLUDE = "empty-include"
DUPLICATE_ENCLAVE = "duplicate-enclave"
SEVERAL_PROFILES = "several-profiles"
DIALECT = "dialect"  # a form of policies that sros2 refuses
ODD_NAMESPACE = "odd-namespace"  # one that does not begin with /
MISTAKEN_TILDE = "mistaken-tilde"
REFUSED_NAME = "refused-name"
LEGAL_BASIS = "legal-basis"  # one that is stated lacks something that the law asks for
OBSERVED = "observed"  # from when to when, by which doors: what was not seen proves nothing (rule S16)
SCANNED = "scanned"  # a policy that was made of source code: what the code does beside is not in it (rule S16)
SCAN_GAP = "scan-gap"  # what a scan could not resolve, at its line: the verdict is undetermined at best (S16)
ENCLAVES_MADE_UP = "enclaves-made-up"
FOLDED_NAMES = "folded-names"
OBSERVATION_GAP = "observation-gap"  # what an observation is known to miss: the verdict is undetermined at best (S16)
BAG_GAP = "bag-gap"  # what is not known of a bag that is a storage: the verdict is undetermined at best (S11)
ACCESS_GAP = "access-gap"  # permissions are not asked, or not read: what is allowed is not known (S6, S11)
NOTHING_ENFORCED = "nothing-enforced"  # for nodes that were observed, and of which no policy is deployed (rule S6)
JOINS_NOTHING = "joins-nothing"  # a domain or infrastructure: data that gets there goes no further (rule S11)
LEAK_JOINS_NOTHING = "leak-joins-nothing"  # one in which data is let out or kept, if it got there
TYPES_OF_NOTHING = "types-of-nothing"  # seen running, and named by no policy
IN_PARTS = "analysed-in-parts"  # of robots that are not shown no doubts are told
HANGS_ON_CUT = "hangs-on-cut"  # of what hangs on a statement of a large fleet only some is listed
NO_ROBOT = "no-robot"  # folders beside those that a group of robots matches, in which its policy is not (rule S11)
OWN_DOMAINS = "own-domains"  # robots of which nobody says in which domain they are (rule S1)
RECORDING = "recording"  # a bag that is a storage: its size, its time, its topics
SEEN_ALTHOUGH_DENIED = "seen-although-denied"
SIGNED_BY = "signed-by"  # the CA of a keystore, and whether a user has pinned it
WITHOUT_WARNINGS = "made-without-warnings"  # a text of what runs, without what the tool warned of (rule S16)
BY_TYPE_OPEN = "by-type-open"  # a line 'only: by-type' of a channel whose type is not certain: it closes nothing
BY_TYPE_LAPSED = "by-type-lapsed"  # types or writers are others than those with which a person took it
BY_TYPE_UNPINNED = "by-type-unpinned"  # nobody has kept with which types and writers it was taken
CODE_CHANGED = "code-changed"  # a node was reviewed at another version of its code
CODE_NOT_READ = "code-not-read"  # … and whether it was is not known
GAPS = (  # doubts that break the verdict (rule S11)
    UNREAD_FILE, OBSERVATION_GAP, SCAN_GAP, BAG_GAP, ACCESS_GAP, LEAK_JOINS_NOTHING,
)  # fmt: skip
RIDES = (  # doubts that ride on it
    NOTHING_ENFORCED, FALLBACK_TAKEN, EMPTY_GROUP, PATHS_NOT_COUNTED, EMPTY_INCLUDE, WITHOUT_WARNINGS, JOINS_NOTHING,
    NO_ROBOT, REFUSED_NAME, ODD_NAMESPACE, MISTAKEN_TILDE, CAREFUL_DENY, TYPES_OF_NOTHING, IN_PARTS,
    HANGS_ON_CUT, BY_TYPE_OPEN, BY_TYPE_LAPSED, BY_TYPE_UNPINNED, CODE_CHANGED, CODE_NOT_READ,
)  # fmt: skip
ASSUMED = (
    OBSERVED,
    SCANNED,
    ENCLAVES_MADE_UP,
    FOLDED_NAMES,
    RECORDING,
    OWN_DOMAINS,
    SIGNED_BY,
)  # notices that stand under Assumed
NO_SOURCE = "no-source"  # what 'no leak found' lacks, so that it says nothing (rules S11, S12)
GOES_NOWHERE = "goes-nowhere"
NO_LEAK_NAMED = "no-leak-named"
NOTHING_FOLLOWED = (NO_SOURCE, GOES_NOWHERE)
SCAN_SORTS = (  # of what a scan could not resolve: what could hide most first
    "name", "node-of", "system", "node", "wrapper", "remap", "started", "include", "parameter", "outside",
    "description", "file", "package",
)  # fmt: skip
_UNRESOLVED = re.compile(r"not resolved \(([a-z-]+)\)")
_WHEN = r"observed from (\S+) to (\S+) by (.+); what was not seen proves nothing"


def when_observed(first: str, last: str, doors: Iterable[str]) -> str:
    """Return the message from when to when somebody looked, and by which doors (rule S16).

    >>> when_observed("2026-11-22T10:00:00Z", "2026-11-22T10:05:00Z", ["dds", "text"])
    'observed from 2026-11-22T10:00:00Z to 2026-11-22T10:05:00Z by dds, text; what was not seen proves nothing'
    """
    return f"observed from {first} to {last} by {', '.join(doors)}; what was not seen proves nothing"


def observed_when(message: str) -> tuple[str, str, tuple[str, ...]] | None:
    """Return what ``when_observed`` was made of; None for another message.

    >>> observed_when(when_observed("a", "b", ["dds", "text"])), observed_when("something else")
    (('a', 'b', ('dds', 'text')), None)
    """
    match = re.fullmatch(_WHEN, message)
    return (match[1], match[2], tuple(match[3].split(", "))) if match else None


def unresolved(sort: str, text: str) -> str:
    """Return the message that a scan could not resolve something (rule S16).

    >>> unresolved("name", "it depends on the robot")
    'not resolved (name): it depends on the robot'
    """
    return f"not resolved ({sort}): {text}"


def unresolved_rank(message: str) -> int:
    """Return a number that is the smaller the more a gap of a scan could hide; of another message the greatest.

    >>> unresolved_rank(unresolved("name", "")), unresolved_rank("something else") == len(SCAN_SORTS)
    (0, True)
    """
    match = _UNRESOLVED.match(message)
    return SCAN_SORTS.index(match[1]) if match and match[1] in SCAN_SORTS else len(SCAN_SORTS)


class Place(NamedTuple):
    """A line of a file; line 0 where there is none."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


class Severity(StrEnum):
    """How much a diagnostic weighs. An error ends the run, so a report shows warnings and notices only."""

    ERROR = "error"
    WARNING = "warning"
    NOTICE = "notice"


class Diagnostic(NamedTuple):
    """Something that the reader of a report has to know about an input.

    Attributes
    ----------
    code
        What it is, for programs: ``UNREAD_FILE`` and others; empty where nobody has to tell it from others.
    number
        How many elements it is about.
    """

    place: Place
    severity: Severity
    message: str
    code: str = ""
    number: int = 1


def unread(diagnostics: Iterable[Diagnostic]) -> tuple[Place, ...]:
    """Return where something stands that is known to be missing: ``GAPS`` (rules S11, S16), sorted.

    >>> said = [Diagnostic(Place(file, 1), Severity.WARNING, "", UNREAD_FILE) for file in ("b.xml", "a.xml")]
    >>> list(map(str, unread([*said, Diagnostic(Place("c.xml", 1), Severity.NOTICE, "")])))
    ['a.xml:1', 'b.xml:1']
    """
    places = {said.place for said in diagnostics if said.code in GAPS}
    return tuple(sorted(places, key=lambda place: (place.file, place.line)))


class LintRule(NamedTuple):
    """A rule of policies.

    Attributes
    ----------
    name
        Its id, such as ``wildcard``.
    about
        What breaks it, in a sentence.
    why
        What comes of it.
    """

    name: str
    severity: Severity
    about: str
    why: str


class Breach(NamedTuple):
    """A rule that is broken at a line."""

    rule: LintRule
    place: Place
    message: str
