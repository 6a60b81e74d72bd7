"""The one list of doubts: all that is not known, or that rests on more than a person's word (rule S11).

In: what readers reported, and an ``Analysis``. Out: ``Doubt`` facts, what breaks the verdict first. The verdict's
sentence, its diagnostics, reports and what CI fails on are made of this list and of nothing else.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.model import (
    BACKUPS_NOT_STATED,
    BY_GLOBS,
    BY_TYPE_CLOSES,
    GAPS,
    INFRASTRUCTURE_CLOSES,
    NO_FLOW,
    NO_READER,
    RESTRICTED,
    RIDES,
    STANDARD_CLOSES,
    TYPE_CLOSES,
    Doubt,
    Rank,
    unresolved_rank,
)
from rosprivacy.analysis.policy_lines import first_lines, in_a_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.answer import Analysis, ByGlobs
    from rosprivacy.analysis.model import Diagnostic, Element, Place

ENDS = {"reader": NO_READER, "flow": NO_FLOW}


def doubts(
    analysis: Analysis,
    diagnostics: Iterable[Diagnostic],
    weight: Callable[[str], int] = lambda _: 1,
    *,
    restricted: bool = False,
    by_globs: Iterable[ByGlobs] = (),
) -> tuple[Doubt, ...]:
    """Return the list of doubts of an answer: by rank, name, element and file.

    Parameters
    ----------
    diagnostics
        Of what was read.
    weight
        Robot of an element -> for how many robots it stands; 0 if another one does.
    restricted
        Whether the answer is about some kinds of data only.
    by_globs
        What only globs answer for.

    Notes
    -----
    Of robots that are alike one is named, and counts for all. O(facts of the analysis).

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> analysis = analyse(replace(graph, flows=graph.flows[:5]), bound, hierarchy)  # nobody subscribes
    >>> [(doubt.name, str(doubt.rank), doubt.element.name) for doubt in doubts(analysis, ())]
    [('no-reader', 'rides', '/video')]
    """
    listed = [
        *_of_files((*diagnostics, *analysis.diagnostics)),
        *_ends(analysis),
        *_closed(analysis),
        *_shipped(analysis),
        *_by_type(analysis),
        *_backups(analysis),
        *_by_globs(by_globs, {*analysis.emitted}),
    ]
    listed += [Doubt(RESTRICTED)] if restricted else []
    lines = first_lines(analysis.graph, {doubt.element.shown_as for doubt in listed if doubt.element})
    lines |= {e.shown_as: facts.place for e, facts in analysis.outside.items() if in_a_file(facts.place)}
    distinct = {doubt.id: doubt for doubt in (_counted(doubt, lines, weight) for doubt in listed) if doubt.count}
    return tuple(sorted(distinct.values(), key=_order))


def judged(analysis: Analysis, listed: Iterable[Doubt]) -> Analysis:
    """Return an analysis with the verdict that its doubts leave: undetermined at best with one that breaks (S11).

    >>> from rosprivacy.analysis.model import UNREAD_FILE, Place
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> analysis = replace(analyse(*factory()), verdict=Verdict.NO_LEAK_FOUND)
    >>> str(judged(analysis, [Doubt(UNREAD_FILE, place=Place("a.xml", 1))]).verdict)
    'undetermined'
    """
    broken = analysis.verdict is Verdict.NO_LEAK_FOUND and any(doubt.breaks for doubt in listed)
    return replace(analysis, verdict=Verdict.UNDETERMINED) if broken else analysis


def _counted(doubt: Doubt, lines: Mapping[tuple[str, ...], Place], weight: Callable[[str], int]) -> Doubt:
    """A doubt with a line to look at, and how many elements of the fleet it stands for."""
    if doubt.element is None:
        return doubt
    place = doubt.place if doubt.place.file else lines.get(doubt.element.shown_as, doubt.place)
    return replace(doubt, place=place, count=doubt.count * weight(doubt.element.robot))


def _order(doubt: Doubt) -> tuple[object, ...]:
    about = doubt.element.sort_key() if doubt.element else ()
    worst = unresolved_rank(doubt.message)  # of a scan's gaps
    return doubt.rank, doubt.name, about, worst, doubt.place.file, doubt.place.line, doubt.message


def _of_files(diagnostics: Iterable[Diagnostic]) -> Iterator[Doubt]:
    """What readers reported with a code that is a doubt."""
    for diagnostic in diagnostics:
        if diagnostic.code in GAPS or diagnostic.code in RIDES:
            yield Doubt(diagnostic.code, None, diagnostic.place, (), diagnostic.number, diagnostic.message)


def _ends(analysis: Analysis) -> Iterator[Doubt]:
    """Where data's path ends without anybody known."""
    for end in analysis.unknown_ends:
        yield Doubt(ENDS[end.missing], end.element, categories=end.categories)


def _closed(analysis: Analysis) -> Iterator[Doubt]:
    """Leaks that only the type of a channel closes a path to (rule S15)."""
    kinds: dict[Element, set[str]] = {}
    for finding in analysis.closed.findings if analysis.closed else ():
        kinds.setdefault(finding.leak, set()).add(finding.category)
    for leak, some in kinds.items():
        yield Doubt(TYPE_CLOSES, leak, categories=tuple(sorted(some)))


def _shipped(analysis: Analysis) -> Iterator[Doubt]:
    """Channels at which a shipped file alone closes a path to a leak; a standard channel in its place is no doubt."""
    for row in analysis.closed_by_shipped:
        if row.rank is not None:
            yield Doubt(
                STANDARD_CLOSES if row.rank is Rank.BREAKS else INFRASTRUCTURE_CLOSES,
                row.channel,
                categories=row.categories,
            )


def _by_type(analysis: Analysis) -> Iterator[Doubt]:
    """Channels at which only a line ``only: by-type`` closes a way on."""
    for row in analysis.closed_by_lines:
        yield Doubt(BY_TYPE_CLOSES, row.channel, row.place, row.categories)


def _backups(analysis: Analysis) -> Iterator[Doubt]:
    """Storages that data gets to, of whose backups nothing is stated: they are taken to have none (rule S9)."""
    holding = {carried.element.identity: carried.categories for carried in analysis.carried}
    for element, facts in analysis.outside.items():
        if element.kind == "storage" and facts.backups is None and element.identity in holding:
            yield Doubt(BACKUPS_NOT_STATED, element, categories=holding[element.identity])


def _by_globs(rows: Iterable[ByGlobs], questioned: AbstractSet[str]) -> Iterator[Doubt]:
    """Elements that only globs answer for; of a flow its start."""
    seen: dict[Element, tuple[set[str], list[Place]]] = {}
    for row in rows:
        kinds, places = seen.setdefault(row.element, (set(), []))
        kinds.update(questioned & {*row.categories})
        places += row.places
    for element, (kinds, places) in seen.items():
        if kinds:
            yield Doubt(BY_GLOBS, element, places[0], tuple(sorted(kinds)))
