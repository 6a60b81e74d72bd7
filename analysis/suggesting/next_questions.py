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
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    MAKES,
    MOST_ROWS,
    NOTHING,
    OUT,
    PASSES,
    YES,
    Question,
    Reply,
    Row,
)
from rosprivacy.analysis.suggesting.reached_kinds import narrowed, reached_kinds
from rosprivacy.analysis.suggesting.unsaid import or_passes_on, said_of, spoken_of
from rosprivacy.analysis.suggesting.written import WrittenLabel, written
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

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
    groups = [*asked.ends().items(), (GOES_ON, asked.nodes()), (GOES_THROUGH, asked.channels())]
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
        self.open: dict[Identity, OpenQuestion] = {}
        for asked in analysis.open:
            old = self.open.get(asked.element.identity)
            kinds = tuple(sorted({*asked.categories, *(old.categories if old else ())}))
            self.open[asked.element.identity] = asked._replace(categories=kinds)
        self.reached = reached_kinds(analysis)
        self.derived = {
            (one.to, one.categories) for there in bound.elements.values() for one in there if one.role == DERIVATION
        }
        self.known: dict[tuple[str, ...], tuple[str, ...]] = {}  # what is told of findings of such data
        self.writes = {analysis.graph.elements[vertex].identity for vertex, there in told.writes.items() if there}

    def ends(self) -> dict[str, list[Row]]:
        """Return what may bring data in; what may let out, or make other data of, what gets to it.

        An open node that may let data out is asked what it does with them.
        """
        return {
            BRINGS_IN: [_row(one) for one in self.proposals if one.label.role == SOURCE],
            LETS_OUT: [row for there in self.of.values() if (row := self._lets_out(there))],
            MAKES: [_row(one) for one in self.proposals if one.label.role == DERIVATION and self._gets(one)],
        }

    def _gets(self, one: Proposal) -> bool:
        there = self.reached.get(one.label.element.identity, ())
        return any(self.hierarchy.overlap(one.label.kind, kind) is not None for kind in there)

    def _lets_out(self, there: Sequence[Proposal]) -> Row | None:
        leaks = _leaks(there)
        asked_as_open = self._open_kinds(there)
        labels = [one for one in self._unsaid(leaks) if one.kind not in asked_as_open]
        return _leak(labels, _reasons(leaks)) if labels else None

    def _unsaid(self, leaks: Sequence[Proposal]) -> list[Label]:
        """What one element may let out of what is known to get there, where nobody has spoken of it."""
        if not leaks:
            return []
        element = leaks[0].label.element
        reached, said = self.reached.get(element.identity, ()), self.said.get(element.identity, ())
        asked = {kind for one in leaks for kind in narrowed(one.label.kind, reached, self.hierarchy)}
        labels = [Label(element, LEAK, kind) for kind in sorted(asked)]
        return [one for one in labels if not (spoken_of(one, said, self.hierarchy) or self.refused(one))]

    def _open_kinds(self, there: Sequence[Proposal]) -> tuple[str, ...]:
        """The kinds of data for which a node is open, and of which it can be asked what it does with them."""
        asked = self.open.get(there[0].label.element.identity)
        if asked is None or not asked.element.is_node:
            return ()
        about = [one for one in there if one.label.role in (CONDUIT, SANITIZER)]
        out = {one.kind for one in self._unsaid(_leaks(there))}
        return tuple(
            kind for kind in asked.categories if kind in out or any(self._speaks_of(one, kind) for one in about)
        )

    def nodes(self) -> list[Row]:
        """Return open nodes, as many as one question has room for, or all that are asked first.

        First are those that may let data out, and those that data reach first; those behind have the room that is left.
        """
        rows, first = [], 0
        for identity, there in self.of.items():  # in review order
            if kinds := self._open_kinds(there):
                row = self._node(there, kinds)
                rows.append(row)
                first += self.open[identity].frontier or _suspected(row)
        rows.sort(key=lambda row: not _suspected(row))
        return rows[: MOST_ROWS * max(1, ceil(first / MOST_ROWS))]

    def channels(self) -> list[Row]:
        """Return open channels."""
        asked = [(self.open[one], there) for one, there in self.of.items() if one in self.open]
        channels = [(one, there) for one, there in asked if one.element.is_channel]
        numbered = sorted({kind for one, _ in channels for kind in one.categories})
        return [self._channel(one, there, numbered) for one, there in channels]

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
        reasons, closed, likeness = _reasons(about), self._closed(kinds), alike(kinds, about)
        replies = [Reply(YES, _written(element, SENSITIVE, kinds), reasons=reasons)]
        each: list[Row] = []
        if len(kinds) > 1:
            for key, kind in zip(AT_MOST_ONE, () if self._carries(element) else numbered, strict=False):
                if kind in kinds:
                    replies.append(Reply(key, _written(element, ONLY, [kind]), takes_away=True))
            each = [
                self._through(element, (kind,), self._about(about, kind), ())._replace(alike=frozenset())
                for kind in kinds
            ]
        why = reasons if likeness else ()  # else they may say the opposite
        replies.append(Reply(NOTHING, _written(element, NEVER, kinds), takes_away=True, reasons=why))
        return Row(element, kinds, tuple(replies), reasons, closes=closed, alike=likeness, each=tuple(each))

    def _carries(self, element: Element) -> bool:
        """Whether a person says what goes through a channel: that one kind at most does would take that away (S7)."""
        return any(one.role == SENSITIVE for one in self.said.get(element.identity, ()))

    def _node(self, there: Sequence[Proposal], kinds: tuple[str, ...]) -> Row:
        element = there[0].label.element
        about = [one for kind in kinds for one in self._about(there, kind) if one.label.role in (CONDUIT, SANITIZER)]
        ends = list(dict.fromkeys(one for one in about if one.label.role == SANITIZER))
        leaks = [one for one in _leaks(there) if any(self._speaks_of(one, kind) for kind in kinds)]
        out = [one for one in self._unsaid(leaks) if one.kind in kinds]
        why = _reasons(leaks) if out else ()
        doubtful = bool(why or ends) or element.identity not in self.writes
        passes = () if doubtful else _reasons(about)
        replies = [
            Reply(OUT, _written(element, LEAK, kinds), reasons=why),
            Reply(PASSES, _written(element, CONDUIT, kinds), reasons=passes),
        ]
        if len(ends) == 1:
            replies.append(Reply(NOTHING, written(ends[0].label), takes_away=True, reasons=_reasons(ends)))
        refused = tuple(_written(element, CONDUIT, [kind]) for kind in kinds)
        refused += tuple(map(written, (*(one.label for one in ends), *out)))
        each = tuple(self._node(there, (kind,)) for kind in kinds if len(kinds) > 1)
        closed = self._closed(kinds) if ends else ()
        reasons = tuple(dict.fromkeys((*why, *_reasons(about))))
        return Row(element, kinds, tuple(replies), reasons, refused, closed, doubtful=doubtful, each=each)

    def _about(self, said: Iterable[Proposal], kind: str) -> list[Proposal]:
        return [one for one in said if self._speaks_of(one, kind)]

    def _closed(self, kinds: tuple[str, ...]) -> tuple[str, ...]:
        """Findings of such data, and of what is made of them."""
        if kinds not in self.known:
            made = self._made_of(kinds)
            self.known[kinds] = tuple(
                one_line(one)
                for one in self.analysis.findings
                if not one.accepted and self._overlaps(one.category, made)
            )
        return self.known[kinds]

    def _made_of(self, kinds: Iterable[str]) -> set[str]:
        """Kinds of data, and all that nodes make of them."""
        made, size = set(kinds), 0
        while size < len(made):
            size = len(made)
            made |= {to for to, of in self.derived for kind in of if to not in made and self._overlaps(kind, made)}
        return made

    def _overlaps(self, kind: str, kinds: Iterable[str]) -> bool:
        return any(self.hierarchy.overlap(kind, one) is not None for one in kinds)


def _row(one: Proposal) -> Row:
    label = written(one.label)
    why = _reasons([one])
    return Row(one.label.element, (one.label.kind,), (Reply(YES, label, reasons=why),), why, (label,))


def _suspected(row: Row) -> bool:
    """Whether something suggests that an open node lets data out."""
    return any(one.key == OUT and one.reasons for one in row.replies)


def _leaks(there: Iterable[Proposal]) -> list[Proposal]:
    """What suggests that one element lets data out; that it is an end of data does not."""
    return [one for one in there if one.label.role == LEAK and not or_passes_on(one, there)]


def _leak(labels: Sequence[Label], reasons: tuple[str, ...]) -> Row:
    """What may be let out; a no is of what is asked, and not of the broader kind that is suggested."""
    element, kinds = labels[0].element, tuple(one.kind for one in labels)
    each = [_leak([one], reasons) for one in labels if len(labels) > 1]
    reply = Reply(YES, _written(element, LEAK, kinds), reasons=reasons)
    return Row(element, kinds, (reply,), reasons, tuple(map(written, labels)), each=tuple(each))


def _written(element: Element, role: str, kinds: Sequence[str]) -> WrittenLabel:
    return WrittenLabel(f"{element.kind}s", literal(element.name), {role: list(kinds)})


def _reasons(about: Iterable[Proposal]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(reason.reason for one in about for reason in one.evidence))
