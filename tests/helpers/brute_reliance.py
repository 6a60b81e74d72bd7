"""What the answer hangs on, by brute force: the analysis without each statement, beside that with it (S7, S8, S10)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.model import NOWHERE
from rosprivacy.analysis.whatif.spots import BRINGS_IN

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Bound, FlowGraph, Statement

Standing = dict[tuple[str, ...], tuple[bool, bool]]
StatementKey = tuple[Any, ...]


def answered(analysis: Analysis) -> tuple[Standing, set[tuple[Any, str]]]:
    """Finding that nobody accepted -> (it stands, plain data is in it), with what stands beside it; open questions."""
    found: dict[Any, tuple[bool, bool]] = {}
    beside = {f.id: f for f in analysis.findings if f.plain_also}
    also = {(f.kind, f.category, f.source, f.leak) for f in beside.values()}
    for f in analysis.findings:
        key = (f.kind, f.category, f.source, f.leak)
        if not f.plain_also and not f.accepted:
            found[key] = (f.stands, not f.pseudonymised or key in also)
    return found, {(q.element.shown_as, c) for q in analysis.open for c in q.categories}


def statement_key(statement: Statement, graph: FlowGraph, *ends: int) -> StatementKey:
    """A glob is one statement with all that it is about; a name is one for each name."""
    return (statement, *(() if statement.glob else (graph.elements[v].name for v in ends)))


def without(graph: FlowGraph, bound: Bound, lost: StatementKey) -> Bound:
    ends = [(flow.source, flow.target) for flow in graph.flows]

    def others(rows: tuple[Statement, ...], *at: int) -> tuple[Statement, ...]:
        return tuple(row for row in rows if statement_key(row, graph, *at) != lost)

    return replace(
        bound,
        elements={v: others(rows, v) for v, rows in bound.elements.items()},
        flows={i: others(rows, *ends[i]) for i, rows in bound.flows.items()},
    )


def reliance_by_brute_force(graph: Any, bound: Bound, hierarchy: Any, options: Options) -> dict[StatementKey, Any]:
    """Statement -> what comes about without it; None where the labels contradict each other then."""
    before, asked = answered(analyse(graph, bound, hierarchy, options))
    result: dict[StatementKey, Any] = {}
    at = [((v,), said) for v, said in bound.elements.items()]
    along = [((graph.flows[i].source, graph.flows[i].target), said) for i, said in bound.flows.items()]
    for ends, said in (*at, *along):
        for statement in said:
            if statement.role in BRINGS_IN or statement.place == NOWHERE:
                continue
            key = statement_key(statement, graph, *ends)
            try:
                after, questions = answered(analyse(graph, without(graph, bound, key), hierarchy, options))
            except InputErrors:
                result[key] = None
                continue
            worse = {
                key: state
                for key, state in after.items()
                if key not in before or any(now and not then for now, then in zip(state, before[key], strict=True))
            }
            result[key] = (worse, questions - asked)
    return result
