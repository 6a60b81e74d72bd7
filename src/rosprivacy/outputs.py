"""What an answer gives beside its formats: findings as a table, a networkx graph, why data does not get there.

In: an answer. Out: a sequence of ``Finding``, rows for data frames, HTML for notebooks in which every text is escaped;
a ``MultiDiGraph`` whose vertices are ``Element`` objects, in the order of the analysed graph; ``WhyNot``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, overload

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.text import fit
from rosprivacy.analysis.whatif.why_not import why_not
from rosprivacy.analysis.written_names import A_LITTLE, FEW, bare_name, did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Any

    import networkx as nx

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.whatif.why_not import WhyNot
    from rosprivacy.ontology.vocabulary import Vocabulary

COLUMNS = ("id", "kind", "category", "source", "leak", "pseudonymised", "dismissed", "accepted")
BOUND = 60  # rows that a notebook shows


@dataclass(frozen=True, slots=True, repr=False)
class Findings(Sequence["Finding"]):
    """Findings in their order, dismissed and accepted ones too; of a fleet one of each pattern.

    Attributes
    ----------
    verdict
        Says the line of the verdict.
    """

    findings: tuple[Finding, ...]
    fleet: FleetView | None
    verdict: Callable[[], str]

    @overload
    def __getitem__(self, index: int) -> Finding: ...
    @overload
    def __getitem__(self, index: slice) -> Findings: ...
    def __getitem__(self, index: int | slice) -> Finding | Findings:
        found = self.findings[index]
        return Findings(found, self.fleet, self.verdict) if isinstance(found, tuple) else found

    def __len__(self) -> int:
        return len(self.findings)

    def __repr__(self) -> str:
        return f"<Findings: {len(self)}; {self.verdict()}>"

    def to_rows(self) -> list[dict[str, Any]]:
        """Return a plain dict for each finding, for ``pandas.DataFrame`` and ``polars.DataFrame``.

        Of a fleet each says for how many ``findings`` it stands, and on which ``robots``.
        """
        patterns = {pattern.finding.id: pattern for pattern in self.fleet.patterns} if self.fleet else {}
        rows = []
        for finding in self.findings:
            row = _row(finding)
            if self.fleet:
                pattern = patterns[finding.id]
                row |= {"findings": pattern.count, "robots": list(pattern.robots)}
            rows.append(row)
        return rows

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        rows = self.to_rows()
        columns = [*COLUMNS, *(["findings"] if self.fleet else [])]
        head = "".join(f"<th>{column}</th>" for column in columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_cell(row[column]))}</td>" for column in columns) + "</tr>"
            for row in rows[:BOUND]
        )
        more = f"<p>{len(rows) - BOUND} more findings</p>" if len(rows) > BOUND else ""
        caption = f"<caption>{escape(self.verdict())}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _cell(value: object) -> str:
    return ("yes" if value else "") if isinstance(value, bool) else fit(str(value))


def _row(finding: Finding) -> dict[str, Any]:
    return {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": finding.source.full_name,
        "leak": finding.leak.full_name,
        "path": [element.full_name for element in finding.witness],
        "lines": [str(grant.place) for step in finding.steps for grant in step.grants],
        "disjoint_paths": finding.number_of_paths,
        "through": [element.full_name for element in finding.through],
        "dismissed": finding.dismissed,
        "accepted": finding.accepted,
        "reason": finding.reason,
    }


def to_networkx(analysis: Analysis) -> nx.MultiDiGraph[Element]:
    """Return the graph of an analysis; a flow's key is its role. What a DENY takes away is not in it (rule S5)."""
    import networkx as nx  # noqa: PLC0415 - only where it is used

    graph, found = analysis.graph, analysis.spread
    asked = sum(found.forms_of(category) for category in analysis.emitted)
    network: nx.MultiDiGraph[Element] = nx.MultiDiGraph(view=graph.view, verdict=str(analysis.verdict))
    for vertex, element in enumerate(graph.elements):
        plain, pseudonymised = found.planes(found.present(vertex) & asked)
        network.add_node(
            element,
            kind=element.kind,
            name=element.name,
            robot=element.robot,
            leg=element.leg,
            carries=plain,
            pseudonymised=pseudonymised,
            roles=dict(analysis.roles.get(element, {})),
        )
    for index, flow in enumerate(graph.flows):
        plain, pseudonymised = found.planes(found.along(index) & asked)
        network.add_edge(
            graph.elements[flow.source],
            graph.elements[flow.target],
            flow.role,
            carries=plain,
            pseudonymised=pseudonymised,
            lines=tuple(str(grant.place) for grant in flow.grants),
        )
    return network


def explained(
    analysis: Analysis, vocabulary: Vocabulary, source: str, leak: str, categories: Iterable[str] = ()
) -> tuple[WhyNot, ...]:
    """Return for each category what is between two elements.

    Parameters
    ----------
    source, leak
        Names; of a fleet ``robot:name``.
    categories
        To ask about; empty for what the source emits, or for all if it emits nothing.

    Raises
    ------
    InputError
        If nothing is called so, or nothing emits the category.
    """
    found = analysis.spread
    ends = [vertices_called(analysis, name) for name in (source, leak)]
    names = [category.name if (category := vocabulary.find(name)) else name for name in categories]
    unknown = [name for name in names if name not in found.categories]
    if unknown:
        emitted = ", ".join(found.categories) or "none"
        raise InputError("-c", 0, f"no source or derivation emits {shown(unknown[0])!r}", f"emitted are: {emitted}")
    if not found.categories:
        raise InputError(
            "labels", 0, "no label names a source", "say where data comes in: nodes: {/x: {source: [Video]}}"
        )
    begun = [name for name in found.categories if any(found.begins(v) & found.forms_of(name) for v in ends[0])]
    return tuple(why_not(analysis, ends[0], ends[1], name) for name in names or begun or found.categories)


def vertices_called(analysis: Analysis, written: str, name: str = "why-not") -> list[int]:
    """Return the vertices that a name means; a node before a channel of the same name.

    Parameters
    ----------
    name
        By which a message calls what the name was given to.

    Raises
    ------
    InputError
        If nothing is called so.
    """
    known: dict[str, list[int]] = {}
    elements = analysis.graph.elements
    for vertex, element in enumerate(elements):
        known.setdefault(element.full_name, []).append(vertex)
    if bare_name(written) not in known:
        close = nearest(written, known, FEW, A_LITTLE)
        hint = did_you_mean(close, "see the names with rosprivacy labels --init")
        raise InputError(name, 0, f"no element is called {shown(written)!r}", hint)
    found = known[bare_name(written)]
    return [vertex for vertex in found if not elements[vertex].is_channel] or found
