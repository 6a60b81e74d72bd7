"""Random systems: graphs with cycles, derivations and both planes, and the analysis of one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from rosprivacy.analysis.durations import parse
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import (
    CLEANS,
    NON_ROS,
    NOWHERE,
    STATED,
    Bound,
    Category,
    Element,
    Exposure,
    Flow,
    FlowGraph,
    Method,
    NonRosFacts,
    Place,
    Statement,
)
from rosprivacy.analysis.non_ros import by_kind
from rosprivacy.ingest.labels.countries import countries
from tests.helpers.brute import Brute

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis

#        Any
#       /   \
#     Bio   Loc    70 more without a broader one, so that two planes need three words
#    /   \  /
#  Face  Track     a kind of both: data of the one may be of the other
PARENTS = {"Any": (), "Bio": ("Any",), "Loc": ("Any",), "Face": ("Bio",), "Track": ("Bio", "Loc")}
HIERARCHY = Hierarchy.of(Category(n, f"urn:{n}", n, n, n, up) for n, up in PARENTS.items())
WIDE = [f"K{i:02}" for i in range(70)]
WIDE_HIERARCHY = Hierarchy.of(Category(n, f"urn:{n}", n, n, n) for n in WIDE)
METHODS = CLEANS  # what a label of a sanitizer can say; `absent` is a word of its own
IN_THE_OPEN = Exposure("not-encrypted", Place("governance.p7s", 9))
ABSENT = Statement("sanitizer", (), (1, 0), Place("labels", 1), Method.ABSENT, why="sold")


Ends = tuple[set[tuple[str, str, int, int, bool]], dict[int, tuple[set[str], bool]]]  # findings, and what is open


def statement(role: str, *categories: str, method: Method | None = None, to: str = "") -> Statement:
    return Statement(role, categories, (1, 0), Place("labels", 1), method, to=to)


@dataclass
class System:
    """The last of the nodes are elements outside ROS."""

    nodes: int
    channels: int
    edges: list[tuple[int, int]]
    said: dict[int, list[Statement]]
    never: dict[int, set[str]]
    hierarchy: Hierarchy = HIERARCHY
    outside: list[tuple[str, NonRosFacts]] = field(default_factory=list)
    exposed: frozenset[int] = frozenset()  # channels, by vertex
    wildcard: bool = False  # the last two channels are what is written to a wildcard and what is read from it
    service: bool = False  # … or the legs of a service

    @property
    def sides(self) -> dict[int, int]:
        end = self.nodes + self.channels
        return {end - 1: end - 2} if self.wildcard else {}

    @property
    def facts(self) -> dict[int, tuple[str, NonRosFacts]]:
        return dict(enumerate(self.outside, self.nodes - len(self.outside)))

    def graph(self) -> FlowGraph:
        kinds = ["node"] * (self.nodes - len(self.outside)) + [kind for kind, _ in self.outside]
        elements = [Element(kind, f"/n{i}" if kind == "node" else f"n{i}") for i, kind in enumerate(kinds)]
        elements += [Element("topic", f"/t{i}") for i in range(self.channels)]
        for read, written in self.sides.items():
            elements[written], elements[read] = (Element("topic", "/w*", side=side) for side in ("write", "read"))
        if self.service:
            elements[-2:] = (Element("service", "/s", leg=leg) for leg in ("request", "response"))
        flows = tuple(Flow(a, b, STATED if (a, b) in self.stated else "publish") for a, b in self.edges)
        return FlowGraph(tuple(elements), flows, (), ())

    @property
    def stated(self) -> set[tuple[int, int]]:
        """Flows that begin or end outside ROS."""
        return {(a, b) for a, b in self.edges if {a, b} & set(self.facts)}

    def through(self) -> dict[tuple[int, tuple[str, ...]], tuple[int, ...]]:
        """The flows to the channels that sources name."""
        named = {(v, s.through) for v, said in self.said.items() for s in said if s.through}
        names = [element.name for element in self.graph().elements]
        ends = list(enumerate(self.edges))
        return {(v, some): tuple(i for i, (a, b) in ends if a == v and names[b] in some) for v, some in named}

    def bound(self) -> Bound:
        flows = {i: (statement("never", *sorted(names)),) for i, names in self.never.items()}
        elements = self.graph().elements
        said = {v: (*said, *by_kind(elements[v])) for v, said in sorted(self.said.items())}
        facts = {v: facts for v, (_, facts) in self.facts.items()}
        statements = {v: some for v, some in said.items() if some}
        exposed = dict.fromkeys(sorted(self.exposed), (IN_THE_OPEN,))
        return Bound(statements, flows, self.through(), outside=facts, exposed=exposed)

    def analyse(self, options: Options | None = None) -> Analysis:
        return analyse(self.graph(), self.bound(), self.hierarchy, options)

    def brute(self) -> Brute:
        never = {self.edges[i]: names for i, names in self.never.items()}
        names = {v: e.name for v, e in enumerate(self.graph().elements)}
        return Brute(
            range(self.nodes),
            self.edges,
            self.said,
            self.hierarchy,
            never,
            self.facts,
            names,
            self.stated,
            self.sides,
            self.exposed,
        )


@st.composite
def facts(draw: st.DrawFn, names: tuple[str, ...]) -> tuple[str, NonRosFacts]:
    """An element outside ROS; most are storages."""
    duration = st.sampled_from([parse(text) for text in ("P10D", "P30D", "P31D", "P1M", "P6M", "P1Y")])
    about = st.sampled_from(("", *names))
    stated = st.dictionaries(about, duration, max_size=2).map(lambda found: tuple(sorted(found.items())))
    country = draw(st.sampled_from(["", "DE", "KR", "US", "CN"]))
    return draw(st.sampled_from(("storage", "storage", *NON_ROS))), NonRosFacts(
        draw(stated), draw(stated), draw(st.sampled_from([None, None, True, False, parse("P30D")])),
        transfer=draw(st.sampled_from(["", "", "none", "standard-clauses", "derogation"])),
        place=NOWHERE, encrypted=None, recording=None,
        **(countries().place(country) if country else {}),
    )  # fmt: skip


@st.composite
def systems(
    draw: st.DrawFn, names: tuple[str, ...] = tuple(PARENTS), most: int = 7, degree: int = 3, outside: int = 3
) -> System:
    """Dense enough that most have a leak, a third something derived, pseudonymised or dismissed (measured)."""
    ros, channels = draw(st.integers(1, most)), draw(st.integers(1, most - 1))
    beside = draw(st.lists(facts(names), max_size=outside))
    nodes = ros + len(beside)
    ends = st.sets(st.integers(0, nodes - 1), min_size=1, max_size=degree)
    edges: set[tuple[int, int]] = set()
    for element in range(ros, nodes):
        before, behind = draw(ends) - {element}, draw(ends) - {element}  # nothing flows from an element to itself
        edges |= {(a, element) for a in before} | {(element, b) for b in behind}
    for channel in range(nodes, nodes + channels):
        read = draw(st.one_of(ends, ends, ends, st.just(set[int]())))  # some channels end at no known reader
        edges |= {(node, channel) for node in draw(ends)} | {(channel, node) for node in read}
    category = st.sampled_from(names)
    cleans = st.builds(
        lambda c, m: statement("sanitizer", c, method=m), category, st.sampled_from((*METHODS, Method.PSEUDONYMISE))
    )
    derives = st.builds(lambda c, t: statement("derivation", c, to=t), category, category)
    others = [st.builds(statement, st.just(role), category) for role in ("source", "leak", "conduit")]
    labels = st.lists(st.one_of(cleans, derives, derives, *others), max_size=2, unique=True)
    said = {vertex: draw(labels) for vertex in range(nodes)}
    always = [*others[:2], others[1], derives, cleans]  # a source, two leaks, a derivation, a sanitizer
    for label in always:
        said[draw(st.integers(0, nodes - 1))].append(draw(label))
    if draw(st.integers(0, 3)) == 0:
        said[draw(st.integers(0, nodes - 1))] = [ABSENT]  # it stands alone
    plain = st.sampled_from([[], [], [statement("mundane")], [statement("sensitive")]])
    some = st.sets(category, min_size=1, max_size=2)
    part = st.builds(lambda r, c: [statement(r, *sorted(c))], st.sampled_from(["only", "never"]), some)
    said |= {vertex: draw(st.one_of(plain, plain, part)) for vertex in range(nodes, nodes + channels)}
    never = draw(st.dictionaries(st.integers(0, len(edges) - 1), some, max_size=2))
    unique = {vertex: list(dict.fromkeys(rows)) for vertex, rows in said.items()}
    exposed = draw(st.one_of(st.just(frozenset[int]()), st.frozensets(st.integers(nodes, nodes + channels - 1))))
    return System(nodes, channels, sorted(edges), unique, never, outside=beside, exposed=exposed)


def analysed(system: System) -> Analysis | None:
    """None where the labels contradict each other."""
    try:
        return system.analyse()
    except InputErrors:
        return None


def sent(system: System, found: Analysis) -> set[tuple[int, int, tuple[str, bool]]]:
    """What goes along each flow, as ``Brute.along`` has it."""
    return {
        (*system.edges[i], (name, bool(plane)))
        for i in range(len(system.edges))
        for plane, names in enumerate(found.spread.planes(found.spread.along(i)))
        for name in names
    }


def findings_and_questions(system: System, found: Analysis) -> Ends:
    """Findings, and what is open, by number of the element."""
    number = index(system)
    findings = {(f.kind, f.category, number[f.source], number[f.leak], f.dismissed) for f in found.findings}
    return findings, {number[q.element]: (set(q.categories), q.frontier) for q in found.open}


def those_of_brute_force(brute: Brute) -> Ends:
    """The same, as brute force has it."""
    findings = {(*key[:4], dismissed) for key, (_, dismissed, _) in brute.findings().items()}
    return findings, {vertex: (names, frontier) for vertex, (names, _, frontier) in brute.open().items()}


def index(system: System) -> dict[Element, int]:
    return {element: i for i, element in enumerate(system.graph().elements)}
