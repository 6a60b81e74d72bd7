"""What the clues of channels say of the nodes that write and read them.

In: what types and names suggest of channels (``carried_kinds``). Out: the clues that count for who writes a channel,
for who reads it, and for who brings in what goes through it; why, ``nodes`` says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, Clue
from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, NAMED
from rosprivacy.analysis.suggesting.name_rules import ends_with, words
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.name_rules import NameRules

ByKind = dict[str, list[Clue]]


class WrittenChannel(NamedTuple):
    """A channel that a node writes, with the names of its types, and what is thought that goes into it."""

    element: Element
    types: Sequence[str]
    clues: Sequence[Clue]


def by_kind(channels: Iterable[Sequence[Clue]]) -> ByKind:
    """Return by kind what channels are thought to carry; that they can carry anything says nothing of a node.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, Clue
    >>> clues = [Clue(kind, "name", Confidence.MAY, "a word", Place("names.yaml", 1)) for kind in ("Video", ANYTHING)]
    >>> [*by_kind([clues])]
    ['Video']
    """
    found: ByKind = {}
    for clues in channels:
        for clue in clues:
            if clue.kind != ANYTHING:
                found.setdefault(clue.kind, []).append(clue)
    return found


def of_reader(clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """Return what is thought of a topic, as far as it says something of who reads it, or writes it.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> names = NAMES._replace(not_by_type=frozenset(["Video"]))
    >>> clues = tuple(Clue(kind, "type", Confidence.MAY, "", Place("types.yaml", 1)) for kind in ("Video", "Voice"))
    >>> [one.kind for one in of_reader(clues, names)]
    ['Voice']
    """
    alone = names.not_by_type
    if not any(clue.kind in alone for clue in clues):
        return clues
    alone -= {clue.kind for clue in clues if clue.ground == NAMED}
    return tuple(clue for clue in clues if clue.kind not in alone or clue.confidence is not Confidence.MAY)


def of_writer(channel: Element, clues: tuple[Clue, ...], names: NameRules) -> tuple[Clue, ...]:
    """Return what is thought of a channel, for who writes it: what a goal or a request may carry, it does not bring in.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> names = NAMES._replace(wanted=frozenset([("goal",)]))
    >>> clues = (Clue("Location", "type", Confidence.MAY, "", Place("types.yaml", 1)),)
    >>> [len(of_writer(Element("topic", name), clues, names)) for name in ("/goal", "/place")]
    [0, 1]
    """
    if channel.leg != "request" and not ends_with(channel.name, names.wanted):
        return clues
    return tuple(clue for clue in clues if clue.confidence is not Confidence.MAY)


def brought_in(kind: str, channel: WrittenChannel, names: NameRules) -> Iterator[Clue]:
    """Yield what is thought of a channel and a kind, as far as it says that who writes it brings that in.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> names = NAMES._replace(reworked=frozenset(["debug"]))
    >>> clues = [Clue("Video", "type", Confidence.LIKELY, "", Place("types.yaml", 1))]
    >>> topics = [WrittenChannel(Element("topic", name), (), clues) for name in ("/image", "/debug/image")]
    >>> [(one.ground, one.confidence.value) for topic in topics for one in brought_in("Video", topic, names)]
    [('type', 'likely'), ('data-flow', 'may')]
    """
    clues = [clue for clue in channel.clues if clue.kind == kind]
    parts = map(words, channel.element.name.split("/")) if clues else ()
    if not all(names.reworked.isdisjoint(part) and names.simulated.isdisjoint(part) for part in parts):
        return map(doubtful, clues)
    return map(_worked_out, clues) if kind in names.computed else iter(clues)


def _worked_out(clue: Clue) -> Clue:
    """A clue of a kind that programs work out, for a source of it."""
    sure = Confidence.LIKELY if clue.confidence is Confidence.CERTAIN else clue.confidence
    return clue._replace(ground=DATA_FLOW if sure is Confidence.MAY else clue.ground, confidence=sure)


def doubtful(clue: Clue) -> Clue:
    """Return a clue as one that is no more than ``may``, and agrees with nothing.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> one = doubtful(Clue("Video", "type", Confidence.LIKELY, "", Place("types.yaml", 1)))
    >>> one.ground, one.confidence.value
    ('data-flow', 'may')
    """
    return Clue(clue.kind, DATA_FLOW, Confidence.MAY, clue.reason, clue.place)


def surest(clues: Sequence[Clue]) -> Clue:
    """Return the surest of some clues, of several the first.

    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Clue
    >>> one = Clue("Video", "name", Confidence.MAY, "a word", Place("names.yaml", 1))
    >>> surest([one, one._replace(confidence=Confidence.LIKELY)]).confidence.value
    'likely'
    """
    first = clues[0]
    for clue in clues[1:]:
        if surer(clue.confidence, first.confidence):
            first = clue
    return first
