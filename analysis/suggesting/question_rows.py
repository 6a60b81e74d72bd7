"""Proposals -> the questions that a person is asked: by element, and elements that are alike together.

In: proposals in review order, and the answer that they belong to. Out: ``Question``: rows that one answer can be given
to. Asked is what changes an answer: what brings data in; what lets out data that gets there, or makes other data of
them; and what is open (rule S11), of nodes first those that data reaches first.

An answer that takes data away is for one row alone, which the person has picked or opened: never for a group. The one
exception are open channels of which the same rule says that they are made for other things: ``NOTHING_THROUGH``.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

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
from rosprivacy.analysis.suggesting.unsaid import or_passes_on, said_of, spoken_of
from rosprivacy.analysis.suggesting.written import WrittenLabel, written
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Element
    from rosprivacy.analysis.suggesting.alike_channels import Alike
    from rosprivacy.analysis.suggesting.evidence import Proposal
    from rosprivacy.analysis.suggesting.traffic import Traffic

    Identity = tuple[str, str, str]
    Reasons = Mapping[Identity, Sequence[Proposal]]

BRINGS_IN, LETS_OUT, MAKES, GOES_ON, ENDS, GOES_THROUGH = "brings-in", "lets-out", "makes", "goes-on", "ends", "through"
NOTHING_THROUGH = "nothing-through"
YES, AT_MOST_ONE, NOTHING = "y", "123456789", "0"
MOST_ROWS = 26  # a letter for each, and no more than a person reads
ONLY = "only"


class Reply(NamedTuple):
    """What can be said of one row.

    Attributes
    ----------
    key
        The sign that says it.
    label
        What is then written.
    takes_away
        Whether it says that data do not go on: it is for one row alone.
    """

    key: str
    label: WrittenLabel
    takes_away: bool = False


class Row(NamedTuple):
    """One element, and what can be said of it.

    Attributes
    ----------
    kinds
        The data that it is about.
    replies
        By key; of all rows of a question the same keys, and words that say the same.
    refused
        What is remembered if a person says no.
    closes
        Findings of such data: a reply that takes them away may close these.
    alike
        Of an open channel: what it shares with others of which nothing of it can be said together; empty if it is for
        itself.
    """

    element: Element
    kinds: tuple[str, ...]
    replies: tuple[Reply, ...]
    reasons: tuple[str, ...]
    refused: tuple[WrittenLabel, ...] = ()
    closes: tuple[str, ...] = ()
    alike: Alike = frozenset()

    def reply(self, key: str) -> Reply | None:
        """Return what a key says; None if it says nothing here."""
        return next((one for one in self.replies if one.key == key), None)


class Question(NamedTuple):
    """Rows that are alike.

    Attributes
    ----------
    about
        ``BRINGS_IN``, ``LETS_OUT``, ``MAKES``: what a node does. ``GOES_ON``: open nodes that write something.
        ``ENDS``: open nodes from which no policy lets data go on. ``GOES_THROUGH``: open channels. ``NOTHING_THROUGH``:
        several of these that are alike, of which a person says that nothing of it goes through any.
    """

    about: str
    rows: tuple[Row, ...]

    def keys(self) -> tuple[str, ...]:
        """Return the keys that say something of all rows; of several none that takes data away.

        Of a list none: it is confirmed by its number of rows (``Conversation``).
        """
        if self.about == NOTHING_THROUGH:
            return ()
        return tuple(one.key for one in self.rows[0].replies if len(self.rows) == 1 or not one.takes_away)


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
        kinds = [one.kind for one in labels]
        if not kinds:
            return None
        reply = Reply(YES, _written(element, LEAK, kinds))
        refused = tuple(map(written, labels))  # of what is asked, and not of the broader kind that is suggested
        return Row(element, tuple(kinds), (reply,), _reasons(leaks), refused)

    def unreviewed(self, first: Collection[Identity]) -> Iterator[tuple[str, list[Row]]]:
        """Yield open elements: nodes that data reaches first and channels; and if there are none, the nodes behind.

        Of the elements of ``first`` something else is asked before.
        """
        by_element: dict[Identity, OpenQuestion] = {}
        for one in self.analysis.open:
            old = by_element.get(one.element.identity)
            kinds = tuple(sorted({*one.categories, *(old.categories if old else ())}))
            by_element[one.element.identity] = one._replace(categories=kinds)
        for near in (True, False):
            groups: dict[object, tuple[str, list[Row]]] = {}
            for identity, there in self.of.items():  # in review order
                asked = by_element.get(identity)
                now = asked and (asked.frontier or asked.element.is_channel or not near)
                for likeness, about, row in (
                    self._of_open(asked, there) if asked and now and identity not in first else ()
                ):
                    groups.setdefault(likeness, (about, []))[1].append(row)
            if groups:
                yield from groups.values()
                return

    def _of_open(self, asked: OpenQuestion, there: Sequence[Proposal]) -> Iterator[tuple[object, str, Row]]:
        if asked.element.is_channel:
            about = [one for one in there if one.label.role in (SENSITIVE, NEVER)]
            row = self._channel(there[0].label.element, asked.categories, about)
            made_for_others = any(one.label.role == NEVER for one in about)
            yield (GOES_THROUGH, row.kinds, made_for_others), GOES_THROUGH, row
            return
        about = [one for one in there if one.label.role in (CONDUIT, SANITIZER)]
        kinds = tuple(k for k in asked.categories if any(self._speaks_of(one, k) for one in about))
        if kinds:
            on = asked.element.identity in self.writes
            row = self._node(there[0].label.element, kinds, about, on=on)
            keys = tuple(one.key for one in row.replies)
            yield (on, row.kinds, keys), GOES_ON if on else ENDS, row

    def _speaks_of(self, one: Proposal, kind: str) -> bool:
        return not one.label.kind or self.hierarchy.overlap(one.label.kind, kind) is not None

    def _channel(self, element: Element, kinds: tuple[str, ...], about: Sequence[Proposal]) -> Row:
        replies = [Reply(YES, _written(element, SENSITIVE, kinds))]
        if len(kinds) > 1:
            for key, kind in zip(AT_MOST_ONE, kinds, strict=False):
                replies.append(Reply(key, _written(element, ONLY, [kind]), takes_away=True))
        replies.append(Reply(NOTHING, _written(element, NEVER, kinds), takes_away=True))
        likeness = alike(kinds, about)
        return Row(element, kinds, tuple(replies), _reasons(about), closes=self._closed(kinds), alike=likeness)

    def _node(self, element: Element, kinds: tuple[str, ...], about: Sequence[Proposal], *, on: bool) -> Row:
        passes, out = _written(element, CONDUIT, kinds), _written(element, LEAK, kinds)
        ends = [one for one in about if one.label.role == SANITIZER]
        replies = [Reply("1", out), Reply("2", passes)] if ends or not on else [Reply(YES, passes), Reply("1", out)]
        if len(ends) == 1:
            replies.append(Reply(NOTHING, written(ends[0].label), takes_away=True))
        refused = tuple(_written(element, CONDUIT, [kind]) for kind in kinds)
        refused += tuple(written(one.label) for one in about if one.label.role == SANITIZER)
        return Row(element, kinds, tuple(replies), _reasons(about), refused, self._closed(kinds) if ends else ())

    def _closed(self, kinds: Collection[str]) -> tuple[str, ...]:
        """Findings of such data."""
        return tuple(
            one_line(one)
            for one in self.analysis.findings
            if not one.accepted and any(self.hierarchy.overlap(one.category, kind) is not None for kind in kinds)
        )


def _row(one: Proposal) -> Row:
    label = written(one.label)
    return Row(one.label.element, (one.label.kind,), (Reply(YES, label),), _reasons([one]), (label,))


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
