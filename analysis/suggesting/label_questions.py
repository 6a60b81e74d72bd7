"""Proposals -> the questions that a person is asked, in review order: elements of which the same is asked together.

Asked is what changes an answer: what brings data in; what lets out data that gets there, or makes other data of them;
and what is open (rule S11). Of that nodes come before channels: a leak among them is known before anybody says that
nothing goes through a channel.

An answer that takes data away is for one row alone, which the person has picked or opened: never for a group. The one
exception are lists of open channels, ``LISTED``: they are shown whole, and confirmed by their number of rows.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.evidence import (
    CONDUIT,
    DERIVATION,
    LEAK,
    NEVER,
    SANITIZER,
    SENSITIVE,
    SOURCE,
    SuggestedLabel,
    WrittenLabel,
    written,
)
from rosprivacy.analysis.suggesting.weighing import or_passes_on, said_of, spoken_of
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, Element
    from rosprivacy.analysis.suggesting.channels import Traffic
    from rosprivacy.analysis.suggesting.evidence import Identity, LabelProposal

BRINGS_IN, LETS_OUT, MAKES, GOES_ON, GOES_THROUGH = "brings-in", "lets-out", "makes", "goes-on", "through"
LISTED = "listed"
YES, AT_MOST_ONE, NOTHING = "y", "123456789", "0"
OUT, PASSES = "1", "2"  # of nodes
ONLY_KINDS = "only"
MOST_ROWS = 26  # a letter for each, and no more than a person reads
TYPED_AS = (  # in a conversation, where no question offers it; it takes nothing away
    "a label is typed as '/camera node source Video', '/screen node leak Video' or "
    "'/finder node derives Video FaceTemplate', and Enter"
)
Alike = frozenset[str]  # families


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
    reasons
        Why just this is proposed: they stand in the note.
    """

    key: str
    label: WrittenLabel
    takes_away: bool = False
    reasons: tuple[str, ...] = ()


class Row(NamedTuple):
    """One element, and what can be said of it.

    Attributes
    ----------
    kinds
        The data that it is about.
    replies
        By key. A key that several rows of a question have says the same of each, of its own kinds of data.
    refused
        What is remembered if a person says no.
    closes
        Findings of such data: a reply that takes them away may close these.
    alike
        Of an open channel: by which rules it is made for other things than its kinds, as others are, of which nothing
        of it can be said together; empty if it is for itself.
    doubtful
        Of an open node: something suggests that it lets data out or ends them, or no policy lets them go on. That it
        only passes on is said of it where it is picked, or alone.
    by_kind
        If it is about several kinds: a row for each of them.
    """

    element: Element
    kinds: tuple[str, ...]
    replies: tuple[Reply, ...]
    reasons: tuple[str, ...]
    refused: tuple[WrittenLabel, ...] = ()
    closes: tuple[str, ...] = ()
    alike: Alike = frozenset()
    doubtful: bool = False
    by_kind: tuple[Row, ...] = ()

    def reply(self, key: str) -> Reply | None:
        """Return what a key says; None if it says nothing here."""
        return next((one for one in self.replies if one.key == key), None)

    def saying(self, key: str) -> Row:
        """Return the row of which nothing can be said any more but what a key says."""
        return self._replace(replies=tuple(one for one in self.replies if one.key == key))


class LabelQuestion(NamedTuple):
    """Rows that are asked about together.

    Attributes
    ----------
    about
        ``BRINGS_IN``, ``LETS_OUT``, ``MAKES``: what a node does. ``GOES_ON``: open nodes, which let data out, or only
        pass them on. ``GOES_THROUGH``: open channels. ``LISTED``: several of these, of which one thing is said together
        that takes data away, and nothing else can be said.
    """

    about: str
    rows: tuple[Row, ...]

    def keys(self) -> tuple[str, ...]:
        """Return the keys that say something of all rows; of several none that takes data away; of a list none."""
        if self.about == LISTED:
            return ()
        first, *others = self.rows
        return tuple(
            one.key
            for one in first.replies
            if all(row.reply(one.key) for row in others) and not (others and one.takes_away)
        )


def questions(
    proposals: Sequence[LabelProposal],
    analysis: Analysis,
    bound: Bound,
    ends: Traffic,
    hierarchy: Hierarchy,
    refused: Callable[[SuggestedLabel], bool] = lambda _: False,
) -> tuple[LabelQuestion, ...]:
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
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> graph, bound, hierarchy = factory()
    >>> asked = [SuggestedLabel(graph.elements[CAMERA], "source", kind) for kind in ("FaceImage", "Voice")]
    >>> said = [Evidence(label, "name", Confidence.MAY, "a word", Place("names.yaml", 1)) for label in asked]
    >>> (one,) = questions(proposals(said), analyse(graph, bound, hierarchy), bound, traffic(graph, bound), hierarchy)
    >>> one.about, [(row.element.name, row.kinds, [reply.key for reply in row.replies]) for row in one.rows]
    ('brings-in', [('/camera', ('FaceImage',), ['y']), ('/camera', ('Voice',), ['y'])])
    """
    asked = _Asked(proposals, analysis, bound, ends, hierarchy, refused)
    groups = [*asked.ends().items(), (GOES_ON, asked.nodes()), (GOES_THROUGH, asked.channels())]
    return tuple(LabelQuestion(about, tuple(some)) for about, rows in groups for some in _parted(rows))


def one_line(finding: Finding) -> str:
    """Return what is told of a finding beside a question.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> one_line(analyse(*factory()).findings[0]).partition(" [")[0]
    'FaceTemplate: /camera -> /archive'
    """
    return f"{finding.category}: {finding.source.name} -> {finding.leak.name} [{finding.id}]"


def alike(kinds: Iterable[str], about: Sequence[LabelProposal]) -> Alike:
    """Return by which rules a channel is made for other things than any of the kinds; empty if it is not said of all.

    A name is no such rule, and neither are the neighbours: behind a channel of which nobody knows the type, or whose
    type can carry anything, a leak could hide.

    >>> from rosprivacy.analysis.model import Confidence, Element, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, SuggestedLabel
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> never = SuggestedLabel(Element("topic", "/spin"), "never", "Video")
    >>> reason = Evidence(never, "type", Confidence.MAY, "a reason", Place("types.yaml", 7), "types.yaml:7")
    >>> by_name = Evidence(never, "name", Confidence.MAY, "a word", Place("names.yaml", 2))
    >>> [sorted(alike(kinds, proposals([reason]))) for kinds in (["Video"], ["Video", "Voice"])]
    [['types.yaml:7'], []]
    >>> alike(["Video"], proposals([by_name]))
    frozenset()
    """
    families: set[str] = set()
    for kind in kinds if all(one.label.role == NEVER for one in about) else ():
        of_kind = {each.family for one in about if one.label.kind == kind for each in one.evidence if each.family}
        if not of_kind:
            return frozenset()
        families |= of_kind
    return frozenset(families)


def reached_kinds(analysis: Analysis) -> dict[Identity, tuple[str, ...]]:
    """Return by element the kinds of data that get there, pseudonymised ones too.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> [kinds for (_, _, name), kinds in reached_kinds(analyse(*factory())).items() if name == "/faces"]
    [('FaceTemplate',)]
    """
    joined = cache(lambda *some: tuple(sorted({kind for kinds in some for kind in kinds})))
    found: dict[Identity, tuple[str, ...]] = {}
    for one in analysis.carried:
        at = one.element.identity
        found[at] = joined(found.get(at, ()), one.categories, one.pseudonymised)
    return found


def narrowed(kind: str, reached: Iterable[str], hierarchy: Hierarchy) -> frozenset[str]:
    """Return what of a kind gets somewhere: the narrower kinds that do, or the kind itself where broader ones do.

    >>> from rosprivacy.analysis.example import factory
    >>> hierarchy = factory()[2]
    >>> sorted(narrowed("Biometric", ["FaceTemplate", "Voice"], hierarchy)), sorted(narrowed("Voice", [], hierarchy))
    (['FaceTemplate'], [])
    """
    near = [one for one in reached if hierarchy.overlap(kind, one) is not None]
    return frozenset(one if kind in hierarchy.ancestors[one] else kind for one in near)


def _parted(rows: Sequence[Row]) -> Iterator[Sequence[Row]]:
    return (rows[at : at + MOST_ROWS] for at in range(0, len(rows), MOST_ROWS))


class _Asked:
    """One answer and what is proposed of its elements."""

    def __init__(
        self,
        proposals: Sequence[LabelProposal],
        analysis: Analysis,
        bound: Bound,
        ends: Traffic,
        hierarchy: Hierarchy,
        refused: Callable[[SuggestedLabel], bool],
    ) -> None:
        self.refused = refused
        self.proposals, self.analysis, self.hierarchy = proposals, analysis, hierarchy
        self.statements = said_of(analysis.graph, bound)
        self.of: dict[Identity, list[LabelProposal]] = defaultdict(list)
        for one in proposals:
            self.of[one.label.element.identity].append(one)
        self.open: dict[Identity, OpenQuestion] = {}
        for asked in analysis.open:
            old = self.open.get(asked.element.identity)
            kinds = tuple(sorted({*asked.categories, *(old.categories if old else ())}))
            self.open[asked.element.identity] = asked._replace(categories=kinds)
        self.reached = reached_kinds(analysis)
        self.derived = {
            (one.to, one.categories) for said in bound.elements.values() for one in said if one.role == DERIVATION
        }
        self.findings: dict[tuple[str, ...], tuple[str, ...]] = {}  # what is told of findings of such data
        self.writes = {analysis.graph.elements[vertex].identity for vertex, channels in ends.writes.items() if channels}

    def ends(self) -> dict[str, list[Row]]:
        """Return what may bring data in; what may let out, or make other data of, what gets to it.

        An open node that may let data out is asked what it does with them.
        """
        return {
            BRINGS_IN: [_row(one) for one in self.proposals if one.label.role == SOURCE],
            LETS_OUT: [row for there in self.of.values() if (row := self._lets_out(there))],
            MAKES: [_row(one) for one in self.proposals if one.label.role == DERIVATION and self._gets(one)],
        }

    def _gets(self, proposal: LabelProposal) -> bool:
        there = self.reached.get(proposal.label.element.identity, ())
        return any(self.hierarchy.overlap(proposal.label.kind, kind) is not None for kind in there)

    def _lets_out(self, proposals: Sequence[LabelProposal]) -> Row | None:
        leaks = _leaks(proposals)
        asked_as_open = self._open_kinds(proposals)
        labels = [one for one in self._unsaid(leaks) if one.kind not in asked_as_open]
        return _leak(labels, _reasons(leaks)) if labels else None

    def _unsaid(self, leaks: Sequence[LabelProposal]) -> list[SuggestedLabel]:
        """What one element may let out of what is known to get there, where nobody has spoken of it."""
        if not leaks:
            return []
        element = leaks[0].label.element
        reached, said = self.reached.get(element.identity, ()), self.statements.get(element.identity, ())
        asked = {kind for one in leaks for kind in narrowed(one.label.kind, reached, self.hierarchy)}
        labels = [SuggestedLabel(element, LEAK, kind) for kind in sorted(asked)]
        return [one for one in labels if not (spoken_of(one, said, self.hierarchy) or self.refused(one))]

    def _open_kinds(self, proposals: Sequence[LabelProposal]) -> tuple[str, ...]:
        """The kinds of data for which a node is open, and of which it can be asked what it does with them."""
        asked = self.open.get(proposals[0].label.element.identity)
        if asked is None or not asked.element.is_node:
            return ()
        about = [one for one in proposals if one.label.role in (CONDUIT, SANITIZER)]
        out = {one.kind for one in self._unsaid(_leaks(proposals))}
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

    def _speaks_of(self, proposal: LabelProposal, kind: str) -> bool:
        return not proposal.label.kind or self.hierarchy.overlap(proposal.label.kind, kind) is not None

    def _channel(self, question: OpenQuestion, proposals: Sequence[LabelProposal], numbered: Sequence[str]) -> Row:
        """One open channel.

        Parameters
        ----------
        numbered
            The kinds of which a digit says *this kind at most*, of all rows the same one.
        """
        about = [one for one in proposals if one.label.role in (SENSITIVE, NEVER)]
        return self._through(proposals[0].label.element, question.categories, about, numbered)

    def _through(
        self, element: Element, kinds: tuple[str, ...], about: Sequence[LabelProposal], numbered: Sequence[str]
    ) -> Row:
        reasons, closed, likeness = _reasons(about), self._closed(kinds), alike(kinds, about)
        replies = [Reply(YES, _written(element, SENSITIVE, kinds), reasons=reasons)]
        each: list[Row] = []
        if len(kinds) > 1:
            for key, kind in zip(AT_MOST_ONE, () if self._carries(element) else numbered, strict=False):
                if kind in kinds:
                    replies.append(Reply(key, _written(element, ONLY_KINDS, [kind]), takes_away=True))
            each = [
                self._through(element, (kind,), self._about(about, kind), ())._replace(alike=frozenset())
                for kind in kinds
            ]
        why = reasons if likeness else ()  # else they may say the opposite
        replies.append(Reply(NOTHING, _written(element, NEVER, kinds), takes_away=True, reasons=why))
        return Row(element, kinds, tuple(replies), reasons, closes=closed, alike=likeness, by_kind=tuple(each))

    def _carries(self, element: Element) -> bool:
        """Whether a person says what goes through a channel: that one kind at most does would take that away (S7)."""
        return any(one.role == SENSITIVE for one in self.statements.get(element.identity, ()))

    def _node(self, proposals: Sequence[LabelProposal], kinds: tuple[str, ...]) -> Row:
        element = proposals[0].label.element
        about = [
            one for kind in kinds for one in self._about(proposals, kind) if one.label.role in (CONDUIT, SANITIZER)
        ]
        ends = list(dict.fromkeys(one for one in about if one.label.role == SANITIZER))
        leaks = [one for one in _leaks(proposals) if any(self._speaks_of(one, kind) for kind in kinds)]
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
        each = tuple(self._node(proposals, (kind,)) for kind in kinds if len(kinds) > 1)
        closed = self._closed(kinds) if ends else ()
        reasons = tuple(dict.fromkeys((*why, *_reasons(about))))
        return Row(element, kinds, tuple(replies), reasons, refused, closed, doubtful=doubtful, by_kind=each)

    def _about(self, proposals: Iterable[LabelProposal], kind: str) -> list[LabelProposal]:
        return [one for one in proposals if self._speaks_of(one, kind)]

    def _closed(self, kinds: tuple[str, ...]) -> tuple[str, ...]:
        """Findings of such data, and of what is made of them."""
        if kinds not in self.findings:
            made = self._made_of(kinds)
            self.findings[kinds] = tuple(
                one_line(one)
                for one in self.analysis.findings
                if not one.accepted and self._overlaps(one.category, made)
            )
        return self.findings[kinds]

    def _made_of(self, kinds: Iterable[str]) -> set[str]:
        """Kinds of data, and all that nodes make of them."""
        made, size = set(kinds), 0
        while size < len(made):
            size = len(made)
            made |= {to for to, of in self.derived for kind in of if to not in made and self._overlaps(kind, made)}
        return made

    def _overlaps(self, kind: str, kinds: Iterable[str]) -> bool:
        return any(self.hierarchy.overlap(kind, one) is not None for one in kinds)


def _row(proposal: LabelProposal) -> Row:
    label = written(proposal.label)
    why = _reasons([proposal])
    return Row(proposal.label.element, (proposal.label.kind,), (Reply(YES, label, reasons=why),), why, (label,))


def _suspected(row: Row) -> bool:
    """Whether something suggests that an open node lets data out."""
    return any(one.key == OUT and one.reasons for one in row.replies)


def _leaks(proposals: Iterable[LabelProposal]) -> list[LabelProposal]:
    """What suggests that one element lets data out; that it is an end of data does not."""
    return [one for one in proposals if one.label.role == LEAK and not or_passes_on(one, proposals)]


def _leak(labels: Sequence[SuggestedLabel], reasons: tuple[str, ...]) -> Row:
    """What may be let out; a no is of what is asked, and not of the broader kind that is suggested."""
    element, kinds = labels[0].element, tuple(one.kind for one in labels)
    each = [_leak([one], reasons) for one in labels if len(labels) > 1]
    reply = Reply(YES, _written(element, LEAK, kinds), reasons=reasons)
    return Row(element, kinds, (reply,), reasons, tuple(map(written, labels)), by_kind=tuple(each))


def _written(element: Element, role: str, kinds: Sequence[str]) -> WrittenLabel:
    return WrittenLabel(f"{element.kind}s", literal(element.name), {role: list(kinds)})


def _reasons(about: Iterable[LabelProposal]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(reason.reason for one in about for reason in one.evidence))
