"""Random systems in which every line has a place of its own: some lines are about several elements, some deny flows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import GLOB, Bound, Flow, FlowGraph, Grant, Place, Statement
from rosprivacy.analysis.whatif.ledger import ledger
from tests.helpers.systems import System, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.whatif.ledger import TakenAway
    from tests.helpers.brute import Brute

ADDS = {"source", "leak"}
NEVER = 1000  # the line of what is said of the first flow


@dataclass
class Stated:
    """A system in which every line has a place of its own, and some flows are denied.

    Attributes
    ----------
    denied
        Flow -> the lines of the DENYs that take it away.
    """

    system: System
    denied: dict[tuple[int, int], set[int]]

    @property
    def edges(self) -> list[tuple[int, int]]:
        return [edge for edge in self.system.edges if not self.denied.get(edge)]

    def graph(self) -> FlowGraph:
        whole = self.system.graph()
        denied = [Flow(a, b, "publish", (), tuple(map(deny, sorted(lines)))) for (a, b), lines in self.denied.items()]
        return replace(
            whole,
            flows=tuple(Flow(a, b, "publish") for a, b in self.edges),
            denied=tuple(f for f in denied if f.denials),
        )

    def bound(self) -> Bound:
        whole = self.system.bound()
        numbers = {edge: number for number, edge in enumerate(self.edges)}
        never = {i: self.system.edges[i] for i in whole.flows}
        lines = {
            i: tuple(s._replace(place=Place("labels.yaml", NEVER + i)) for s in said) for i, said in whole.flows.items()
        }
        flows = {numbers[edge]: lines[i] for i, edge in never.items() if edge in numbers}
        return replace(whole, flows=flows)

    def ledger(self) -> tuple[TakenAway, ...]:
        graph, bound, hierarchy = self.graph(), self.bound(), self.system.hierarchy
        return ledger(analyse(graph, bound, hierarchy), bound, hierarchy)

    def brute(self) -> Brute:
        brute = self.system.brute()
        return replace(brute, edges=self.edges)

    def lines(self) -> set[int]:
        """The lines that take something away."""
        said = {s.place.line for said in self.system.said.values() for s in said if s.role not in ADDS}
        return said.union(*self.denied.values(), {NEVER + i for i in self.system.never})

    def without(self, line: int) -> Stated:
        said = {v: [s for s in said if s.place.line != line] for v, said in self.system.said.items()}
        denied = {edge: lines - {line} for edge, lines in self.denied.items()}
        never = {i: names for i, names in self.system.never.items() if NEVER + i != line}
        return Stated(replace(self.system, said=said, never=never), denied)


def deny(line: int) -> Grant:
    return Grant(False, "publish", "topic", "/t", "/e", "/n", Place("policy.xml", line))


@st.composite
def stated(draw: st.DrawFn) -> Stated:
    """Some lines are about several elements, as a glob is; some flows are denied, by one line or two."""
    system = draw(systems())
    said: dict[int, list[Statement]] = {}
    line = 0
    for vertex, statements in system.said.items():
        said[vertex] = []
        for one in statements:
            line += 1
            said[vertex].append(one._replace(place=Place("labels.yaml", line)))
    for _ in range(draw(st.integers(0, 2))):
        line += 1
        glob = draw(st.sampled_from(GLOBS))
        among = range(system.nodes) if glob.role == "sanitizer" else range(system.nodes, system.nodes + system.channels)
        for vertex in draw(st.sets(st.sampled_from(among), min_size=2)) if len(among) > 1 else ():
            said[vertex] = [glob._replace(place=Place("labels.yaml", line), naming=GLOB)]
    denied = {}
    for edge in draw(st.sets(st.sampled_from(system.edges), max_size=3)):
        if system.edges.index(edge) not in system.never:
            denied[edge] = {line + 1 + n for n in draw(st.sets(st.integers(0, 2), min_size=1, max_size=2))}
    return Stated(replace(system, said=said), denied)


GLOBS = [statement("mundane"), statement("never", "Any"), statement("only", "Loc"), statement("never", "Face")]
