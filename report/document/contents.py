"""The ``Document``: all that an answer says, as typed facts. Every output is a function of it and reads nothing else.

It is made whole where the answer is made. What only some outputs tell is None where none of them is asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.decisions import Decided
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.findings.review_order import Behind
    from rosprivacy.analysis.findings.sanitizing import Cleaning, Making
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.kernel.overruled import Overruled
    from rosprivacy.analysis.model import (
        Diagnostic,
        Doubt,
        Element,
        Flow,
        MessageType,
        NonRosFacts,
        Processing,
        Surroundings,
    )
    from rosprivacy.analysis.model.register_row import RegisterRow
    from rosprivacy.analysis.whatif.ledger import GlobUse, TakenAway
    from rosprivacy.analysis.whatif.reliance import Reliance
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.places import PlaceIndex

    Shown = tuple[str, str, str, str]  # an element as readers see it: the two sides of a wildcard are one

LEDGER = "ledger"  # fields of ``Document`` that an output asks for
RELIANCE = "hangs_on"
PROPOSALS = "proposals"
REGISTER = "register"
PROCESSING = "processing"
POSITIONS = "positions"
PATHS = "paths_to_leaks"
IN_JSON = (LEDGER, REGISTER, PROCESSING)

T = TypeVar("T")


def required(field: T | None) -> T:
    """Return a field of a document that must have been asked for."""
    if field is None:
        raise ValueError("an output reads of the document what it did not ask for")
    return field


class Positions(NamedTuple):
    """Where findings stand in files.

    Attributes
    ----------
    places
        Of roles, profiles and channels.
    flows
        (element, element) -> the flow behind that step of a further path.
    """

    places: PlaceIndex
    flows: Mapping[tuple[Shown, Shown], Flow]


class StatedProcessing(NamedTuple):
    """What is stated of purposes, legal bases and responsible persons.

    Attributes
    ----------
    of
        Of a robot (its name) or an element.
    by_kind
        By kind of data, where data begin and end.
    """

    of: tuple[tuple[str | Element, Processing], ...]
    by_kind: tuple[Processed, ...]


class Ledger(NamedTuple):
    """What was taken away on the data's side.

    Attributes
    ----------
    taken_away
        What it was, and on whose word.
    globs
        What each glob of the label files decides and closes.
    """

    taken_away: tuple[TakenAway, ...]
    globs: tuple[GlobUse, ...]


class EnforcedFacts(NamedTuple):
    """What the enforced view adds to the declared one, which is the answer of record (rule S6).

    Attributes
    ----------
    analysis, contexts, decided, positions, paths_to_leaks
        Of the enforced view, as those of ``Document``.
    added
        The findings that only this view has, in its order; and those in which it alone has plain data.
    open
        The elements that are open in this view only, or for more categories: those outside ROS first.
    """

    analysis: Analysis
    contexts: Contexts
    decided: Decided | None
    added: tuple[Added, ...]
    open: tuple[Element, ...]
    positions: Positions | None = None
    paths_to_leaks: PathsToLeaks | None = None


@dataclass(frozen=True, slots=True)
class Document:
    """All that an answer says; of robots that are alike of one.

    Attributes
    ----------
    analysis
        Findings, open elements, what arrives where; pictures are drawn of its graph.
    vocabulary
        Kinds of data and law, in which the answer is told.
    diagnostics
        Of the inputs; the analysis' own stand there.
    assumptions
        What the answer rests on.
    doubts
        What is not known, or rests on more than a person's word (rule S11).
    policies
        The policy files that a user named, without what they include; none where that is not known.
    decided
        What people decided about the findings; None where nobody decided anything.
    accepted
        The findings that a valid decision accepts: id -> reason, owner, legal basis, until when (rule S10).
    fleet, counts
        Which robots stand for which, and how much the whole fleet has; None for a single robot.
    contexts
        Where sources work, and what data may reveal there.
    outside
        What people stated of what lies outside ROS (rule S9); of every robot, since a way can lead to another one.
    subjects
        Whom the data of a source are about: groups of persons.
    surroundings
        Where elements work.
    types
        Message types of each channel (rule S15).
    sanitizers, derivations
        Who cleans data, and who makes one kind of another.
    recognising
        Who recognises persons or judges them: element -> the kinds of data that it makes.
    brought_in
        Source -> the kinds of data that labels say it brings in.
    holds
        Element outside ROS -> the kinds of data that get there.
    absent
        Nodes that labels say are not on the robot, with the reason.
    overruled
        Sources and leaks that one label says and another takes away, with what that one says.
    infrastructure
        (kind, name) of open channels that the program's own file proposes to take as mundane (rule S13).
    review_order
        Where data comes to each open element from, and what stands behind it.
    enforced
        What the enforced view adds; None where nobody asked.
    ledger
        What was taken away on the data's side; None where nobody asked.
    hangs_on
        What the answer hangs on, statement by statement; None where nobody asked.
    proposals
        What closes the open findings, a mitigation document; or why there is none, a word; None where nobody asked.
    register
        Each kind of data at each place where it leaves or rests, with what lies on its ways; None where nobody asked.
    processing
        What is stated of purposes, legal bases and responsible persons; None where nobody asked.
    positions
        Where findings stand in files; None where nobody asked.
    paths_to_leaks
        Of pictures; None where nobody asked.
    """

    analysis: Analysis
    vocabulary: Vocabulary
    diagnostics: tuple[Diagnostic, ...]
    assumptions: Mapping[str, Any]
    doubts: tuple[Doubt, ...]
    policies: tuple[str, ...]
    decided: Decided | None
    accepted: Mapping[str, str]
    fleet: FleetView | None
    counts: Counts | None
    contexts: Contexts
    outside: Mapping[Element, NonRosFacts]
    subjects: tuple[tuple[Element, tuple[str, ...]], ...]
    surroundings: tuple[tuple[Element, Surroundings], ...]
    types: tuple[tuple[Element, tuple[MessageType, ...]], ...]
    sanitizers: tuple[Cleaning, ...]
    derivations: tuple[Making, ...]
    recognising: Mapping[Element, tuple[str, ...]]
    brought_in: Mapping[Element, frozenset[str]]
    holds: Mapping[Element, tuple[str, ...]]
    absent: tuple[tuple[Element, str], ...]
    overruled: tuple[tuple[Overruled, str], ...]
    infrastructure: frozenset[tuple[str, str]]
    review_order: Mapping[Shown, Behind]
    enforced: EnforcedFacts | None = None
    ledger: Ledger | None = None
    hangs_on: tuple[Reliance, ...] | None = None
    proposals: Mapping[str, Any] | str | None = None
    register: tuple[RegisterRow, ...] | None = None
    processing: StatedProcessing | None = None
    positions: Positions | None = None
    paths_to_leaks: PathsToLeaks | None = None
