"""Policies, label files and observed types -> proposals of labels, in the order in which a person reviews them.

In: names of files. Out: ``Suggested``. What no person has said yet is asked, the surest first.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE, TYPE
from rosprivacy.analysis.suggesting.outdated_reasons import outdated_reasons
from rosprivacy.analysis.suggesting.reached_kinds import reached_kinds
from rosprivacy.analysis.suggesting.unsaid import unsaid
from rosprivacy.analysis.suggesting.weighing import SURENESS, closes_finding, proposals
from rosprivacy.ingest.packages.package_folders import replacements
from rosprivacy.labelling.basis import NO_CODE, Basis
from rosprivacy.labelling.gathering import evidence
from rosprivacy.labelling.knowledge import NO_FILES, what_is_known
from rosprivacy.labelling.refused import refused_in
from rosprivacy.labelling.suggested_labels import Suggested
from rosprivacy.ontology.vocabulary import TOP
from rosprivacy.reading.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.findings.review_order import Shown
    from rosprivacy.analysis.model import Bound, Category, MessageType, Weight
    from rosprivacy.analysis.suggesting.evidence import Evidence, Proposal
    from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    from rosprivacy.ingest.code.node_uses import Local
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.interview import Interview
    from rosprivacy.labelling.knowledge import Known, UserFiles
    from rosprivacy.labelling.refused import Refused
    from rosprivacy.labelling.suggested_labels import Identity
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

NOTHING_BEHIND = Behind()  # of what is open by a type only
NOT_OPEN = 2**31  # behind every open element


def suggest_labels(
    policies: tuple[str, ...],
    labels: tuple[str | Labels, ...],
    settings: Settings,
    files: UserFiles = NO_FILES,
    interview: Interview | None = None,
) -> Suggested:
    """Read a robot's system and say what its elements could be labelled as.

    Parameters
    ----------
    interview
        Of a language model, which is asked too.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    ModelError
        If the language model cannot be asked.
    """
    return suggested(answer_robot(policies, labels, settings), settings, files, interview)


def suggested(
    result: Result, settings: Settings, files: UserFiles = NO_FILES, interview: Interview | None = None
) -> Suggested:
    """Return what could be said of the elements of an answer, of a fleet's or a database's too.

    Of robots that are alike one is asked about. Parameters as of ``suggest_labels``.

    Raises
    ------
    InputErrors
        With every problem of the rules and packages.
    ModelError
        If the language model cannot be asked.
    """
    return suggested_by(what_is_known(result.vocabulary, settings, files), result, files.sources, interview)


def suggested_by(
    known: Known, result: Result, sources: Sequence[str] = (), interview: Interview | None = None
) -> Suggested:
    """Return what could be said of the elements of an answer, by what is known; parameters as of ``suggest_labels``.

    Raises
    ------
    ModelError
        If the language model cannot be asked.
    """
    found = with_findings(result)
    basis = basis_of(result, sources)
    places = basis.places
    said = evidence(result.analysis, basis.bound, known, basis.code.uses)
    listed = _not_by_code_alone(said, result)
    asked = asked_by(chain(listed, interview.evidence(basis) if interview else ()), result, found, refused_in(result))
    by_hand = frozenset(one.label for one in asked if closes_finding(one.label, found))
    return Suggested(
        in_review_order(asked, places, result.vocabulary.categories),
        frozenset(places),
        by_hand,
        result,
        (*known.files, *(interview.rests_on if interview else ())),
        interview.entry() if interview else None,
        tuple(use for use in basis.code.unplaced if known.libraries.speaks(use)),
        basis.code.problems,
        basis.code.of_others,
        (
            *replacements(known.packages),
            *_named_alike(basis.code.local, known.libraries),
            *outdated_reasons(result.analysis.graph, result.bound),
        ),
    )


def asked_by(
    said: Iterable[Evidence], result: Result, found: Collection[str], refused: Refused
) -> tuple[Proposal, ...]:
    """Return what a person is asked of what evidence says; of each element it depends on its own evidence alone.

    Parameters
    ----------
    found
        As ``with_findings`` returns.
    refused
        What a person has said no to.
    """
    made = proposals(said, found)
    if any(refused.of_robots.values()):
        reached = reached_kinds(result.analysis)
        made = tuple(one for one in made if not refused.silences(one.label, reached))
    return unsaid(_once(made, result), result.analysis.graph, result.bound, result.vocabulary.hierarchy)


def basis_of(result: Result, sources: Sequence[str] = ()) -> Basis:
    """Return what there is to suggest about: an answer, with what source code says of its channels."""
    places = review_places(result, result.review_order)
    if not sources:
        return Basis(result, result.bound, places, {}, NO_CODE)
    from rosprivacy.ingest.code.code_names import code_comments  # noqa: PLC0415 - light start
    from rosprivacy.ingest.code.source_files import read_sources  # noqa: PLC0415
    from rosprivacy.labelling.code_said import code_said  # noqa: PLC0415

    codes, of_others, _ = read_sources(sources)
    code = code_said(codes, of_others, result.analysis.graph.elements)
    return Basis(result, _with_types(result.bound, code.types), places, code_comments(codes), code)


def in_review_order(
    asked: Sequence[Proposal], places: Mapping[Identity, int], categories: Mapping[str, Category]
) -> tuple[Proposal, ...]:
    """Return proposals in the order in which a person reviews them (rule S11).

    Open elements come first; then what brings data in or lets it out. The surest come first, and of these the kinds of
    data that weigh most.
    """

    def place(one: Proposal) -> tuple[int, bool, int, Weight]:
        label = one.label
        at = places.get(label.element.identity, NOT_OPEN)
        weight = categories[label.to or label.kind or TOP].weight
        return at, label.role not in (SOURCE, LEAK), SURENESS[one.confidence], weight

    return tuple(sorted(asked, key=place))  # stable: by element, role and kind within


def _named_alike(local: Iterable[Local], libraries: LibraryRules) -> Iterator[Diagnostic]:
    """A notice for each file that uses what is called as a library of a rule, and stands in the sources itself."""
    spoken = sorted((one for one in local if libraries.speaks(one.use)), key=lambda one: (one.use.place, one.use.name))
    first = {(one.use.place.file, one.of): one for one in reversed(spoken)}
    for one in sorted(first.values(), key=lambda one: one.use.place):
        what = f"{one.use.name} is taken for {one.of} of these sources, so no library of that name suggests anything"
        yield Diagnostic(one.use.place, Severity.NOTICE, f"{what}; label the node by hand if the library is meant")


def _with_types(bound: Bound, said: Mapping[int, tuple[MessageType, ...]]) -> Bound:
    """What is bound to the graph, with the types that source code names for its channels: for suggestions only."""
    return replace(bound, types={at: (*bound.types.get(at, ()), *said.get(at, ())) for at in {*bound.types, *said}})


def _not_by_code_alone(said: Iterable[Evidence], result: Result) -> Iterator[Evidence]:
    """Put no channel into a list by types that only code names: it may be a test, and others may write another type."""
    typed = {result.analysis.graph.elements[vertex].identity for vertex in result.bound.types}
    for one in said:
        by_code = one.ground == TYPE and one.family and one.label.element.identity not in typed
        yield one._replace(family="") if by_code else one


def _once(made: tuple[Proposal, ...], result: Result) -> Iterable[Proposal]:
    """Proposals without those for the second of robots that are alike: the first stands for all (rule S10)."""
    if result.fleet is None:
        return made
    second = result.fleet.likeness.second
    return (one for one in made if one.label.element.robot not in second)


def with_findings(result: Result) -> frozenset[str]:
    """Return the categories of findings, with all that data of them may be of."""
    hierarchy = result.vocabulary.hierarchy
    return frozenset(kind for one in result.analysis.findings for kind in hierarchy.overlaps[one.category])


def review_places(result: Result, behind: Mapping[Shown, Behind]) -> dict[Identity, int]:
    """Return the place of each open element in the order of review: that of ``review_groups``, what can wait last.

    Parameters
    ----------
    behind
        As ``review_order`` returns.
    """
    categories = result.vocabulary.categories

    def place(question: OpenQuestion) -> tuple[int, bool, int, int, int, Weight]:
        said = behind.get(question.element.shown_as, NOTHING_BEHIND)
        group = 1 if question.element.is_channel else 0 if question.frontier else 2
        heaviest = min(categories[kind].weight for kind in question.categories)
        return group, said.waits, -said.leaks, -said.closes, question.distance, heaviest

    identities = dict.fromkeys(question.element.identity for question in sorted(result.analysis.open, key=place))
    return {identity: number for number, identity in enumerate(identities)}
