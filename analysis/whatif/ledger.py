"""What was taken away on the data's side, on whose word, and what lies behind: the ledger of an answer, and its globs.

In: an ``Analysis`` with its labels. Out: ``TakenAway`` rows. Whatever keeps data from going on, or an element from
being asked about, stands in a row: a DENY, a label, a standard channel, a decision, a restriction, a file that was not
read, a channel that nobody known reads. Nothing that a person says can make a finding vanish without a row; a property
test holds that on random systems. Then ``GlobUse`` rows: a person who writes a glob sees one line; what it answers for
can be most of a system.

Source: rules S5, S7, S8, S11 and S13: what stops data must be stated by somebody, by name, and told.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.findings.closures import (
    ABSENT,
    DENY,
    PERHAPS,
    STANDARD_CHANNEL,
    TYPE,
    behind,
    closures,
    line_key,
)
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.kernel.roles import NOTHING_SAID
from rosprivacy.analysis.model import STANDARD, Statement
from rosprivacy.analysis.non_ros import unanswered

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Diagnostic, Element, Place

    Identity = tuple[str, str, str]

OUTDONE, REVIEW, DECISION, RESTRICTION = "outdone", "review", "decision", "restriction"
UNREAD, UNKNOWN_READER = "unread-file", "unknown-reader"
BY = (DENY, STANDARD_CHANNEL, TYPE, "mundane", "only", "never", "sanitizer", ABSENT, OUTDONE, REVIEW, DECISION,
      RESTRICTION, UNREAD, UNKNOWN_READER)  # fmt: skip

LAST = "last-path"
CLOSERS = frozenset({"mundane", "only", "never", "sanitizer", ABSENT})
WATCHED = frozenset({"mundane", "conduit", "sanitizer"})  # what one word too much turns into a wrong 'nothing found'


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
        Whether it was not worked out what lies behind: too much hangs on such lines, or data gets on to what is not
        in the graph.
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
    analysis: Analysis,
    bound: Bound,
    hierarchy: Hierarchy,
    diagnostics: Iterable[Diagnostic] = (),
    beyond: Collection[Element] = (),
) -> tuple[TakenAway, ...]:
    """Return what was taken away, in the order of ``BY`` and of the graph.

    Parameters
    ----------
    diagnostics
        Of the inputs: files that were not read are among them.
    beyond
        Of a part of a graph, the elements from which data gets to the rest: a leak or an open element may lie there.

    Notes
    -----
    Two runs of the kernel (three for a part), and one more for each line about several elements that closes a path
    only as a whole (at most ``closures.ROUNDS``); then a search from each place where data ends.

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
    asked = sum(spread.forms_of(category) for category in analysis.emitted)
    leaks = _leaks(spread, bound, hierarchy)
    unread = (diagnostic for diagnostic in dict.fromkeys(diagnostics) if diagnostic.code == UNREAD)
    rows = [
        *_closed(spread, {v: bits & asked for v, bits in leaks.items()}, _unlabelled(spread, bound, asked), beyond),
        *_outdone(spread),
        *_reviewed(spread, asked),
        *(
            TakenAway(DECISION, finding.source, None, (finding.category,), (), leak=finding.leak, note=finding.id)
            for finding in analysis.findings
            if finding.accepted
        ),
        *_restricted(spread, leaks, asked),
        *(TakenAway(UNREAD, None, None, (), (d.place,), note=d.message) for d in unread),
        *(TakenAway(UNKNOWN_READER, e.element, None, e.categories, (), note=e.missing) for e in analysis.unknown_ends),
    ]
    return tuple(sorted(rows, key=_order))


def _leaks(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> dict[int, int]:
    """Vertex -> the bits of which there would be a finding, of any kind; of what a label calls absent too."""
    leaks: dict[int, int] = defaultdict(int, spread.leaks)
    for concern in concerns(spread, bound, hierarchy):
        for vertex, category in concern.reasons:
            leaks[vertex] |= spread.forms_of(category)
    return leaks


def _unlabelled(spread: Spread, bound: Bound, open_bits: int) -> dict[int, int]:
    """Vertex -> the bits for which it is or would be open (rule S11)."""
    elements = spread.graph.elements
    unknown = unanswered(elements, bound.outside)
    return {v: open_bits & ~(0 if v in unknown else spread.covered.get(v, 0)) for v in range(len(elements))}


def _closed(
    spread: Spread, leaks: Mapping[int, int], unlabelled: Mapping[int, int], beyond: Collection[Element]
) -> Iterator[TakenAway]:
    """What labels and DENY lines close, with what lies behind."""
    closed, elements = closures(spread), spread.graph.elements
    to_leak, to_open = behind(spread, closed, leaks), behind(spread, closed, unlabelled)
    onward = behind(spread, closed, {v: spread.all_bits for v, element in enumerate(elements) if element in beyond})
    for number, closure in enumerate(closed):
        leak, question = to_leak.get(number), to_open.get(number)
        perhaps = PERHAPS in (leak, question)
        would_be_found = elements[closure.vertex].is_channel or closure.by == ABSENT  # read there, or kept (rule S10)
        if closure.to < 0 and would_be_found and leaks.get(closure.vertex, 0) & closure.bits:
            leak = closure.vertex
        perhaps = perhaps or (number in onward and None in (leak, question))
        lines = closure.lines
        yield TakenAway(
            closure.by,
            elements[closure.vertex],
            None if closure.to < 0 else elements[closure.to],
            spread.names(closure.bits),
            tuple(sorted({line.place if isinstance(line, Statement) else line for line in lines})),
            glob=bool(lines) and all(isinstance(line, Statement) and line.glob for line in lines),
            leak=None if leak in (None, PERHAPS) else elements[leak],
            open=None if question in (None, PERHAPS) else elements[question],
            itself=closure.itself,
            perhaps=perhaps,
        )


def _outdone(spread: Spread) -> Iterator[TakenAway]:
    """Sources, and leaks where data is, that a statement of higher rank took away (rule S7)."""
    elements = spread.graph.elements
    rows: dict[tuple[int, Place, Place], tuple[set[str], str, bool]] = {}
    alike = {id(decided): decided for decided in spread.facts.values()}  # the same is said of many elements
    with_outdone = {key for key, decided in alike.items() if any(fact.outdone for fact in decided.values())}
    for vertex, decided in sorted(spread.facts.items()) if with_outdone else ():
        if id(decided) not in with_outdone:
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
        element, by_whom = elements[vertex], f"of {place}" if place.line else "by its kind"
        yield TakenAway(
            OUTDONE, element, None, tuple(sorted(categories)), (by_place,), glob=glob,
            leak=element if role == "leak" else None, perhaps=role == "source", note=f"{role} {by_whom}",
        )  # fmt: skip


def _reviewed(spread: Spread, open_bits: int) -> Iterator[TakenAway]:
    """Elements that are not asked about because labels answer for them (rule S11)."""
    alike: dict[tuple[int, tuple[str, ...]], list[tuple[tuple[str, ...], tuple[Place, ...], bool]]] = {}
    for vertex, decided in sorted(spread.facts.items()):
        here = spread.names(spread.present(vertex) & open_bits)
        if (id(decided), here) not in alike:  # the same is said of many elements
            alike[id(decided), here] = list(_reviewed_by(decided, here))
        for categories, places, glob in alike[id(decided), here]:
            yield TakenAway(REVIEW, spread.graph.elements[vertex], None, categories, places, glob=glob, itself=True)


def _reviewed_by(
    decided: Mapping[str, Facts], kinds: Iterable[str]
) -> Iterator[tuple[tuple[str, ...], tuple[Place, ...], bool]]:
    """Some of the categories that are there, the lines that answer for them, and whether all of these are globs."""
    by_lines: dict[tuple[Statement, ...], list[str]] = defaultdict(list)
    makers = {line for fact in decided.values() for line in fact.reviewers if line.role == "derivation"}
    for category in kinds:
        fact = decided.get(category, NOTHING_SAID)
        reviewers = {*fact.reviewers, *(line for line in makers if line.to == category)}  # who makes it knows of it
        if reviewers and not fact.leaks and not fact.emits:
            by_lines[tuple(sorted(reviewers, key=line_key))].append(category)
    for lines, categories in by_lines.items():
        yield tuple(categories), tuple(sorted({line.place for line in lines})), all(line.glob for line in lines)


def _restricted(spread: Spread, leaks: Mapping[int, int], open_bits: int) -> Iterator[TakenAway]:
    """Kinds of data that are emitted and that the answer is not about."""
    for category in spread.categories:
        bits = spread.forms_of(category)
        if not bits & open_bits:
            reached = (v for v, leaking in sorted(leaks.items()) if leaking & bits & spread.present(v))
            leak = next((spread.graph.elements[v] for v in reached), None)
            yield TakenAway(RESTRICTION, None, None, (category,), (), leak=leak)


def _order(row: TakenAway) -> tuple[object, ...]:
    ends = [element.sort_key() if element else () for element in (row.element, row.to, row.leak)]
    return (BY.index(row.by), ends, row.places, row.categories, row.note)


class GlobUse(NamedTuple):
    """What one line of labels does that names elements, or the ends of flows, by a glob.

    Attributes
    ----------
    says
        The roles that it gives, sorted.
    elements
        How many elements it decides: it is about them, and no label of higher rank says otherwise.
    closed, reviewed
        At how many of them data ends for it; how many are not asked about for it.
    flows, flows_closed
        How many flows between two elements it decides, and along how many data ends for it.
    leak, open
        A leak, and an open element, behind what it closes; None where there is none.
    warning
        ``LAST`` if without it the answer would not be that no leak was found; else empty.
    """

    place: Place
    says: tuple[str, ...]
    elements: int
    closed: int
    reviewed: int
    leak: Element | None = None
    open: Element | None = None
    warning: str = ""
    flows: int = 0
    flows_closed: int = 0


def globs(
    analysis: Analysis, bound: Bound, ledger_rows: Iterable[TakenAway], left_out: Collection[str] = ()
) -> tuple[GlobUse, ...]:
    """Return a row for each line of a user's label files that names by a glob, in the order of the lines.

    Parameters
    ----------
    ledger_rows
        The ledger.
    left_out
        Robots that are not counted: another one stands for them.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> analysis = analyse(graph, bound, hierarchy)
    >>> uses = globs(analysis, bound, ledger(analysis, bound, hierarchy))
    >>> [(str(use.place), use.says, use.elements, use.closed, use.leak.name) for use in uses]
    [('labels.yaml:5', ('only',), 1, 1, '/archive')]
    """
    says, ends = _said_by_globs(analysis.spread, bound, left_out)
    rows: dict[Place, list[TakenAway]] = defaultdict(list)
    for row in ledger_rows if says else ():
        if row.glob and (row.by in CLOSERS or row.by == REVIEW):
            for place in row.places:
                rows[place].append(row)
    return tuple(_use(place, says[place], ends[place], rows[place], analysis.verdict) for place in sorted(says))


def _said_by_globs(
    spread: Spread, bound: Bound, left_out: Collection[str]
) -> tuple[dict[Place, set[str]], dict[Place, set[tuple[Identity, ...]]]]:
    """What each line says, and the elements and flows at which it holds; all of them where nothing is emitted."""
    elements, flows = spread.graph.elements, spread.graph.flows
    at = [((v,), said, spread.facts.get(v, {})) for v, said in bound.elements.items()]
    along = [
        ((flows[index].source, flows[index].target), said, spread.flow_facts.get(index, {}))
        for index, said in bound.flows.items()
    ]
    says: dict[Place, set[str]] = defaultdict(set)
    ends: dict[Place, set[tuple[Identity, ...]]] = defaultdict(set)
    for vertices, said, facts in (*at, *along):
        by_users = [statement for statement in said if statement.glob and statement.rank[0] > STANDARD]
        for statement in by_users if elements[vertices[0]].robot not in left_out else ():
            says[statement.place].add(statement.role)
            if not spread.categories or any(statement.line in fact.accepted for fact in facts.values()):
                ends[statement.place].add(tuple(elements[vertex].identity for vertex in vertices))
    return says, ends


def _use(
    place: Place, says: set[str], ends: set[tuple[Identity, ...]], rows: list[TakenAway], verdict: Verdict
) -> GlobUse:
    closed, reviewed = (
        {tuple(end.identity for end in (row.element, row.to) if end) for row in rows if (row.by == REVIEW) is review}
        for review in (False, True)
    )
    flows = sum(len(pair) > 1 for pair in ends)
    watched = flows or not WATCHED.isdisjoint(says)
    last = watched and verdict is Verdict.NO_LEAK_FOUND and any(row.closes or row.itself for row in rows)
    return GlobUse(
        place,
        tuple(sorted(says)),
        elements=len(ends) - flows,
        closed=sum(len(there) == 1 for there in closed),
        reviewed=len(reviewed),
        leak=next((row.leak for row in rows if row.leak), None),
        open=next((row.open for row in rows if row.open), None),
        warning=LAST if last else "",
        flows=flows,
        flows_closed=sum(len(there) > 1 for there in closed),
    )
