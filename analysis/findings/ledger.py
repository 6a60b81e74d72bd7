"""What was taken away on the data's side, and on whose word: the ledger of an answer.

In: an ``Analysis`` with its labels. Out: ``TakenAway`` rows. Whatever keeps data from going on, or an element from
being asked about, stands in a row: a DENY, a label, a standard channel, a decision, a restriction, a file that was not
read, a channel that nobody known reads. A row says which leak or open element lies behind it. Nothing that a person
says can make a finding vanish without a row; a property test holds that on random systems.

Source: rules S5, S7, S8, S11 and S13: what stops data must be stated by somebody, by name, and told.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.closures import ABSENT, PERHAPS, TYPE, Closure, behind, closures, line_key
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.kernel.roles import NOTHING_SAID
from rosprivacy.analysis.model import Place, Statement
from rosprivacy.analysis.non_ros import unanswered

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Diagnostic, Element

OUTDONE, REVIEW, DECISION, RESTRICTION = "outdone", "review", "decision", "restriction"
UNREAD, UNKNOWN_READER = "unread-file", "unknown-reader"
BY = ("deny", "standard-channel", TYPE, "mundane", "only", "never", "sanitizer", ABSENT, OUTDONE, REVIEW, DECISION,
      RESTRICTION, UNREAD, UNKNOWN_READER)  # fmt: skip


class TakenAway(NamedTuple):
    """One place where data, or a question, ends on somebody's word.

    Attributes
    ----------
    by
        One of ``BY``.
    element
        Where; the start of a flow. None of a file that was not read and of a restriction.
    to
        The end of a flow, for what is about one.
    categories
        What is there and does not go on (or is not asked about), sorted.
    places
        The lines that say so, sorted; two lines of which each alone would do are both here.
    glob
        Whether only globs say so, and no name.
    leak, open
        The nearest leak, and the nearest open element, that data would get to if it were not so; None if none.
    itself
        Whether the element would be open itself.
    perhaps
        Whether it was not worked out what lies behind: too much hangs on such lines.
    note
        In words, where there is more to say: of a file that was not read, why.
    """

    by: str
    element: Element | None
    to: Element | None
    categories: tuple[str, ...]
    places: tuple[Place, ...]
    glob: bool = False
    leak: Element | None = None
    open: Element | None = None
    itself: bool = False
    perhaps: bool = False
    note: str = ""

    @property
    def closes(self) -> bool:
        """Whether a leak or another open element lies behind it, or may."""
        return self.leak is not None or self.open is not None or self.perhaps or self.by == UNREAD


def ledger(
    analysis: Analysis, bound: Bound, hierarchy: Hierarchy, diagnostics: Iterable[Diagnostic] = ()
) -> tuple[TakenAway, ...]:
    """Return what was taken away, in the order of ``BY`` and of the graph.

    Parameters
    ----------
    diagnostics
        Of the inputs: files that were not read are among them.

    Notes
    -----
    Two runs of the kernel, and one more for each line about several elements that closes a path only as a whole (at
    most ``closures.ROUNDS``); then a search from each place where data ends.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> rows = ledger(analyse(graph, bound, hierarchy), bound, hierarchy)
    >>> [(row.by, *map(str, row.places)) for row in rows if row.leak]
    [('deny', 'policy.xml:10'), ('only', 'labels.yaml:5'), ('sanitizer', 'labels.yaml:4')]
    """
    spread = analysis.spread
    asked = sum(spread.both(category) for category in analysis.emitted)
    leaks = _leaks(spread, bound, hierarchy)
    rows = [
        *_closed(spread, {v: bits & asked for v, bits in leaks.items()}, _unlabelled(spread, bound, asked)),
        *_outdone(spread),
        *_reviewed(spread, asked),
        *_decided(analysis),
        *_restricted(spread, leaks, asked),
        *_unread(diagnostics),
        *_unknown(analysis),
    ]
    return tuple(sorted(rows, key=_order))


def _leaks(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> dict[int, int]:
    """Vertex -> the bits of which there would be a finding, of any kind."""
    leaks: dict[int, int] = defaultdict(int)
    for concern in concerns(spread, bound, hierarchy):
        for vertex, bits in concern.bits.items():
            leaks[vertex] |= bits
    return leaks


def _unlabelled(spread: Spread, bound: Bound, asked: int) -> dict[int, int]:
    """Vertex -> the bits for which it is or would be open (rule S11)."""
    elements = spread.graph.elements
    unknown = unanswered(elements, bound.outside)
    covered = {v: bits for v, bits in spread.covered.items() if v not in unknown}
    return {v: asked & ~covered.get(v, 0) for v in range(len(elements))}


def _closed(spread: Spread, leaks: Mapping[int, int], unlabelled: Mapping[int, int]) -> Iterator[TakenAway]:
    """What labels and DENY lines close, with what lies behind."""
    closed = closures(spread)
    to_leak, to_open = behind(spread, closed, leaks), behind(spread, closed, unlabelled)
    elements = spread.graph.elements
    for number, closure in enumerate(closed):
        ends = {to_leak.get(number), to_open.get(number)}
        leak, question = (ends_at.get(number) for ends_at in (to_leak, to_open))
        if closure.to < 0 and elements[closure.vertex].is_channel and leaks.get(closure.vertex, 0) & closure.bits:
            leak = closure.vertex  # others could read it there (rule S10)
        yield TakenAway(
            closure.by,
            elements[closure.vertex],
            None if closure.to < 0 else elements[closure.to],
            spread.names(closure.bits),
            _places(closure),
            glob=bool(closure.lines) and all(isinstance(line, Statement) and line.glob for line in closure.lines),
            leak=elements[leak] if leak is not None and leak != PERHAPS else None,
            open=elements[question] if question is not None and question != PERHAPS else None,
            itself=closure.itself,
            perhaps=PERHAPS in ends,
        )


def _places(closure: Closure) -> tuple[Place, ...]:
    places = {line.place if isinstance(line, Statement) else line for line in closure.lines}
    return tuple(sorted(places, key=_line))


def _line(place: Place) -> tuple[str, int]:
    return (place.file, place.line)


def _outdone(spread: Spread) -> Iterator[TakenAway]:
    """Sources, and leaks where data is, that a statement of higher rank took away (rule S7)."""
    elements = spread.graph.elements
    rows: dict[tuple[int, Place, Place], tuple[set[str], str, bool]] = {}
    alike = {id(decided): decided for decided in spread.facts.values()}  # the same is said of many elements
    some = {one for one, decided in alike.items() if any(fact.outdone for fact in decided.values())}
    for vertex, decided in sorted(spread.facts.items()) if some else ():
        if id(decided) not in some:
            continue
        here = spread.names(spread.present(vertex))
        for category, fact in sorted(decided.items()):
            for statement, by in fact.outdone:
                if fact.leaks if statement.role == "leak" else fact.emits and not fact.through:
                    continue  # another label says the same, and holds
                if statement.role == "source" or category in here:
                    key = (vertex, statement.place, by.place)
                    rows.setdefault(key, (set(), statement.role, by.glob))[0].add(category)
    for (vertex, place, by_place), (categories, role, glob) in rows.items():
        element, said = elements[vertex], f"of {place}" if place.line else "by its kind"
        yield TakenAway(
            OUTDONE, element, None, tuple(sorted(categories)), (by_place,), glob=glob,
            leak=element if role == "leak" else None, perhaps=role == "source", note=f"{role} {said}",
        )  # fmt: skip


def _reviewed(spread: Spread, asked: int) -> Iterator[TakenAway]:
    """Elements that are not asked about because labels answer for them (rule S11)."""
    alike: dict[tuple[int, tuple[str, ...]], list[tuple[tuple[str, ...], tuple[Place, ...], bool]]] = {}
    for vertex, decided in sorted(spread.facts.items()):
        here = spread.names(spread.present(vertex) & asked)
        if (id(decided), here) not in alike:  # the same is said of many elements
            alike[id(decided), here] = list(_reviewed_by(decided, here))
        for categories, places, glob in alike[id(decided), here]:
            yield TakenAway(REVIEW, spread.graph.elements[vertex], None, categories, places, glob=glob, itself=True)


def _reviewed_by(
    decided: Mapping[str, Facts], here: Iterable[str]
) -> Iterator[tuple[tuple[str, ...], tuple[Place, ...], bool]]:
    """Some of the categories that are there, the lines that answer for them, and whether all of these are globs."""
    by_lines: dict[tuple[Statement, ...], list[str]] = defaultdict(list)
    makers = {line for fact in decided.values() for line in fact.reviewers if line.role == "derivation"}
    for category in here:
        fact = decided.get(category, NOTHING_SAID)
        reviewers = {*fact.reviewers, *(line for line in makers if line.to == category)}  # who makes it knows of it
        if reviewers and not fact.leaks and not fact.emits:
            by_lines[tuple(sorted(reviewers, key=line_key))].append(category)
    for lines, categories in by_lines.items():
        places = tuple(sorted({line.place for line in lines}, key=_line))
        yield tuple(categories), places, all(line.glob for line in lines)


def _decided(analysis: Analysis) -> Iterator[TakenAway]:
    for finding in analysis.findings:
        if finding.accepted:
            yield TakenAway(DECISION, finding.source, None, (finding.category,), (), leak=finding.leak, note=finding.id)


def _restricted(spread: Spread, leaks: Mapping[int, int], asked: int) -> Iterator[TakenAway]:
    """Kinds of data that are emitted and that the answer is not about."""
    for category in spread.categories:
        bits = spread.both(category)
        if bits & asked:
            continue
        reached = [v for v, leaking in sorted(leaks.items()) if leaking & bits & spread.present(v)]
        leak = spread.graph.elements[reached[0]] if reached else None
        yield TakenAway(RESTRICTION, None, None, (category,), (), leak=leak)


def _unread(diagnostics: Iterable[Diagnostic]) -> Iterator[TakenAway]:
    for diagnostic in dict.fromkeys(diagnostics):
        if getattr(diagnostic, "code", "") == UNREAD:
            yield TakenAway(UNREAD, None, None, (), (diagnostic.place,), note=diagnostic.message)


def _unknown(analysis: Analysis) -> Iterator[TakenAway]:
    for end in analysis.unknown_ends:
        yield TakenAway(UNKNOWN_READER, end.element, None, end.categories, (), note=end.what)


def _order(row: TakenAway) -> tuple[object, ...]:
    ends = [element.sort_key() if element else () for element in (row.element, row.to, row.leak)]
    return (BY.index(row.by), ends, [_line(place) for place in row.places], row.categories, row.note)
