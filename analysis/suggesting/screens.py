"""Questions about many elements -> screens about single elements, each with a line for everything that is suggested.

A line is ticked beforehand where the suggestion is certain or likely and takes nothing away. What could hide a leak
(that a node only passes data on, or ends them; that a channel carries none) is never ticked beforehand. What the type
of a channel is not made for is on no screen. Neither is an element of which only its neighbours speak: a channel that
stands beside others, or a node that gets data and could pass them on.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.evidence import (
    ANYTHING,
    CONDUIT,
    DATA_FLOW,
    DERIVATION,
    HIDING,
    LEAK,
    NAMED,
    NEIGHBOUR,
    NEVER,
    ROLES,
    SANITIZER,
    SENSITIVE,
    SOURCE,
    SURE,
    SuggestedLabel,
    WrittenLabel,
    written,
)
from rosprivacy.analysis.suggesting.label_questions import (
    BRINGS_IN,
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    MAKES,
    NOTHING,
    OUT,
    PASSES,
    YES,
    Reply,
)
from rosprivacy.analysis.suggesting.weighing import SURENESS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Confidence, Element
    from rosprivacy.analysis.suggesting.evidence import Identity, LabelProposal
    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion, Row

SAID_IN_SHORT = 2  # roles
ON_A_PAGE = 9  # lines of a screen: a digit for each
FIRST_SOURCES, MAKERS, EXITS, OTHER_NODES, CHANNELS = range(5)  # where data begin is known before where they end


class ScreenLine(NamedTuple):
    """A statement about an element that a person can tick.

    Attributes
    ----------
    role
        One of ``ROLES``.
    kinds
        The data that it is about; of a derivation what goes in.
    replies
        What is written if it is ticked.
    confidence
        None where nothing suggests it.
    refused
        What is remembered if a person says no to the screen.
    closes
        Known findings that it could close.
    whole
        Whether these are all kinds of data that get there.
    asks
        Whether something of the element itself suggests it: without such a line there is no screen.
    """

    role: str
    kinds: tuple[str, ...]
    replies: tuple[Reply, ...]
    confidence: Confidence | None = None
    reasons: tuple[str, ...] = ()
    refused: tuple[WrittenLabel, ...] = ()
    closes: tuple[str, ...] = ()
    whole: bool = False
    to: str = ""
    asks: bool = True

    @property
    def ticked(self) -> bool:
        """Whether it is ticked before a person has looked."""
        return is_ticked_beforehand(self.role, self.confidence)

    @property
    def hides(self) -> bool:
        """Whether it could hide a leak if it is wrong."""
        return self.role in HIDING

    @property
    def parts(self) -> frozenset[tuple[str, str, str]]:
        """What it states, kind by kind."""
        return frozenset((self.role, kind, self.to) for kind in self.kinds)


class Screen(NamedTuple):
    """One element, and what can be said of it: what is ticked beforehand comes first."""

    element: Element
    lines: tuple[ScreenLine, ...]

    @property
    def stage(self) -> int:
        """Where it stands: where data begin, what is made of them, where they leave, and what is between."""
        if self.element.is_channel:
            return CHANNELS
        roles = {line.role for line in self.lines if line.asks}
        ticked = {line.role for line in self.lines if line.ticked}
        if LEAK in ticked:
            return EXITS
        if DERIVATION in roles:
            return MAKERS
        if SOURCE in ticked or (SOURCE in roles and LEAK not in roles):
            return FIRST_SOURCES
        return EXITS if LEAK in roles else OTHER_NODES

    @property
    def is_likely(self) -> bool:
        """Whether something of it is ticked before a person has looked."""
        return any(line.ticked for line in self.lines)

    @property
    def does(self) -> tuple[str, ...]:
        """Roles that say in short what it does: two at most, those that are likely, or else what perhaps is so."""
        roles = (line.role for line in self.lines if (line.ticked if self.is_likely else line.asks))
        return tuple(dict.fromkeys(roles))[:SAID_IN_SHORT]

    @property
    def surest(self) -> int:
        """How sure its surest line is that hides nothing: the surest is 0."""
        return min((_sureness(line.confidence) for line in self.lines if not line.hides), default=len(SURENESS))


def screens(
    questions: Iterable[LabelQuestion],
    proposals: Iterable[LabelProposal],
    reached: Mapping[Identity, tuple[str, ...]],
    hierarchy: Hierarchy,
) -> tuple[Screen, ...]:
    """Return a screen for each element of which something of it says what it does, the first one first.

    Parameters
    ----------
    questions, proposals
        In review order: what weighs most stands first, and so it does here within its stage.
    reached
        Kinds of data that get to elements.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.model import Confidence, Place
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence
    >>> from rosprivacy.analysis.suggesting.label_questions import questions
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> graph, bound, hierarchy = factory()
    >>> asked = [SuggestedLabel(graph.elements[CAMERA], "source", kind) for kind in ("FaceImage", "Voice")]
    >>> sure = (Confidence.MAY, Confidence.LIKELY)
    >>> said = [Evidence(one, "package", how, "a camera", Place("p", 1)) for one, how in zip(asked, sure, strict=True)]
    >>> all_of_it = proposals(said)
    >>> rows = questions(all_of_it, analyse(graph, bound, hierarchy), bound, traffic(graph, bound), hierarchy)
    >>> (screen,) = screens(rows, all_of_it, {}, hierarchy)
    >>> screen.element.name, [(line.role, line.kinds, line.ticked) for line in screen.lines]
    ('/camera', [('source', ('Voice',), True), ('source', ('FaceImage',), False)])
    """
    rows: dict[Identity, list[tuple[str, Row]]] = defaultdict(list)
    for question in questions:
        for row in question.rows:
            rows[row.element.identity].append((question.about, row))
    of: dict[Identity, list[LabelProposal]] = defaultdict(list)
    for one in proposals:
        of[one.label.element.identity].append(one)
    made = []
    for identity, asked in rows.items():
        element = _OneElement(asked, of[identity], reached.get(identity, ()), hierarchy)
        if any(line.asks for line in element.lines):
            made.append(Screen(asked[0][1].element, tuple(sorted(element.lines, key=_place))))
    return tuple(sorted(made, key=lambda screen: (screen.stage, screen.surest)))  # stable: in review order within


def is_ticked_beforehand(role: str, confidence: Confidence | None) -> bool:
    """Return whether a statement of a role is ticked before a person has looked: it is sure, and hides nothing.

    >>> from rosprivacy.analysis.model import Confidence
    >>> [is_ticked_beforehand(role, Confidence.LIKELY) for role in ("source", "conduit")]
    [True, False]
    """
    return confidence in SURE and role not in HIDING


def ticked_beforehand(screen: Screen) -> frozenset[int]:
    """Return the places of the lines that are ticked before a person has looked.

    >>> from rosprivacy.analysis.model import Confidence, Element
    >>> lines = (ScreenLine("source", ("Video",), (), Confidence.LIKELY), ScreenLine("leak", ("Video",), ()))
    >>> ticked_beforehand(Screen(Element("node", "/eye"), lines))
    frozenset({0})
    """
    return frozenset(at for at, line in enumerate(screen.lines) if line.ticked)


def toggled(screen: Screen, ticks: frozenset[int], at: int) -> frozenset[int]:
    """Return the ticks after a line was ticked or unticked; the same if another tick says the opposite.

    That data leave, or can go through, stands against that they do not. Who ticks everything hides nothing.

    >>> from rosprivacy.analysis.model import Element
    >>> lines = tuple(ScreenLine(role, ("Video",), ()) for role in ("leak", "sanitizer", "conduit"))
    >>> screen, ticks = Screen(Element("node", "/n"), lines), frozenset()
    >>> for key in (2, 1, 0, 1):
    ...     ticks = toggled(screen, ticks, key)
    ...     print(sorted(ticks))
    [2]
    [1]
    [0]
    [0]
    """
    if at in ticks:
        return ticks - {at}
    line = screen.lines[at]
    opposite = {other for other in ticks if _opposite(line, screen.lines[other])}
    if line.hides and any(not screen.lines[other].hides for other in opposite):
        return ticks
    return (ticks - opposite) | {at}


def _opposite(line: ScreenLine, other: ScreenLine) -> bool:
    """Whether two lines speak of the same data, and at least one says that nobody gets them there."""
    speaks = {LEAK, SENSITIVE, *HIDING}
    both = line.role in speaks and other.role in speaks and (line.hides or other.hides)
    return both and not set(line.kinds).isdisjoint(other.kinds)


class _OneElement:
    """The lines of one element."""

    def __init__(
        self,
        rows: Sequence[tuple[str, Row]],
        proposals: Sequence[LabelProposal],
        reached: tuple[str, ...],
        hierarchy: Hierarchy,
    ) -> None:
        self.proposals, self.reached, self.hierarchy = proposals, frozenset(reached), hierarchy
        of_role = {about: [row for of, row in rows if of == about] for about, _ in rows}
        self.lines = [
            *(self._ends(row, SOURCE) for row in of_role.get(BRINGS_IN, ())),
            *self._leaks(of_role.get(LETS_OUT, ()), of_role.get(GOES_ON, ())),
            *(self._ends(row, DERIVATION) for row in of_role.get(MAKES, ())),
            *(line for row in of_role.get(GOES_ON, ()) for line in self._stays(row)),
            *(line for row in of_role.get(GOES_THROUGH, ()) for line in self._channel(row)),
        ]

    def _ends(self, row: Row, role: str) -> ScreenLine:
        reply = row.replies[0]
        to = reply.label.roles["derives"][0]["to"] if role == DERIVATION else ""
        about = [one for one in self._of(role) if (one.label.kind, one.label.to) == (row.kinds[0], to)]
        return ScreenLine(role, row.kinds, (reply,), _surest(about), row.reasons, row.refused, to=to)

    def _leaks(self, let_out: Sequence[Row], nodes: Sequence[Row]) -> Iterator[ScreenLine]:
        """Yield that data leave here: in one line what is suggested, in another what nothing suggests."""
        suspected = [*let_out, *(row for row in nodes if _reply(row, OUT).reasons)]
        if suspected:
            replies = [row.reply(YES) or _reply(row, OUT) for row in suspected]
            reasons = tuple(dict.fromkeys(reason for reply in replies for reason in reply.reasons))
            about = [one for one in self._of(LEAK) if any(each.reason in reasons for each in one.evidence)]
            anything = next((one for one in about if one.label.kind == ANYTHING), None)
            if anything:  # also what nothing brings there today
                replies = [Reply(YES, written(anything.label), reasons=reasons)]
            yield self._out(suspected, replies, _surest(about), reasons)
        for row in nodes:
            if row not in suspected:
                flows = [one for one in self._of(LEAK) if self._speaks_of(one, row.kinds)]
                yield self._out([row], [_reply(row, OUT)], _surest(flows), _reasons(flows))

    def _out(
        self, rows: Sequence[Row], replies: Sequence[Reply], confidence: Confidence | None, reasons: tuple[str, ...]
    ) -> ScreenLine:
        kinds = tuple(sorted({kind for row in rows for kind in row.kinds}))
        refused = tuple(label for row in rows for label in row.refused)
        whole = self.reached <= set(kinds)
        asks = confidence is not None
        return ScreenLine(LEAK, kinds, tuple(replies), confidence, reasons, refused, whole=whole, asks=asks)

    def _stays(self, row: Row) -> Iterator[ScreenLine]:
        """Yield that an open node passes data on, or ends them."""
        conduits = [one for one in self._of(CONDUIT) if self._speaks_of(one, row.kinds)]
        yield ScreenLine(
            CONDUIT,
            row.kinds,
            (_reply(row, PASSES),),
            _surest(conduits),
            _reasons(conduits),
            row.refused,
            whole=self.reached <= set(row.kinds),
            asks=any(each.ground != DATA_FLOW for one in conduits for each in one.evidence),
        )
        if ends := row.reply(NOTHING):
            about = [one for one in self._of(SANITIZER) if written(one.label) == ends.label]
            kinds = tuple(one.label.kind for one in about)
            yield ScreenLine(SANITIZER, kinds, (ends,), _surest(about), ends.reasons, row.refused, row.closes)

    def _channel(self, row: Row) -> Iterator[ScreenLine]:
        """Yield of which kinds something of a channel itself says that it carries them, or that it does not."""
        parts = row.by_kind or (row,)
        own = {part.kinds[0]: self._own(part.kinds) for part in parts}
        carried = [part for part in parts if own[part.kinds[0]]]
        alike: dict[object, list[Row]] = defaultdict(list)
        for part in carried:
            about = own[part.kinds[0]]
            sure = _surest(about)
            alike[part.kinds if sure in SURE else _reasons(about)].append(part)
        for some in alike.values():
            about = [one for part in some for one in own[part.kinds[0]]]
            yield self._through(row, some, SENSITIVE, about)
        named = [part for part in parts if self._by_name(part.kinds)]
        if some := [part for part in parts if part in carried or part in named]:
            about = [one for one in self._of(NEVER) if any(self._speaks_of(one, part.kinds) for part in named)]
            yield self._through(row, some, NEVER, about)

    def _through(self, row: Row, parts: Sequence[Row], role: str, about: Sequence[LabelProposal]) -> ScreenLine:
        kinds = tuple(kind for part in parts for kind in part.kinds)
        rows = [row] if kinds == row.kinds else parts
        replies = tuple(_reply(one, NOTHING if role == NEVER else YES) for one in rows)
        labels = dict.fromkeys(one.label for one in about)
        if role == SENSITIVE:
            labels |= dict.fromkeys(SuggestedLabel(row.element, role, kind) for kind in kinds)
        closes = row.closes if role == NEVER else ()
        whole = self.reached <= set(kinds)
        refused = tuple(map(written, labels))
        return ScreenLine(
            role, kinds, replies, _surest(about), _reasons(about), refused, closes, whole=whole, asks=bool(about)
        )

    def _own(self, kinds: Sequence[str]) -> list[LabelProposal]:
        """What says of a channel that it can carry such data, and is not only what stands beside it."""
        about = [one for one in self._of(SENSITIVE) if self._speaks_of(one, kinds)]
        return [one for one in about if any(each.ground != NEIGHBOUR for each in one.evidence)]

    def _by_name(self, kinds: Sequence[str]) -> bool:
        """Whether only the name of a channel says that it does not carry such data."""
        about = [one for one in self._of(NEVER) if self._speaks_of(one, kinds)]
        return bool(about) and all(each.ground == NAMED for one in about for each in one.evidence)

    def _of(self, role: str) -> list[LabelProposal]:
        return [one for one in self.proposals if one.label.role == role]

    def _speaks_of(self, proposal: LabelProposal, kinds: Iterable[str]) -> bool:
        said = proposal.label.kind
        return not said or any(self.hierarchy.overlap(said, kind) is not None for kind in kinds)


def _place(line: ScreenLine) -> tuple[bool, bool, int]:
    return not line.ticked, line.confidence is None, ROLES.index(line.role)


def _reply(row: Row, key: str) -> Reply:
    reply = row.reply(key)
    assert reply is not None
    return reply


def _sureness(confidence: Confidence | None) -> int:
    return len(SURENESS) if confidence is None else SURENESS[confidence]


def _surest(proposals: Iterable[LabelProposal]) -> Confidence | None:
    return min((one.confidence for one in proposals), key=_sureness, default=None)


def _reasons(proposals: Iterable[LabelProposal]) -> tuple[str, ...]:
    """The reasons for proposals, the surest first."""
    ordered = sorted(proposals, key=lambda one: _sureness(one.confidence))
    return tuple(dict.fromkeys(each.reason for one in ordered for each in one.evidence))
