"""What memory says for each question of the pack, on fleets in which no two robots are alike (rules S7 to S12).

In: what was read and its analysis. Out: rows of some columns of a question, as a method of its name. Where something
is asked of single sources, ``Brute`` says what the rules say.
"""

from __future__ import annotations

from collections import Counter
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.findings.derived_from import origins
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.model import BACKUPS_NOT_STATED, DISCLOSURE, NO_READER
from rosprivacy.analysis.non_ros import BY_KIND
from rosprivacy.answering import answer
from rosprivacy.ingest.neo4j_graph.carrying import moving, passed_and_made
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from tests.helpers.brute import Brute

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element
    from rosprivacy.result import Result
    from rosprivacy.systems.fleet_system import FleetSystem

QUESTION = question_of(Settings())._replace(every=True)
VOCABULARY, HIERARCHY = QUESTION.vocabulary, QUESTION.vocabulary.hierarchy
Rows = list[tuple[Any, ...]]
SAYS = {
    "source": "source", "leak": "leak", "sanitizer": "sanitizer", "conduit": "conduit", "derivation": "derives",
    "mundane": "mundane", "sensitive": "sensitive", "only": "only", "never": "never",
}  # fmt: skip


def kind_of(element: Element) -> str:
    return element.kind + (f" {element.leg}" if element.leg else "")


def place_of(place: object) -> str:
    """Where something stands; of a robot that is like another, in the policy of both."""
    return str(place).rpartition("/")[2].replace("+", "")


def within(category: str, asked: str) -> bool:
    return asked in HIERARCHY.ancestors[category]


def overlap(category: str, asked: str) -> bool:
    """S7: whether something can be of both."""
    return any(category in above and asked in above for above in HIERARCHY.ancestors.values())


class Fleet:
    """What memory says of one fleet."""

    def __init__(self, system: FleetSystem, result: Result) -> None:
        self.system, self.result, self.analysis, self.bound = system, result, result.analysis, system.bound
        self.graph, self.spread = result.analysis.graph, result.analysis.spread
        self.elements = self.graph.elements
        self.shared = {e.robot for e in self.elements if not system.likeness.is_robot(e.robot)}

    @cache  # noqa: B019 - as long as the test
    def ask(self, **settings: Any) -> set[Finding]:
        """The findings of a restricted answer."""
        question = question_of(Settings(**settings))._replace(every=True)
        return {f for f in answer(self.system, question).analysis.findings if not f.dismissed}

    @cached_property
    def origins(self) -> Any:
        return origins(self.spread)

    def at(self, vertex: int) -> set[str]:
        """Kinds that get there, as they are."""
        return set(self.spread.names(self.spread.present(vertex)))

    def brings(self, vertex: int) -> set[str]:
        """Kinds that begin there, or that a label says it makes."""
        made = {s.to for s in self.bound.elements.get(vertex, ()) if s.role == "derivation"}
        return made | set(self.spread.names(self.spread.begins(vertex)))

    def along(self, index: int) -> set[str]:
        return set(self.spread.names(self.spread.along(index)))

    @cached_property
    def gets(self) -> dict[int, set[str]]:
        """Kinds that come along a flow."""
        known: dict[int, set[str]] = {}
        for index, flow in enumerate(self.graph.flows):
            known.setdefault(flow.target, set()).update(self.along(index))
        return known

    @cached_property
    def brute(self) -> Brute:
        elements = dict(enumerate(self.elements))
        said = {v: [s for s in some if s.rank != BY_KIND] for v, some in self.bound.elements.items()}
        outside = {v: (elements[v].kind, facts) for v, facts in self.bound.outside.items()}
        flows = self.graph.flows
        ends = {(e.shown_as, e.without): v for v, e in elements.items() if e.side == "write"}
        sides = {v: ends[e.shown_as, e.without] for v, e in elements.items() if e.side == "read"
                 and (e.shown_as, e.without) in ends}  # fmt: skip
        return Brute(
            {v for v, e in elements.items() if not e.is_channel},
            list(dict.fromkeys((f.source, f.target) for f in flows)),
            said,
            HIERARCHY,
            outside=outside,
            names={v: e.name for v, e in elements.items()},
            stated={(f.source, f.target) for f in flows if f.role == "flow"},
            sides=sides,
        )

    @cached_property
    def reach(self) -> list[tuple[Element, Element, str]]:
        """(source, element, category that gets there)."""
        return [
            (self.elements[source], self.elements[vertex], category)
            for source in self.brute.sources()
            for vertex, (category, _) in self.brute.spread([source])
        ]

    @cached_property
    def enclaves(self) -> dict[tuple[str, str], set[int]]:
        """(robot, path) -> nodes."""
        number = {e.identity: v for v, e in enumerate(self.elements) if e.is_node}
        enclaves: dict[tuple[str, str], set[int]] = {}
        for name, profiles in self.system.placed.profiles.items():
            for one in profiles:
                enclaves.setdefault((name, one.enclave), set()).add(number[name, "node", one.node])
        return enclaves

    def stops(self, vertex: int) -> set[str]:
        """Kinds that do not go on from there."""
        spread = self.spread
        return set(
            spread.names(spread.all_bits & ~spread.bits.in_both_forms(spread.keeps.get(vertex, spread.all_bits)))
        )

    def takes(self, index: int, kind: str) -> bool:
        """Whether a kind may go along a flow."""
        return kind in self.spread.names(self.spread.passing(index))

    def leaks_from(self, kind: str) -> dict[int, set[int]]:
        """Where a kind begins, at a source or where it is made -> the leaks that it gets to past no other."""
        names = self.spread.names
        leaks = {v for v, bits in self.spread.leaks.items() if kind in names(bits)}
        onward: dict[int, set[int]] = {}
        found: dict[int, set[int]] = {}
        for v in leaks:
            if kind in names(self.spread.begins(v) | passed_and_made(self.spread, v)[1]):
                found[v] = {v}
        first: dict[int, set[int]] = {}
        for flow, some in zip(self.graph.flows, moving(self.analysis), strict=True):
            if kind in names(some.passed):
                onward.setdefault(flow.source, set()).add(flow.target)
            if kind in names(some.begun | some.derived):
                first.setdefault(flow.source, set()).add(flow.target)
        for start, ends in first.items():
            there, new = set[int](), ends
            while new:
                there |= new
                new = {b for a in new - leaks for b in onward.get(a, ())} - there
            found.setdefault(start, set()).update(there & leaks)
        return found

    @cached_property
    def verdicts(self) -> dict[str, tuple[str, str]]:
        """Name -> verdict, part: rules S11, S12."""
        ends = {e.robot for f in self.analysis.findings if not f.dismissed for e in (f.source, f.leak)}
        open_at = {q.element.robot for q in self.analysis.open}
        shown = {q.element.shown_as for q in self.analysis.open if q.element.is_channel}
        for flow in self.graph.flows:
            a, b = self.elements[flow.source], self.elements[flow.target]
            open_at |= {b.robot} if a.shown_as in shown else {a.robot} if b.shown_as in shown else set()
        known = set() if self.analysis.lacking else {c.element.robot for c in self.analysis.carried}
        told = {}
        for name in {e.robot for e in self.elements}:
            base, lab = name.endswith("base"), name.startswith("domain ")
            part = "domain" if lab else "infrastructure" if base else "fleet" if name in self.shared else "robot"
            verdict = "undetermined" if name in open_at or name not in known else "no-leak-found"
            told[name] = ("leak" if name in ends else verdict, part)
        return told

    @cached_property
    def doubts(self) -> dict[str, set[str]]:
        """Name -> lines: rule S11; of a channel of a domain also those of who writes or reads it."""
        lines = {
            BACKUPS_NOT_STATED: "backups of {} are not stated and taken as none",
            NO_READER: "{} ends at no known reader",
        }
        told: dict[str, set[str]] = {}
        for doubt in self.result.doubts:
            assert doubt.element is not None, "of these fleets all is read"
            e = doubt.element
            own = self.system.likeness.is_robot(e.robot)
            line = f"rides {doubt.name}: " + lines[doubt.name].format(e.name if own else f"{e.robot}:{e.name}")
            ends = ((self.elements[flow.source], self.elements[flow.target]) for flow in self.graph.flows)
            beside = {
                b.robot if a.shown_as == e.shown_as else a.robot
                for a, b in ends
                if e.shown_as in (a.shown_as, b.shown_as)
            }
            for name in {e.robot} | (beside if e.is_channel else set()):
                told.setdefault(name, set()).add(line)
        return told


class Memory:
    """What the fleets say together: for each question the rows of some of its columns."""

    def __init__(self, fleets: Collection[Fleet]) -> None:
        self.fleets = fleets

    def findings_at(self, robot: str, *, standing: bool = True) -> Iterator[tuple[Fleet, Finding]]:
        for one in self.fleets:
            for f in one.analysis.findings:
                if robot in ("", f.source.robot, f.leak.robot) and not (standing and f.dismissed):
                    yield one, f

    def findings(self, robot: str = "", category: str = "") -> Rows:
        return [
            (f.source.robot, f.kind, f.category, f.source.name, f.leak.name, f.leak.robot, f.pseudonymised, f.dismissed,
             bool(category) and not within(f.category, category), one.verdicts[f.source.robot][0])
            for one, f in self.findings_at(robot, standing=False)
            if not category or overlap(f.category, category)
        ]  # fmt: skip

    def findings_by_pattern(self, category: str = "") -> Rows:
        groups: dict[Any, set[str]] = {}
        for one, f in self.findings_at(""):
            if not category or overlap(f.category, category):
                may_be = bool(category) and not within(f.category, category)
                key = (f.category, f.source.name, f.leak.name, f.kind, pattern_id(f, one.system.likeness), may_be)
                groups.setdefault(key, set()).update({f.source.robot} - one.shared)
        return [(len(robots), *key) for key, robots in groups.items()]

    def findings_by_robot(self, robot: str = "") -> Rows:
        counts: Counter[tuple[str, str, bool, bool]] = Counter()
        for _, f in self.findings_at(robot, standing=False):
            for at in {f.source.robot, f.leak.robot}:
                counts[at, f.category, f.dismissed, f.source.robot != at] += robot in ("", at)
        keys = {key[:2] for key, count in counts.items() if count}
        return [
            (at, category, counts[at, category, False, False] + counts[at, category, False, True],
             counts[at, category, True, False] + counts[at, category, True, True], counts[at, category, False, True])
            for at, category in keys
        ]  # fmt: skip

    def _restricted(self, robot: str, **settings: Any) -> Rows:
        return sorted(
            {
                (f.source.robot, f.category, f.source.name, f.leak.name, f.leak.robot)
                for one in self.fleets
                for f in one.ask(**settings)
                if robot in ("", f.source.robot, f.leak.robot)
            }
        )

    def findings_by_data_type(self, type: str, robot: str = "") -> Rows:  # noqa: A002 - its name
        return self._restricted(robot, data_types=(type,))

    def findings_by_identity_factor(self, factor: str, robot: str = "") -> Rows:
        return self._restricted(robot, identity_factors=(factor,))

    def findings_under_article(self, may: str = "true", robot: str = "") -> Rows:
        level = "may-reveal" if may == "true" else "conditional"
        return self._restricted(robot, article9=True, article9_level=level)

    def leak_paths(self, robot: str = "", category: str = "") -> Rows:
        return [
            (f.source.robot, f.category, f.source.name, f.leak.name, f.leak.robot, tuple(e.name for e in f.witness),
             tuple(place_of(s.grants[0].place) if s.grants else "wildcard" for s in f.steps),
             bool(category) and not within(f.category, category))
            for _, f in self.findings_at(robot)
            if f.kind == DISCLOSURE and (not category or overlap(f.category, category))
        ]  # fmt: skip

    def leak_paths_of_category(self, category: str) -> Rows:
        return [
            (f.source.robot, f.category, f.source.name, f.leak.name, f.leak.robot, not within(f.category, category))
            for _, f in self.findings_at("")
            if f.kind == DISCLOSURE and overlap(f.category, category)
        ]

    def leak_path_graph(self, robot: str = "", category: str = "") -> Rows:
        """From where it begins, at the source or where it is made, past no leak of the kind."""
        pairs: set[tuple[Any, ...]] = set()
        for one in self.fleets:
            for kind in (
                one.spread.categories if not category else [k for k in one.spread.categories if overlap(k, category)]
            ):
                for start, leaks in one.leaks_from(kind).items():
                    for a, b in ((one.elements[start], one.elements[leak]) for leak in leaks):
                        if robot in ("", a.robot, b.robot):
                            may_be = bool(category) and not within(kind, category)
                            pairs.add((a.robot, kind, a.name, b.name, b.robot, may_be))
        return sorted(pairs)

    def data_graph(self, robot: str = "", category: str = "") -> Rows:
        steps: set[tuple[Any, ...]] = set()
        for one in self.fleets:
            for index, flow in enumerate(one.graph.flows):
                a, b = one.elements[flow.source], one.elements[flow.target]
                for kind in one.along(index):
                    if robot in ("", a.robot, b.robot) and (not category or overlap(kind, category)):
                        may_be = bool(category) and not within(kind, category)
                        steps.add((a.robot, kind, a.name, b.name, b.robot, may_be))
        return sorted(steps)

    def leaks_behind_leaks(self, robot: str = "") -> Rows:
        return [
            (f.source.robot, f.category, f.source.name, f.leak.name, f.leak.robot, tuple(e.name for e in f.witness),
             f.pseudonymised)
            for _, f in self.findings_at(robot, standing=False)
            if f.dismissed
        ]  # fmt: skip

    def lines_behind_findings(self, robot: str = "") -> Rows:
        lines: dict[str, list[tuple[int, set[str], str]]] = {}
        for number, (one, f) in enumerate(self.findings_at(robot)):
            for line in {place_of(s.grants[0].place) for s in f.steps if s.grants}:
                lines.setdefault(line, []).append((number, {f.source.robot, f.leak.robot} - one.shared, f.category))
        return [
            (
                len(some),
                line,
                len(set().union(*(robots for _, robots, _ in some))),
                tuple(sorted({c for *_, c in some})),
            )
            for line, some in lines.items()
        ]

    def pseudonymised_at_leaks(self, robot: str = "") -> Rows:
        return [
            (f.source.robot, f.category, f.source.name, f.leak.name, f.leak.robot, tuple(e.name for e in f.witness))
            for _, f in self.findings_at(robot)
            if f.kind == DISCLOSURE and f.pseudonymised
        ]

    def reaching_leak(self, leak: str, robot: str = "") -> Rows:
        return [
            (f.source.robot, f.category, f.source.name, f.pseudonymised, f.dismissed, f.leak.robot,
             tuple(e.name for e in f.witness))
            for _, f in self.findings_at(robot, standing=False)
            if f.kind == DISCLOSURE and f.leak.name == leak
        ]  # fmt: skip

    def robots(self) -> Rows:
        rows = []
        for one in self.fleets:
            for name, (verdict, part) in one.verdicts.items():
                ending = [f for f in one.analysis.findings if name in (f.source.robot, f.leak.robot)]
                count = sum(f.dismissed for f in ending)
                is_open = len({q.element.shown_as for q in one.analysis.open if q.element.robot == name})
                shown = verdict if part != "domain" else None  # it has none
                rows.append((name, shown, len(ending) - count, count, is_open, part if part != "robot" else None))
        return rows

    def verdicts(self) -> Rows:
        those: dict[tuple[str, str], list[set[str]]] = {}
        for one in self.fleets:
            for name, said in one.verdicts.items():
                if said[1] != "domain":
                    those.setdefault(said, []).append(one.doubts.get(name, set()))
        rows = []
        for (verdict, part), some in those.items():
            lines = sorted(set().union(*some))
            rows.append((verdict, "declared", len(some), part, tuple(lines[:20]), len(lines)))
        return rows

    def robots_that_differ(self) -> Rows:
        by_robot = {}
        for one in self.fleets:
            for name in one.verdicts.keys() - one.shared:
                found = {
                    ("" if f.kind == DISCLOSURE else f"{f.kind} ") + "pseudonymised " * f.pseudonymised
                    + f"{f.category}: {f.source.name}{'' if f.source.robot == name else ' elsewhere'} -> {f.leak.name}"
                    for f in one.analysis.findings
                    if not f.dismissed and name in (f.source.robot, f.leak.robot)
                }  # fmt: skip
                at = {q.element for q in one.analysis.open if q.element.robot == name}
                by_robot[name] = (tuple(sorted(found)), tuple(sorted({f"{kind_of(e)} {e.name}" for e in at})))
        usual = []
        for part in (0, 1):
            counts = Counter(said[part] for said in by_robot.values())
            first = {said: min(n for n, s in by_robot.items() if s[part] == said) for said in counts}
            usual.append(min(counts, key=lambda said: (-counts[said], first[said])) if counts else ())
        return [
            (name, tuple(x for x in found if x not in usual[0]), tuple(x for x in usual[0] if x not in found),
             tuple(x for x in at if x not in usual[1]), tuple(x for x in usual[1] if x not in at))
            for name, (found, at) in by_robot.items()
            if (found, at) != tuple(usual)
        ]  # fmt: skip

    def open_elements(self, robot: str = "") -> Rows:
        return [
            (q.frontier, q.distance, q.element.robot, kind_of(q.element), q.element.name, tuple(q.categories))
            for one in self.fleets
            for q in one.analysis.open
            if robot in ("", q.element.robot)
        ]  # fmt: skip

    def review_next(self, robot: str = "") -> Rows:
        groups: dict[tuple[str, str], list[Any]] = {}
        for one in self.fleets:
            for q in one.analysis.open:
                if q.frontier and robot in ("", q.element.robot):
                    groups.setdefault((kind_of(q.element), q.element.name), []).append((one, q))
        return [
            (
                min(q.distance for _, q in some),
                *key,
                tuple(sorted({c for _, q in some for c in q.categories})),
                len(some),
            )
            for key, some in groups.items()
        ]

    def category_overview(self, robot: str = "") -> Rows:
        rows = []
        for name in VOCABULARY.categories:
            sources = elements = is_open = 0
            for one in self.fleets:
                here = [v for v, e in enumerate(one.elements) if robot in ("", e.robot)]
                for v in here:
                    sources += any(within(kind, name) for kind in one.brings(v))
                    elements += any(within(kind, name) for kind in one.at(v))
                is_open += sum(
                    robot in ("", q.element.robot) and any(within(kind, name) for kind in q.categories)
                    for q in one.analysis.open
                )
            count = sum(within(f.category, name) for _, f in self.findings_at(robot))
            if sources + elements:
                rows.append((name, sources, elements, count, is_open))
        return rows

    def carrying_both(self, first: str, second: str, robot: str = "") -> Rows:
        rows: set[tuple[Any, ...]] = set()
        for one in self.fleets:
            for v, e in enumerate(one.elements):
                both = [[kind for kind in one.at(v) if overlap(kind, asked)] for asked in (first, second)]
                if all(both) and robot in ("", e.robot):
                    sure = all(
                        any(within(k, asked) for k in some) for some, asked in zip(both, (first, second), strict=True)
                    )
                    rows.add((e.robot, kind_of(e), e.name, not sure))
        return sorted(rows)

    def derivations(self, robot: str = "") -> Rows:
        return [
            (maker.robot, o.category, maker.name, source.name, o.past_leak, source.robot)
            for one in self.fleets
            for o in one.origins
            for maker, source in [(one.elements[o.maker], one.elements[o.source])]
            if robot in ("", maker.robot, source.robot)
        ]

    def reach_of_source(self, source: str, robot: str = "") -> Rows:
        return sorted(
            {
                (a.robot, category, kind_of(b), b.name, b.robot)
                for one in self.fleets
                for a, b, category in one.reach
                if a.name == source and robot in ("", a.robot, b.robot)
            }
        )

    def sources_of_element(self, element: str, robot: str = "") -> Rows:
        return sorted(
            {
                (b.robot, kind_of(b), category, a.name, a.robot)
                for one in self.fleets
                for a, b, category in one.reach
                if b.name == element and robot in ("", a.robot, b.robot)
            }
        )

    def path_between(self, start: str, end: str, robot: str = "") -> Rows:
        """Through mundane channels too: the robots of the starts from which one gets to the end."""
        rows = set()
        for one in self.fleets:
            onward: dict[int, set[int]] = {}
            for flow in one.graph.flows:
                onward.setdefault(flow.source, set()).add(flow.target)
            for v, e in enumerate(one.elements):
                there, new = set[int](), {v}
                while new := {b for a in new for b in onward.get(a, ())} - there:
                    there |= new
                ends = {one.elements[b].robot for b in there if one.elements[b].name == end}
                if e.name == start and (e.robot == robot or (robot in ends or not robot)) and ends:
                    rows.add((e.robot,))
        return sorted(rows)

    def storages(self, robot: str = "") -> Rows:
        rows = []
        for one in self.fleets:
            for v, e in enumerate(one.elements):
                if e.kind == "storage" and robot in ("", e.robot):
                    ends: list[set[str]] = [set(), set()]
                    for index, flow in enumerate(one.graph.flows):
                        if v in (flow.source, flow.target) and one.along(index):
                            ends[flow.source == v].add(one.elements[flow.source + flow.target - v].name)
                    holds = tuple(sorted(one.gets.get(v, set())))
                    rows.append((e.robot, e.name, holds, *(tuple(sorted(some)) for some in ends)))
        return rows

    def sanitizers(self, robot: str = "") -> Rows:
        """Those of kinds that get there."""
        return [
            (e.robot, e.name, kind)
            for one in self.fleets
            for v, e in enumerate(one.elements)
            if robot in ("", e.robot) and any(s.role == "sanitizer" for s in one.bound.elements.get(v, ()))
            for kind in one.gets.get(v, ())
            if one.brute.has(v, "sanitizer", kind)
        ]

    def unstated_methods(self, robot: str = "") -> Rows:
        return [
            (e.robot, e.name, kind, place_of(s.place))
            for one in self.fleets
            for v, e in enumerate(one.elements)
            for s in one.bound.elements.get(v, ())
            if robot in ("", e.robot) and s.role == "sanitizer" and not s.stated
            for kind in s.categories
        ]

    def leaks_not_reached(self, robot: str = "") -> Rows:
        return [
            (e.robot, e.name, kind)
            for one in self.fleets
            for v, e in enumerate(one.elements)
            for s in one.bound.elements.get(v, ())
            if robot in ("", e.robot) and s.role == "leak" and s.rank != BY_KIND
            for kind in s.categories
            if not any(
                f.leak == e and f.kind == DISCLOSURE and overlap(f.category, kind) for f in one.analysis.findings
            )
        ]

    def shared_channels(self, least: str, robot: str = "") -> Rows:
        counts: dict[tuple[str, str, str], list[str]] = {}
        for one in self.fleets:
            for f in one.analysis.findings:
                for e in {e.identity: e for e in f.witness if e.is_channel}.values():
                    if not f.dismissed and robot in ("", e.robot, f.source.robot, f.leak.robot):
                        counts.setdefault((e.robot, e.kind, e.name), []).append(f.category)
        return [(len(some), *key, tuple(sorted(set(some)))) for key, some in counts.items() if len(some) >= int(least)]

    def wildcards_on_leak_paths(self, robot: str = "") -> Rows:
        counts: dict[tuple[str, str], set[int]] = {}
        for one in self.fleets:
            for number, f in enumerate(one.analysis.findings):
                for e in f.witness:
                    if e.side and not f.dismissed and robot in ("", e.robot, f.source.robot, f.leak.robot):
                        counts.setdefault((e.robot, e.name), set()).add(number)
        return [(*key,) for key in counts]

    def labels_of_element(self, element: str, robot: str = "") -> Rows:
        rows: set[tuple[Any, ...]] = set()
        top = [name for name, above in HIERARCHY.ancestors.items() if len(above) == 1]
        for one in self.fleets:
            for v, e in enumerate(one.elements):
                for s in one.bound.elements.get(v, ()) if e.name == element and robot in ("", e.robot) else ():
                    if s.rank != BY_KIND:
                        named = [s.to] if s.role == "derivation" else s.categories or ["every"] * bool(top)
                        rows |= {(e.robot, e.kind, SAYS[s.role], kind, place_of(s.place)) for kind in named}
        return sorted(rows)

    def mixed_enclaves(self, robot: str = "") -> Rows:
        rows = []
        for one in self.fleets:
            for (name, path), nodes in one.enclaves.items():
                for kind in VOCABULARY.categories if robot in ("", name) else ():
                    brings = {v for v in nodes if kind in one.brings(v)}
                    leaks, cleans = (
                        {v for v in nodes if one.brute.has(v, role, kind)} for role in ("leak", "sanitizer")
                    )
                    gets = {v for v in nodes if kind in one.gets.get(v, ())}
                    begins = brings or gets & (leaks | cleans)
                    pair = (brings and leaks) or (cleans and brings | leaks)
                    if begins and pair and len(brings | leaks | cleans) > 1:
                        rows.append((name, path, kind, *(
                            tuple(sorted(one.elements[v].name for v in some)) for some in (brings, leaks, cleans)
                        )))  # fmt: skip
        return rows

    def unused_grants(self, robot: str = "") -> Rows:
        """The lines that come first for a flow, of which no flow carries anything, nor one that they allow further."""
        rows: set[tuple[Any, ...]] = set()
        for one in self.fleets:
            used: set[Any] = set()
            first: set[Any] = set()
            for index, flow in enumerate(one.graph.flows):
                node = min((one.elements[v] for v in (flow.source, flow.target)), key=lambda e: e.is_channel)
                lines = [
                    (node.robot, g.enclave, g.node, flow.role, place_of(g.place)) for g in flow.grants if g.enclave
                ]
                first |= set(lines[:1])
                used |= set(lines) if one.along(index) else set()
            rows |= {line for line in first - used if robot in ("", line[0])}
        return sorted(rows)

    def denied_grants_that_cut(self, otherwise: str, robot: str = "") -> Rows:
        """Where a kind that leaves the start of a denied flow would go on to a leak, past no other."""
        rows: set[tuple[Any, ...]] = set()
        for one in self.fleets:
            names, reached = (
                one.spread.names,
                {(f.leak, f.category) for f in one.analysis.findings if f.kind == DISCLOSURE},
            )
            for flow in one.graph.taken_back if otherwise else ():
                a, b = one.elements[flow.source], one.elements[flow.target]
                leaving = one.gets.get(flow.source, set()) - one.stops(flow.source)
                leaving |= set(names(one.spread.begins(flow.source) | passed_and_made(one.spread, flow.source)[1]))
                for kind in leaving:
                    leaks = {v for v, bits in one.spread.leaks.items() if kind in names(bits)}
                    there, new = set[int](), {flow.target}
                    while new:
                        there |= new
                        ends = {v for v in new - leaks if kind not in one.stops(v)}
                        new = {
                            f.target for i, f in enumerate(one.graph.flows) if f.source in ends and one.takes(i, kind)
                        }
                        new -= there
                    for leak in (one.elements[v] for v in there & leaks):
                        if robot in ("", a.robot, b.robot, leak.robot):
                            known = (leak, kind) in reached
                            rows.add((a.robot, kind, a.name, b.name, leak.name, known, b.robot, leak.robot))
        return sorted(rows)

    def enclave_neighbours_of_sanitizers(self, robot: str = "") -> Rows:
        """Who could take what a sanitizer reads, and write it on, since its enclave may."""
        rows = []
        for one in self.fleets:
            elements, moved = one.elements, list(zip(one.graph.flows, moving(one.analysis), strict=True))
            for (name, path), nodes in one.enclaves.items():
                ours = [(f, some) for f, some in moved if any(g.enclave == path for g in f.grants)]
                for e in nodes if robot in ("", name) else ():
                    if not any(s.role == "sanitizer" for s in one.bound.elements.get(e, ())):
                        continue
                    for kind in one.spread.categories:
                        reads = {
                            elements[f.source].name for f, some in ours
                            if f.target == e and elements[f.source].is_channel and kind in one.spread.names(some.passed)
                        }  # fmt: skip
                        writes = {
                            elements[f.target].name for f, _ in ours
                            if f.source in nodes and elements[f.target].is_channel and kind not in one.stops(f.target)
                        }  # fmt: skip
                        beside = {n for n in nodes if n != e and kind not in one.stops(n)}
                        already = {
                            f.target
                            for f, some in moved
                            if f.target in beside and kind in one.spread.names(some.passed)
                        }
                        if reads and writes and beside and one.brute.has(e, "sanitizer", kind):
                            some = (
                                {elements[n].name for n in beside},
                                {elements[n].name for n in already},
                                reads,
                                writes,
                            )
                            rows.append((name, path, elements[e].name, kind, *(tuple(sorted(x)) for x in some)))
        return rows

    def beyond_profiles(self, robot: str = "") -> Rows:
        """Nobody asked for both views."""
        names = (name for one in self.fleets for name in one.verdicts.keys() - one.shared)
        return [(name, False) for name in names if robot in ("", name)]

    def none(self, robot: str = "") -> Rows:  # noqa: ARG002 - as the question has it
        return []
