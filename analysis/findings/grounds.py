"""What 'no leak found' needs before it says anything: a source whose data goes somewhere, and a word on leaks.

In: a ``Spread``. Out: ``Grounds``, of a system or of a part of it.

Source: rules S11 and S12: what is not known is said. A first label file, or one with a wrong name in it, must not look
like an answer: nothing leaks where nothing was followed, and nothing is a leak where nobody said what one is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import GOES_NOWHERE, NO_LEAK_NAMED, NO_SOURCE, Diagnostic, Place, Severity

if TYPE_CHECKING:
    from rosprivacy.analysis.kernel.spread import Spread

SPEAKS_OF_LEAKS = ("leak", "no-leak")
NO_SOURCE_OF_THESE = "no source emits one of the chosen categories, and nothing makes one: no data was followed"
GOES_TO_SUCH = (
    "what the sources bring in goes nowhere, or only to standard channels and to those whose type cannot carry it: "
    "no data was followed"
)
WHAT = {
    NO_SOURCE: "no label names a source: no data was followed",
    GOES_NOWHERE: "what the sources bring in goes nowhere, or to standard channels only: no data was followed",
    NO_LEAK_NAMED: "no label says where data gets out: nothing that it gets to could be a leak",
}


class Grounds(NamedTuple):
    """Whether what is asked for begins or is made, whether it goes on, and whether anybody speaks of leaks."""

    source: bool = False
    onward: bool = False
    leak: bool = False

    def __or__(self, other: Grounds) -> Grounds:
        """Return the grounds of two parts of a system together."""
        return Grounds(self.source or other.source, self.onward or other.onward, self.leak or other.leak)

    @property
    def lacking(self) -> str:
        """What is missing first, as the code of a diagnostic; empty if nothing is.

        >>> Grounds(source=True, onward=True).lacking
        'no-leak-named'
        """
        if not self.source:
            return NO_SOURCE
        return GOES_NOWHERE if not self.onward else "" if self.leak else NO_LEAK_NAMED


def grounds(spread: Spread, mask: int) -> Grounds:
    """Return the grounds of a spread, for some of its categories.

    What a person closes, or a DENY, was looked at: the data got there. A standard channel and what
    the type of a channel cannot carry are nobody's word.

    Examples
    --------
    >>> from rosprivacy.analysis import example
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> found = spread(*example.factory())
    >>> grounds(found, found.all_bits)
    Grounds(source=True, onward=True, leak=True)
    """
    asked = spread.names(mask)
    return Grounds(
        source=any(spread.begins(vertex) & mask for vertex in spread.facts)
        or any(bits & mask for reached in (spread.arrives, spread.leaves) for bits in reached.values()),
        onward=_onward(spread, mask),
        leak=any(_judged(spread, vertex, asked) for vertex in spread.facts),
    )


def _onward(spread: Spread, mask: int) -> bool:
    arrived = ((v, bits & ~spread.limited.get(v, 0)) for v, bits in spread.arrives.items())
    if any(bits & mask for vertex, bits in arrived if vertex not in spread.standard):
        return True
    if any(spread.leaves.get(flow.source, 0) & mask for flow in spread.graph.taken_back):
        return True
    return any(spread.leaves.get(spread.graph.flows[index].source, 0) & mask for index in spread.flow_keeps)


def _judged(spread: Spread, vertex: int, asked: tuple[str, ...]) -> bool:
    """Whether it is a storage, or is said to be a leak or none: by a label, outranked or not, or by its kind."""
    if spread.graph.elements[vertex].kind == "storage":
        return True
    facts = [fact for category, fact in spread.facts[vertex].items() if category in asked]
    said = (statement for fact in facts for statement in (*fact.accepted, *(lost for lost, _ in fact.outdone)))
    return any(statement.role in SPEAKS_OF_LEAKS for statement in said)


def lacking(code: str, *, restricted: bool, limited: bool = False) -> tuple[Diagnostic, ...]:
    """Return the warning about what is missing, if anything.

    Parameters
    ----------
    restricted
        Whether only some categories are asked for.
    limited
        Whether there are channels that cannot carry some (rule S15).

    >>> [said.message.partition(":")[0] for said in lacking(NO_SOURCE, restricted=True)]
    ['no source emits one of the chosen categories, and nothing makes one']
    """
    if not code:
        return ()
    what = NO_SOURCE_OF_THESE if code == NO_SOURCE and restricted else WHAT[code]
    what = GOES_TO_SUCH if code == GOES_NOWHERE and limited else what
    return (Diagnostic(Place("labels", 0), Severity.WARNING, f"{what}, so this says nothing about the system", code),)
