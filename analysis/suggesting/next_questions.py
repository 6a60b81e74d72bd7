"""Proposals -> the questions that a person is asked, in review order: elements of which the same is asked together.

In: proposals in review order, and the answer that they belong to. Out: questions. Asked is what changes an answer: what
brings data in; what lets out data that gets there, or makes other data of them; and what is open (rule S11). Of that
nodes come before channels: a leak among them is known before anybody says that nothing goes through a channel.
"""

from __future__ import annotations

from collections import defaultdict
from math import ceil
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.alike_channels import alike
from rosprivacy.analysis.suggesting.evidence import (
    CONDUIT,
    DERIVATION,
    LEAK,
    NEVER,
    SANITIZER,
    SENSITIVE,
    SOURCE,
    Label,
)
from rosprivacy.analysis.suggesting.question_rows import (
    AT_MOST_ONE,
    BRINGS_IN,
    ENDS,
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    MAKES,
    MOST_ROWS,
    NOTHING,
    YES,
    Question,
    Reply,
    Row,
)
from rosprivacy.analysis.suggesting.unsaid import or_passes_on, said_of, spoken_of
from rosprivacy.analysis.suggesting.written import WrittenLabel, written
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Element
    from rosprivacy.analysis.suggesting.evidence import Proposal
    from rosprivacy.analysis.suggesting.traffic import Traffic

    Identity = tuple[str, str, str]
ONLY = "only"


def questions(
    proposals: Sequence[Proposal],
    analysis: Analysis,
    bound: Bound,
    told: Traffic,
    hierarchy: Hierarchy,
    refused: Callable[[Label], bool] = lambda _: False,
) -> tuple[Question, ...]:
    """Return what a person is asked next, in review order.

    Parameters
    ----------
    refused
        Whether a person has said no to a label.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> graph, bound, hierarchy = factory()
    >>> asked = [Label(graph.elements[CAMERA], "source", kind) for kind in ("FaceImage", "Voice")]
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1)) for label in asked]
    >>> (one,) = questions(proposals(said), analyse(graph, bound, hierarchy), bound, traffic(graph, bound), hierarchy)
    >>> one.about, [(row.element.name, row.kinds, [reply.key for reply in row.replies]) for row in one.rows]
    ('brings-in', [('/camera', ('FaceImage',), ['y']), ('/camera', ('Voice',), ['y'])])
    """
    asked = _Asked(proposals, analysis, bound, told, hierarchy, refused)
    ends = asked.ends()
    first = {row.element.identity for rows in ends.values() for row in rows}
    groups = [*ends.items(), *asked.unreviewed(first)]
    return tuple(Question(about, tuple(some)) for about, rows in groups for some in _parted(rows))


def one_line(finding: Finding) -> str:
    """Return what is told of a finding beside a question.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> one_line(analyse(*factory()).findings[0]).partition(" [")[0]
    'FaceTemplate: /camera -> /archive'
    """
    return f"{finding.category}: {finding.source.name} -> {finding.leak.name} [{finding.id}]"


def _parted(rows: Sequence[Row]) -> Iterator[Sequence[Row]]:
    return (rows[at : at + MOST_ROWS] for at in range(0, len(rows), MOST_ROWS))


class _Asked:
    """One answer and what is proposed of its elements."""

    def __init__(
        self,
        proposals: Sequence[Proposal],
        analysis: Analysis,
        bound: Bound,
        told: Traffic,
        hierarchy: Hierarchy,
        refused: Callable[[Label], bool],
    ) -> None:
        self.refused = refused
        self.proposals, self.analysis, self.told, self.hierarchy = proposals, analysis, told, hierarchy
        self.said = said_of(analysis.graph, bound)
        self.of: dict[Identity, list[Proposal]] = defaultdict(list)
        for one in proposals:
            self.of[one.label.element.identity].append(one)
        self.reached = reached_kinds(analysis)
        self.known: dict[tuple[str, ...], tuple[str, ...]] = {}  # what is told of findings of such data
        self.writes = {analysis.graph.elements[vertex].identity for vertex, there in told.writes.items() if there}

    def ends(self) -> dict[str, list[Row]]:
        """Return what may bring data in; what may let out, or make other data of, what gets to it."""
        return {
            BRINGS_IN: [_row(one) for one in self.proposals if one.label.role == SOURCE],
            LETS_OUT: [row for there in self.of.values() if (row := self._lets_out(there))],
            MAKES: [_row(one) for one in self.proposals if one.label.role == DERIVATION and self._gets(one)],
        }

    def _gets(self, one: Proposal) -> bool:
        there = self.reached.get(one.label.element.identity, ())
        return any(self.hierarchy.overlap(one.label.kind, kind) is not None for kind in there)

    def _lets_out(self, there: Sequence[Proposal]) -> Row | None:
        """One element that may let out what gets to it: the kinds that are known to, and nobody has spoken of."""
        leaks = [one for one in there if one.label.role == LEAK and not or_passes_on(one, there)]
        if not leaks:
            return None
        element = leaks[0].label.element
        reached = self.reached.get(element.identity, ())
        asked = {kind for one in leaks for kind in narrowed(one.label.kind, reached, self.hierarchy)}
        said = self.said.get(element.identity, ())
        labels = [Label(element, LEAK, kind) for kind in sorted(asked)]
        labels = [one for one in labels if not (spoken_of(one, said, self.hierarchy) or self.refused(one))]
        return _leak(labels, _reasons(leaks)) if labels else None

    def unreviewed(self, first: Collection[Identity]) -> Iterator[tuple[str, list[Row]]]:
        """Yield open elements, whatever data reach them: nodes, as many as one question has room for, and channels.

        Of nodes those come first that data reach first; those behind have the room that these leave. Of the elements of
        ``first`` something else is asked before.
        """
        by_element: dict[Identity, OpenQuestion] = {}
        for one in self.analysis.open:
            old = by_element.get(one.element.identity)
            kinds = tuple(sorted({*one.categories, *(old.categories if old else ())}))
            by_element[one.element.identity] = one._replace(categories=kinds)
        asked = [(by_element[one], there) for one, there in self.of.items() if one in by_element and one not in first]
        nodes: dict[tuple[bool, bool], list[Row]] = defaultdict(list)
        near: dict[tuple[bool, bool], int] = defaultdict(int)
        for one, there in asked:  # in review order
            about = [each for each in there if each.label.role in (CONDUIT, SANITIZER)]
            kinds = tuple(kind for kind in one.categories if any(self._speaks_of(each, kind) for each in about))
            if one.element.is_node and kinds:
                on = one.element.identity in self.writes
                row = self._node(there[0].label.element, kinds, about, on=on)
                likeness = on, row.reply(NOTHING) is not None
                nodes[likeness].append(row)
                near[likeness] += one.frontier
        for likeness, rows in nodes.items():
            on, _ = likeness
            yield GOES_ON if on else ENDS, rows[: MOST_ROWS * max(1, ceil(near[likeness] / MOST_ROWS))]
        channels = [(one, there) for one, there in asked if one.element.is_channel]
        numbered = sorted({kind for one, _ in channels for kind in one.categories})
        yield GOES_THROUGH, [self._channel(one, there, numbered) for one, there in channels]

    def _speaks_of(self, one: Proposal, kind: str) -> bool:
        return not one.label.kind or self.hierarchy.overlap(one.label.kind, kind) is not None

    def _channel(self, asked: OpenQuestion, there: Sequence[Proposal], numbered: Sequence[str]) -> Row:
        """One open channel.

        Parameters
        ----------
        numbered
            The kinds of which a digit says *this kind at most*, of all rows the same one.
        """
        about = [one for one in there if one.label.role in (SENSITIVE, NEVER)]
        return self._through(there[0].label.element, asked.categories, about, numbered)

    def _through(
        self, element: Element, kinds: tuple[str, ...], about: Sequence[Proposal], numbered: Sequence[str]
    ) -> Row:
        replies = [Reply(YES, _written(element, SENSITIVE, kinds))]
        each: list[Row] = []
        if len(kinds) > 1:
            for key, kind in zip(AT_MOST_ONE, numbered, strict=False):
                if kind in kinds:
                    replies.append(Reply(key, _written(element, ONLY, [kind]), takes_away=True))
            each = [
                self._through(element, (kind,), self._about(about, kind), ())._replace(alike=frozenset())
                for kind in kinds
            ]
        replies.append(Reply(NOTHING, _written(element, NEVER, kinds), takes_away=True))
        reasons, closed, likeness = _reasons(about), self._closed(kinds), alike(kinds, about)
        return Row(element, kinds, tuple(replies), reasons, closes=closed, alike=likeness, each=tuple(each))

    def _node(self, element: Element, kinds: tuple[str, ...], about: Sequence[Proposal], *, on: bool) -> Row:
        passes, out = _written(element, CONDUIT, kinds), _written(element, LEAK, kinds)
        ends = [one for one in about if one.label.role == SANITIZER]
        replies = [Reply("1", out), Reply("2", passes)] if ends or not on else [Reply(YES, passes), Reply("1", out)]
        if len(ends) == 1:
            replies.append(Reply(NOTHING, written(ends[0].label), takes_away=True))
        refused = tuple(_written(element, CONDUIT, [kind]) for kind in kinds)
        refused += tuple(written(one.label) for one in ends)
        each = [self._node(element, (kind,), self._about(about, kind), on=on) for kind in kinds if len(kinds) > 1]
        closed = self._closed(kinds) if ends else ()
        return Row(element, kinds, tuple(replies), _reasons(about), refused, closed, each=tuple(each))

    def _about(self, said: Iterable[Proposal], kind: str) -> list[Proposal]:
        return [one for one in said if self._speaks_of(one, kind)]

    def _closed(self, kinds: tuple[str, ...]) -> tuple[str, ...]:
        """Findings of such data."""
        if kinds not in self.known:
            self.known[kinds] = tuple(
                one_line(one)
                for one in self.analysis.findings
                if not one.accepted and any(self.hierarchy.overlap(one.category, kind) is not None for kind in kinds)
            )
        return self.known[kinds]


def _row(one: Proposal) -> Row:
    label = written(one.label)
    return Row(one.label.element, (one.label.kind,), (Reply(YES, label),), _reasons([one]), (label,))


def _leak(labels: Sequence[Label], reasons: tuple[str, ...]) -> Row:
    """What may be let out; a no is of what is asked, and not of the broader kind that is suggested."""
    element, kinds = labels[0].element, tuple(one.kind for one in labels)
    each = [_leak([one], reasons) for one in labels if len(labels) > 1]
    reply = Reply(YES, _written(element, LEAK, kinds))
    return Row(element, kinds, (reply,), reasons, tuple(map(written, labels)), each=tuple(each))


def _written(element: Element, role: str, kinds: Sequence[str]) -> WrittenLabel:
    return WrittenLabel(f"{element.kind}s", literal(element.name), {role: list(kinds)})


def _reasons(about: Iterable[Proposal]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(reason.reason for one in about for reason in one.evidence))


def reached_kinds(analysis: Analysis) -> dict[Identity, tuple[str, ...]]:
    """Return by element the kinds of data that get there, pseudonymised ones too.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> [kinds for (_, _, name), kinds in reached_kinds(analyse(*factory())).items() if name == "/faces"]
    [('FaceTemplate',)]
    """
    found: dict[Identity, set[str]] = defaultdict(set)
    for one in analysis.carried:
        found[one.element.identity].update((*one.categories, *one.pseudonymised))
    return {identity: tuple(sorted(kinds)) for identity, kinds in found.items()}


def narrowed(kind: str, reached: Iterable[str], hierarchy: Hierarchy) -> frozenset[str]:
    """Return what of a kind gets somewhere: the narrower kinds that do, or the kind itself where broader ones do.

    >>> from rosprivacy.analysis.example import factory
    >>> hierarchy = factory()[2]
    >>> sorted(narrowed("Biometric", ["FaceTemplate", "Voice"], hierarchy)), sorted(narrowed("Voice", [], hierarchy))
    (['FaceTemplate'], [])
    """
    there = [one for one in reached if hierarchy.overlap(kind, one) is not None]
    return frozenset(one if kind in hierarchy.ancestors[one] else kind for one in there)
