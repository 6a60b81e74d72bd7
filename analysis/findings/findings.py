"""Graph + labels -> ``Analysis``: findings, witnesses, open questions, verdict (rules S10 to S12, S14).

In: a flow graph, bound statements, the hierarchy. Out: one frozen ``Analysis``.

Source: the paper, section II-B, for paths from source to leak and for the dismissal of those through another leak;
what it counts on one undirected graph for one kind of data stands here per category on directed flows.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Analysis, CarriedData, Finding, Verdict
from rosprivacy.analysis.bounds import BOUNDS, Tally
from rosprivacy.analysis.case import Case
from rosprivacy.analysis.findings.closures import closed_by_lines, closed_by_shipped
from rosprivacy.analysis.findings.concerns import concerns, shown_arrivals
from rosprivacy.analysis.findings.near_robots import Units
from rosprivacy.analysis.findings.open_questions import grounds, lacking, open_questions, unknown_ends
from rosprivacy.analysis.findings.paths_of_source import PathsOfSource
from rosprivacy.analysis.findings.witness import witness_of
from rosprivacy.analysis.kernel import spreading, standard_channels
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.overruled import untouched
from rosprivacy.analysis.kernel.search import ROOM, START, Search, path_to, present, searches
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.model import DISCLOSURE, PATHS_NOT_COUNTED, Diagnostic, Element, Place, Severity
from rosprivacy.analysis.modes import Paths
from rosprivacy.analysis.non_ros import on_day, unanswered

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
    from collections.abc import Set as AbstractSet
    from typing import Any

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, FlowGraph

    _Nets = Callable[[int, AbstractSet["Chosen"]], Iterator[tuple[Net, AbstractSet["Chosen"]]]]
    Followed = tuple[Search, Mapping[int, int]]  # a search, with what it did not follow: vertex -> bits

MAX_PATHS = 100
NOWHERE = Place("the analysis", 0)
Chosen = tuple[str, int, int, bool]  # kind, leak, number of the category, whether beside a pseudonymised one


class Options(NamedTuple):
    """What is asked for.

    Attributes
    ----------
    categories
        Emitted categories that the answer is about; None for all.
    paths
        ``witness``: no further paths; ``disjoint``: paths that share no flow; ``all``: simple paths.
    max_paths
        Bound on further paths per finding.
    count_paths
        Whether paths that share no flow are counted: most of the work in a large system. If not, no further ones are
        listed either, and all else is the same.
    uncounted
        Of which pairs of source and leak they are not, where those of others are.
    accepts
        Whether a person has accepted that a category of a source reaches a leak, in one form; such a leak hides
        nothing that lies behind it (rule S10).
    today
        The day on which adequacy decisions hold or have ended, ``YYYY-MM-DD``; empty where none is taken to have.
    choose
        Of a spread, the kinds of findings and the bits of the categories: source -> ``Chosen`` of the findings to
        make; None for all.
    shared
        Names under which a fleet files what no robot has. With them, and with ``choose``, each search looks at the
        robot of its source, at what is shared and at the robots between (``near_robots.py``): ways are as short, and
        paths that share no flow are counted there only.
    bounds
        Above ``path_steps`` paths are not counted, which a warning says.
    """

    categories: Collection[str] | None = None
    paths: str = Paths.witness
    max_paths: int = MAX_PATHS
    count_paths: bool = True
    uncounted: Callable[[Element, Element], bool] | None = None
    accepts: Callable[[Case], bool] | None = None
    choose: Callable[[Spread, Sequence[Concern], int], Mapping[int, AbstractSet[Chosen]]] | None = None
    shared: AbstractSet[str] | None = None
    today: str = ""
    bounds: Bounds = BOUNDS


def analyse(
    graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, options: Options | None = None, before: Spread | None = None
) -> Analysis:
    """Answer, for every category in one pass, whether it can get from a source to a leak.

    Parameters
    ----------
    before
        That of an earlier answer about the same graph, of which all is taken over that is still so.

    Raises
    ------
    InputErrors
        If labels contradict each other; above a bound.

    Notes
    -----
    The fixpoint says which leaks are reached; only where one is, searches say from which source and along which path:
    one or two per source, O(flows) each for a fixed number of categories, and augmenting paths on the part of the graph
    between the two.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> analysis = analyse(*factory())
    >>> str(analysis.verdict), [element.name for element in analysis.findings[0].witness]
    ('leak', ['/camera', '/video', '/face_id', '/faces', '/archive'])
    """
    options = options or Options()
    bound = replace(bound, outside=on_day(bound.outside, options.today))
    spread = spreading.spread(graph, bound, hierarchy, before)
    mask, net, work = _mask(spread, options), Net.cached(spread), _Tallies(options.bounds)
    findings = _kept_findings(net, mask, tuple(concerns(spread, bound, hierarchy)), options, work)
    questions = open_questions(net, mask, unanswered(graph.elements, bound.outside))
    lacks = grounds(spread, mask).lacking
    leak = any(finding.stands for finding in findings)
    return Analysis(
        graph=graph,
        verdict=Verdict.of(leak=leak, is_open=bool(questions), grounded=not lacks),
        emitted=_categories(spread, options),
        findings=findings,
        open=questions,
        carried=_kept_carried(spread, mask, hierarchy),
        roles=_roles(spread, mask),
        standard_channels=_standard_channels(spread),
        standard_reached=standard_channels.reached(spread, mask),
        closed_by_shipped=closed_by_shipped(spread, mask),
        closed_by_lines=closed_by_lines(spread, mask),
        standard_unchanged=standard_channels.unchanged(spread, bound),
        spread=spread,
        unstated=tuple(_unstated(spread)),
        diagnostics=(*_remarks(spread, work), *(() if leak or questions else _lacking(lacks, options, spread))),
        outside={graph.elements[vertex]: facts for vertex, facts in sorted(bound.outside.items())},
        unknown_ends=unknown_ends(spread, mask),
        lacking=lacks,
        types={graph.elements[v]: tuple(sorted({one.name for one in some})) for v, some in bound.types.items()},
    )


def chosen_findings(
    net: Net, bound: Bound, hierarchy: Hierarchy, options: Options, chosen: Mapping[int, AbstractSet[Chosen]]
) -> tuple[Finding, ...]:
    """Return some findings of a net, if they are there; nothing else is worked out.

    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> graph, bound, hierarchy = factory()
    >>> net = Net.of(spreading.spread(graph, bound, hierarchy))
    >>> chosen = {CAMERA: {(DISCLOSURE, ARCHIVE, net.spread.categories.index("FaceTemplate"), False)}}
    >>> [finding.leak.name for finding in chosen_findings(net, bound, hierarchy, Options(), chosen)]
    ['/archive']
    """
    spread = net.spread
    bound = replace(bound, outside=on_day(bound.outside, options.today))
    options = options._replace(choose=lambda *_: chosen)
    leaks = {leak for some in chosen.values() for _, leak, _, _ in some}
    kinds = tuple(
        concern._replace(bits={leak: concern.bits[leak] for leak in leaks & concern.bits.keys()})
        for concern in concerns(spread, bound, hierarchy)
    )
    return tuple(_findings(net, _mask(spread, options), kinds, options, _Tallies(options.bounds)))


def _categories(spread: Spread, options: Options) -> tuple[str, ...]:
    """The emitted categories that the answer is about."""
    return tuple(c for c in spread.categories if options.categories is None or c in options.categories)


def _mask(spread: Spread, options: Options) -> int:
    """The bits of these categories."""
    return sum(map(spread.forms_of, _categories(spread, options)))


class _Tallies:
    """What was made and searched, and of how many findings the paths were not counted."""

    def __init__(self, bounds: Bounds) -> None:
        self.findings = Tally(bounds, "findings")
        self.searches = Tally(bounds, "search_steps")
        self.paths = Tally(bounds, "path_steps")
        self.left_out = 0

    def not_counted(self) -> Iterator[Diagnostic]:
        """What is to be said of findings whose paths were not counted (rule S11)."""
        if self.left_out:
            more, hint = self.paths.bounds.refusal(self.paths.name)
            what = f"how many paths share no flow is not counted for {self.left_out:,} findings, which say 1: {more}"
            yield Diagnostic(NOWHERE, Severity.WARNING, f"{what}; {hint}", PATHS_NOT_COUNTED)


def _kept_findings(
    net: Net, mask: int, kinds: Sequence[Concern], options: Options, work: _Tallies
) -> tuple[Finding, ...]:
    """All findings; those of before, where data goes the same ways, ends at the same places and the same is asked."""

    def find() -> tuple[Finding, ...]:
        return tuple(_findings(net, mask, kinds, options, work))

    if options.count_paths or options.choose:
        return find()
    spread = net.spread
    ends = [(one.kind, {v: bits for v, bits in one.bits.items() if bits}, one.reasons) for one in kinds]
    return spread.course.memoised("findings", (mask, options, spread.absent_bits, ends), find)


def _findings(net: Net, mask: int, kinds: Sequence[Concern], options: Options, work: _Tallies) -> Iterator[Finding]:
    """All findings, sorted by category, source, leak and kind."""
    spread = net.spread
    ends = [(c, {v: b & mask for v, b in sorted(c.bits.items()) if b & mask & spread.present(v)}) for c in kinds]
    reached = [(concern, leaks) for concern, leaks in ends if leaks]
    results: list[tuple[int, int, int, str, bool, Finding]] = []
    stops = _Stops(spread)
    chosen = options.choose(spread, kinds, mask) if options.choose and reached else None
    sources = [v for v in spread.facts if spread.begins(v)] if chosen is None else chosen
    nets = _nets(net, options, stops) if chosen is not None and reached else None
    for source in sorted(sources) if reached else ():
        only = None if chosen is None else chosen[source]
        for near, some in [(net, only)] if nets is None or only is None else nets(source, only):
            for category, leak, finding in _findings_from(near, source, reached, options, some, work, stops):
                results.append((category, source, leak, finding.kind, finding.plain_also, finding))
    yield from (finding for *_, finding in sorted(results, key=lambda row: row[:5]))


def _nets(net: Net, options: Options, stops: _Stops) -> _Nets | None:
    """What gives of a source the nets to search for its findings, each with those; None where that is the whole net.

    Those to other robots, whose paths are not counted, have a net of their own: they do not make it larger for others.
    """
    if options.shared is None or options.accepts is not None:
        return None
    spread, elements = net.spread, net.spread.graph.elements
    numbers = {i if i in spread.made_categories else -1: i for i, _ in enumerate(spread.categories)}
    free = [_allowed_and_ends(spread, i) for i in numbers.values()]
    units = Units(
        net, options.shared, [(spread.all_bits, {}), *((allowed, stops.of(ends, {})) for allowed, ends in free)]
    )

    def nets(source: int, chosen: AbstractSet[Chosen]) -> Iterator[tuple[Net, AbstractSet[Chosen]]]:
        uncounted = options.uncounted or (lambda *_: False)
        away = {one for one in chosen if uncounted(elements[source], elements[one[1]])}
        for some in (chosen - away, away):
            if some:
                yield units.near(source, {leak for _, leak, _, _ in some}), some

    return nets


def _findings_from(
    net: Net, source: int, reached: Sequence[tuple[Concern, Mapping[int, int]]], options: Options,
    chosen: AbstractSet[Chosen] | None, work: _Tallies, stops: _Stops,
) -> Iterator[tuple[int, int, Finding]]:  # fmt: skip
    """(number of the category, leak, finding) of one source."""
    spread = net.spread
    room = 0 if options.count_paths else ROOM  # only where these wait for who asks, another answer follows
    whole = searches(spread, room).of(net, source, spread.all_bits, {}, None)
    work.searches.add(len(whole.arrived_bits), NOWHERE)
    memory: dict[Any, Any] = {}
    for concern, leaks in reached:
        there = _leaks_met(whole, leaks)
        for leak, category, finding in _findings_of(
            net, source, whole, concern, there, options, memory, chosen, work, stops
        ):
            work.findings.add(1, NOWHERE)
            yield category, leak, finding


class _Stops:
    """Where data of some categories ends: at leaks that nobody has accepted (rule S10)."""

    def __init__(self, spread: Spread) -> None:
        self._leaks = spread.leaks
        self._bits_at_leaks: dict[int, dict[int, int]] = {}

    def of(self, ends: int, accepted: Mapping[int, int]) -> Mapping[int, int]:
        """Leak -> bits that are not followed on from there; one mapping for all sources where nothing is accepted."""
        if ends not in self._bits_at_leaks:
            self._bits_at_leaks[ends] = {v: bits & ends for v, bits in self._leaks.items() if bits & ends}
        every = self._bits_at_leaks[ends]
        return {**every, **{v: every[v] & ~bits for v, bits in accepted.items() if v in every}} if accepted else every


def _leaks_met(search: Search, leaks: Mapping[int, int]) -> dict[int, int]:
    """The leaks that a search comes to, with the bits that do; in their order, and not one look at each leak."""
    near = search.arrived_bits.keys() | search.begun.keys()
    some = leaks if len(leaks) <= len(near) else {v: leaks[v] for v in sorted(near & leaks.keys())}
    return {v: bits & found for v, bits in some.items() if bits & (found := present(search, v))}


def _findings_of(
    net: Net, source: int, search: Search, concern: Concern, reached: Mapping[int, int], options: Options,
    memory: dict[Any, Any], limited_to: AbstractSet[Chosen] | None, work: _Tallies, stops: _Stops,
) -> Iterator[tuple[int, int, Finding]]:  # fmt: skip
    """(leak, number of the category, finding) of one source and kind.

    Only disclosures are dismissed: no leak on the path cures a retention, a transfer or an open channel (rule S10).
    """
    spread = net.spread
    paths = PathsOfSource(net, source, memory, options.paths, options.max_paths, work.paths)
    accepted = _accepted(spread, source, concern.kind, reached, options)
    anywhere: Followed = search, {}
    free: dict[int, Followed] = {}  # number of the category -> search that stops at other leaks of it
    for leak, bits in reached.items():
        for i in bits_of(spread.bits.merged(bits)):
            if (
                limited_to is not None
                and not {(concern.kind, leak, i, False), (concern.kind, leak, i, True)} & limited_to
            ):
                continue
            if concern.kind != DISCLOSURE:
                free[i] = anywhere
            elif i not in free:
                _search_free(net, source, i, accepted, free, stops)
                work.searches.add(len(free[i][0].arrived_bits), NOWHERE)
            for beside, ((chosen, stop), bit) in enumerate(_shown_forms(free[i], anywhere, leak, spread.bits.forms(i))):
                if limited_to is not None and (concern.kind, leak, i, bool(beside)) not in limited_to:
                    continue
                dismissed = chosen is search and concern.kind == DISCLOSURE
                finding = _finding(net, chosen, source, leak, bit, concern, accepted, dismissed=dismissed)
                finding = _as_plain_also(finding, options) if beside else finding
                if not options.count_paths or (options.uncounted and options.uncounted(finding.source, finding.leak)):
                    finding = replace(finding, number_of_paths=None)
                elif len(finding.witness) > 1 and work.paths.met:
                    work.left_out += 1
                    finding = replace(finding, bounded=options.paths != Paths.witness)
                elif len(finding.witness) > 1:
                    more = paths.to(leak, i, chosen, stop)
                    finding = replace(finding, number_of_paths=more.disjoint, paths=more.paths, bounded=more.bounded)
                yield leak, i, finding


def _accepted(spread: Spread, source: int, kind: str, reached: Mapping[int, int], options: Options) -> dict[int, int]:
    """Leak -> the bits that a person has accepted there, of those that come from a source."""
    if options.accepts is None:
        return {}
    from_, elements = spread.graph.elements[source], spread.graph.elements
    accepted: dict[int, int] = defaultdict(int)
    for leak, bits in reached.items():
        for name in spread.names(bits):
            i, to = spread.categories.index(name), elements[leak]
            for bit in spread.bits.forms(i):
                form = spread.bits.is_pseudonymised(bit)
                if options.accepts(Case(finding_id(name, from_, to, kind), kind, name, from_, to, form)):
                    accepted[leak] |= 1 << bit
    return accepted


def _search_free(
    net: Net, source: int, i: int, accepted: Mapping[int, int], free: dict[int, Followed], stops: _Stops
) -> None:
    """Search with the leaks of category i as ends; one search serves all categories that nothing is made into."""
    spread = net.spread
    allowed, ends = _allowed_and_ends(spread, i)
    stop = stops.of(ends, accepted)
    result = searches(spread).of(net, source, allowed, stop, (ends, frozenset(accepted.items())))
    free.update(dict.fromkeys(_searched_with(spread, i), (result, stop)))


def _searched_with(spread: Spread, i: int) -> list[int]:
    """The categories that one search serves, of which one is i."""
    if i in spread.made_categories:
        return [i]
    return [j for j, _ in enumerate(spread.categories) if j not in spread.made_categories]


def _allowed_and_ends(spread: Spread, i: int) -> tuple[int, int]:
    """The bits that a search for category i follows, and those that end at leaks."""
    ends = sum(map(spread.bits.pair, _searched_with(spread, i)))
    return spread.all_bits if i in spread.made_categories else ends, ends


def _shown_forms(free: Followed, anywhere: Followed, leak: int, forms: tuple[int, int]) -> list[tuple[Followed, int]]:
    """The search and the form to show, the best first (rule S10)."""
    each = [(followed, bit) for followed in (free, anywhere) for bit in forms]
    plain, hidden, plain_through, hidden_through = (present(reach, leak) >> bit & 1 for (reach, _), bit in each)
    flags = shown_arrivals(plain, hidden, plain_through, hidden_through)
    return [one for one, shown in zip(each, flags, strict=True) if shown]


def _as_plain_also(finding: Finding, options: Options) -> Finding:
    """Return a finding as one that stands beside a pseudonymised one; it is decided about by itself.

    What is accepted here hides nothing in any case: all that lies behind it lies behind the other leak, too.
    """
    own = finding_id(finding.category, finding.source, finding.leak, finding.kind, plain_also=True)
    told = replace(finding, id=own, plain_also=True)
    return replace(told, accepted=bool(options.accepts and options.accepts(Case.of(told))))


def _finding(
    net: Net, reach: Search, source: int, leak: int, bit: int, concern: Concern, accepted: Mapping[int, int], *,
    dismissed: bool,
) -> Finding:  # fmt: skip
    spread = net.spread
    elements = spread.graph.elements
    i = spread.bits.category(bit)
    own = leak == source and reach.begun[source] >> bit & 1  # a finding by itself, of one element
    path = [(START, source, bit)] if own else path_to(net, reach, leak, bit)
    through = _other_leaks(spread, path, i, accepted)
    category = spread.categories[i]
    witness = witness_of(net, path)
    return Finding(
        id=finding_id(category, elements[source], elements[leak], concern.kind),
        kind=concern.kind,
        category=category,
        pseudonymised=spread.bits.is_pseudonymised(bit),
        source=elements[source],
        leak=elements[leak],
        witness=witness.elements,
        steps=witness.steps,
        number_of_paths=1,
        through=tuple(elements[v] for v in dict.fromkeys(through)) if dismissed else (),
        dismissed=dismissed,
        why=concern.reasons.get((leak, category)),
        accepted=bool(accepted.get(leak, 0) >> bit & 1),
    )


def _other_leaks(spread: Spread, path: list[tuple[int, int, int]], i: int, accepted: Mapping[int, int]) -> list[int]:
    """Leaks of a category inside a path that are not accepted, where it arrives or is made."""
    both = spread.bits.pair(i)
    leaks = {v: spread.leaks.get(v, 0) & both & ~accepted.get(v, 0) for _, v, _ in path}
    inside = [(v, bits) for (_, v, arriving), (_, _, leaving) in pairwise(path[1:]) for bits in [{arriving, leaving}]]
    return [v for v, bits in inside if any(leaks[v] >> b & 1 for b in bits)]


def finding_id(
    category: str, source: Element, leak: Element, kind: str = DISCLOSURE, *, plain_also: bool = False
) -> str:
    """Return the stable id of a finding, made from category, source and leak, and the kind if several can be (S10).

    Data as it is ``plain_also`` a pseudonymised finding has an id of its own, made with the word 'plain'. Only a
    channel has a leg, or names that a DENY takes out.

    >>> finding_id("Video", Element("node", "/camera"), Element("node", "/uplink"))
    '72abf86b6fa9e2ae'
    """
    more = [*(["plain"] if plain_also else []), *([] if kind == DISCLOSURE else [kind])]
    more += [*([leak.leg] if leak.leg else []), *leak.without]
    parts = [*more, category, *source.identity, *leak.identity]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


def _remarks(spread: Spread, work: _Tallies) -> Iterator[Diagnostic]:
    """What is to be said beside the answer: labels without effect, and paths that were not counted (rule S11)."""
    yield from (one.diagnostic() for one in spread.overruled)
    yield from untouched(spread.facts, spread.graph.elements, spread.categories)
    yield from work.not_counted()


def _lacking(lacks: str, options: Options, spread: Spread) -> tuple[Diagnostic, ...]:
    return lacking(lacks, restricted=options.categories is not None, limited=bool(spread.limited))


def _kept_carried(spread: Spread, mask: int, hierarchy: Hierarchy) -> tuple[CarriedData, ...]:
    """What is where; that of before, where data goes the same ways and the same is asked."""
    same = mask, spread.absent_bits, hierarchy
    return spread.course.memoised("carried", same, lambda: _carried(spread, mask, hierarchy))


def _carried(spread: Spread, mask: int, hierarchy: Hierarchy) -> tuple[CarriedData, ...]:
    merged: dict[tuple[str, str, str, str], int] = defaultdict(int)
    first: dict[tuple[str, str, str, str], Element] = {}
    for vertex in sorted({*spread.arrives, *spread.leaves}):
        bits = spread.present(vertex) & mask
        if bits:
            element = spread.graph.elements[vertex]
            merged[element.shown_as] |= bits
            first.setdefault(element.shown_as, element)
    narrowest = {bits: tuple(map(hierarchy.narrowest, spread.planes(bits))) for bits in set(merged.values())}
    return tuple(CarriedData(first[key], *narrowest[bits]) for key, bits in merged.items())


def _roles(spread: Spread, mask: int) -> dict[Element, dict[str, tuple[str, ...]]]:
    roles: dict[Element, dict[str, tuple[str, ...]]] = {}
    shown = set(spread.names(mask))
    for vertex, decided in sorted(spread.facts.items()):
        said = {c: fact.roles for c, fact in decided.items() if c in shown and fact.roles}
        if said:
            roles[spread.graph.elements[vertex]] = said
    return roles


def _standard_channels(spread: Spread) -> int:
    """Channels taken as mundane on a shipped file's word alone (rule S13)."""
    elements = spread.graph.elements
    return len({elements[v].identity for v in spread.standard})


def _unstated(spread: Spread) -> Iterator[tuple[Element, str]]:
    """Sanitizers whose method was taken as pseudonymise (rule S8)."""
    for vertex, decided in sorted(spread.facts.items()):
        for category, fact in sorted(decided.items()):
            if fact.unstated and category in spread.categories:
                yield spread.graph.elements[vertex], category
