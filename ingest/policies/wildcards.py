"""Wildcards held against each other: which pairs are worth it, which meet, whether a name is left that no DENY takes
out.

In: expressions as DDS reads them. Out: what ``names.py`` says of pairs of them, counted; groups, of which each written
one meets each read one; whether several have a name in common (rule S4). A step of a comparison is a quarter of a
microsecond or so; pairs times their length grow faster than the policy, so the steps are bounded. Whether a name is
left is told by small automata, whose states are sets of positions in an expression: they read a name together,
character by character, and every set of states is looked at once. Two expressions with a literal beginning, a ``*`` and
a literal end have a name in common if and only if one beginning begins the other, and one end ends the other.
"""

from __future__ import annotations

from collections import defaultdict
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.bounds import Tally
from rosprivacy.analysis.errors import PolicyError
from rosprivacy.analysis.expressions import LAST_CHARACTER, tokens
from rosprivacy.analysis.model import CAREFUL_DENY, Diagnostic, Place, Severity
from rosprivacy.ingest.policies.names import covers, is_pattern, matcher, overlaps

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.expressions import Token
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.ingest.policies.name_index import PlainNames

STEPS_OF_A_PAIR = 4  # beside those for its length
CELLS_OF_A_STEP = 512  # of a name beside an expression that are read in one step


class Comparisons:
    """Compares expressions, counts the steps, and notes DENY lines that were too much to follow.

    Attributes
    ----------
    at
        The line for which it is done, for the message.
    careful
        DENY lines that were taken to leave a name, since it takes too long to tell.
    """

    def __init__(self, bounds: Bounds) -> None:
        self.at = Place("", 0)
        self.careful: set[Place] = set()
        self._steps = Tally(bounds, "comparisons", PolicyError)

    def meet(self, ours: str, theirs: str) -> bool:
        """Whether some name is covered by both."""
        self._steps.add(STEPS_OF_A_PAIR + len(ours), self.at)
        return overlaps(ours, theirs)

    def hold(self, ours: str, theirs: str) -> bool:
        """Whether one covers a name, or all that the other covers."""
        self._steps.add(STEPS_OF_A_PAIR + len(ours), self.at)
        return covers(ours, theirs)

    def placed(self, groups: int) -> None:
        """Count that an expression was put into groups of those that begin and end alike."""
        self._steps.add(STEPS_OF_A_PAIR * groups, self.at)

    def covered(self, expression: str, plain: PlainNames) -> Iterator[tuple[str, Element]]:
        """Those of the channels, each with its DDS name, that an expression covers."""
        matches = matcher(expression)
        for dds, channel in plain.near(expression):
            self._steps.add(STEPS_OF_A_PAIR + len(expression) * len(dds) // CELLS_OF_A_STEP, self.at)
            if matches(dds):
                yield dds, channel

    def name_left(self, matching: tuple[str, ...], rules: Iterable[tuple[str, Grant]]) -> bool:
        """Whether a name is left that all of some expressions match and no rule takes out."""
        from rosprivacy.ingest.policies.wildcards import name_left  # noqa: PLC0415 - light start

        rules = list(rules)
        found = name_left(matching, tuple(sorted({dds for dds, _ in rules})))
        self._steps.add(found.steps, self.at)
        if found.careful:
            self.careful.update(line.place for _, line in rules)
        return found.exists


def apart(rules: Iterable[tuple[str, Grant]]) -> tuple[dict[str, list[Grant]], list[tuple[str, Grant]]]:
    """Return rules of plain names by name, and those with wildcards."""
    plain: dict[str, list[Grant]] = defaultdict(list)
    patterns = []
    for dds, line in rules:
        if is_pattern(dds):
            patterns.append((dds, line))
        else:
            plain[dds].append(line)
    return plain, patterns


def careful_warnings(places: Iterable[Place]) -> tuple[Diagnostic, ...]:
    """Return what is to be said of DENY lines that were too much to follow (rules S4, S11)."""
    what = "takes names out of wildcards, and with the other DENYs there it takes too long to tell whether one is left"
    return tuple(
        Diagnostic(place, Severity.WARNING, f"this DENY {what}: it is taken that one is", CAREFUL_DENY)
        for place in sorted(places, key=lambda place: (place.file, place.line))
    )


LARGEST_SEARCH = 4_096  # sets of states; beyond, the careful answer: a name is left
MOST_STEPS = 10_000_000  # of one search, for the same reason
Letter = tuple[int, ...]  # by automaton: the positions whose characters have this letter


class NameLeft(NamedTuple):
    """Whether a name is left.

    Attributes
    ----------
    steps
        That it took to tell.
    careful
        Whether it took too many: then it is taken that one is left.
    """

    exists: bool
    steps: int
    careful: bool = False


def some_name(matching: tuple[str, ...], denied: tuple[str, ...]) -> bool:
    """Return whether a name exists that all of some expressions match and none of others; True if it cannot be told.

    Examples
    --------
    >>> some_name(("/r?/image", "/r1/*"), ())
    True
    >>> some_name(("/r?/image", "/r1/*"), ("/r1/image",))
    False
    >>> some_name(("/t[0-1]",), ("/t0", "/t1")), some_name(("/t[0-2]",), ("/t0", "/t1"))
    (False, True)
    """
    return name_left(matching, denied).exists


@lru_cache(maxsize=65536)
def name_left(matching: tuple[str, ...], denied: tuple[str, ...]) -> NameLeft:
    """Return whether a name exists that all of some expressions match and none of others, and what it took to tell.

    Notes
    -----
    The sets of states can be as many as 2 to the power of the positions; ``LARGEST_SEARCH`` of them are looked at,
    for each of the letters that the expressions tell apart.
    """
    machines = [tokens(expression) for expression in (*matching, *denied)]
    first = _first(machines)
    steps = len(first) * sum(map(len, machines))
    if steps > MOST_STEPS:
        return NameLeft(exists=True, steps=0, careful=True)
    stars = [_positions(token is None for token in machine) for machine in machines]
    ends = [1 << len(machine) for machine in machines]
    letters = _letters(machines, first)
    step = len(letters) * len(machines)
    start = tuple(_onward(1, star) for star in stars)
    waiting, seen = [start], {start}
    while waiting:
        states = waiting.pop()
        accepted = [bool(state & end) for state, end in zip(states, ends, strict=True)]
        if all(accepted[: len(matching)]) and not any(accepted[len(matching) :]):
            return NameLeft(exists=True, steps=steps)
        if len(seen) > LARGEST_SEARCH or steps > MOST_STEPS:
            return NameLeft(exists=True, steps=steps, careful=True)
        steps += step
        for letter in letters:
            after = tuple(map(_read, states, letter, stars))
            if all(after[: len(matching)]) and after not in seen:
                seen.add(after)
                waiting.append(after)
    return NameLeft(exists=False, steps=steps)


def _read(state: int, letter: int, star: int) -> int:
    """The positions after one more character: past what it stands for, or still in a ``*``."""
    return _onward((state & letter) << 1 | (state & star), star)


def _onward(state: int, star: int) -> int:
    """A ``*`` may stand for nothing; no two stand beside each other."""
    return state | (state & star) << 1


def _positions(flags: Iterable[bool]) -> int:
    return sum(1 << at for at, flag in enumerate(flags) if flag)


def _first(machines: Sequence[Sequence[Token]]) -> set[int]:
    """The characters at which a set of characters begins or has ended."""
    sets = {token for machine in machines for token in machine if token is not None}
    return {0, *(at for token in sets for low, high in token for at in (low, high + 1) if at <= LAST_CHARACTER)}


def _letters(machines: Sequence[Sequence[Token]], first: set[int]) -> list[Letter]:
    """One letter for all characters that no expression tells apart."""
    found = {
        tuple(_positions(token is not None and _has(token, at) for token in machine) for machine in machines): at
        for at in sorted(first, reverse=True)
    }
    return sorted(found, key=lambda letter: found[letter])


def _has(token: Token, character: int) -> bool:
    return token is not None and any(low <= character <= high for low, high in token)


_Group = tuple[tuple[str, bool], tuple[str, bool]]


class MeetingEnds(NamedTuple):
    """The literal beginning of an expression up to its first ``*``, and the end after the last; backwards."""

    beginning: str
    end: str


def literal_ends(expression: str) -> MeetingEnds | None:
    """Return the ends of an expression, or None where it has no ``*``, no names, or ends that are not literal.

    >>> literal_ends("rt/robot*/[ab]/s*_7"), literal_ends("rt/cam?/*"), literal_ends("rt/cam?")
    (MeetingEnds(beginning='rt/robot', end='7_'), None, None)
    """
    found = tokens(expression)
    if None not in found or () in found:
        return None
    first, last = found.index(None), found[::-1].index(None)
    ends = found[:first], found[::-1][:last]
    if any(token is None or len(token) != 1 or token[0][0] != token[0][1] for end in ends for token in end):
        return None
    return MeetingEnds(*("".join(chr(token[0][0]) for token in end if token) for end in ends))


def meetings(
    written: Mapping[Element, MeetingEnds], read: Mapping[Element, MeetingEnds], count: Callable[[Element, int], None]
) -> Iterator[tuple[list[Element], list[Element]]]:
    """Yield groups of which each written element meets each read one; each pair that meets is in one of them.

    Parameters
    ----------
    written, read
        Elements with the ends of their one expression.
    count
        Is told of how many groups each element is.

    Notes
    -----
    A group is that of all pairs with one shorter beginning and one shorter end, and of whose side these are. So an
    element is in as many groups as there are others' beginnings within its own, times the same of the ends.
    """
    groups: tuple[dict[_Group, list[Element]], ...] = (defaultdict(list), defaultdict(list))
    for found, mine, others, is_read in ((groups[0], written, read, False), (groups[1], read, written, True)):
        beginnings, ends = (_Shorter({one[at] for one in others.values()}) for at in (0, 1))
        for element, own in mine.items():
            some = [*product(beginnings.of(own.beginning, is_read=is_read), ends.of(own.end, is_read=is_read))]
            for group in some:
                found[group].append(element)
            count(element, len(some))
    for group in sorted(groups[0].keys() & groups[1].keys()):
        yield groups[0][group], groups[1][group]


class _Shorter:
    """Literal texts of one side, to find those that begin one of the other side."""

    def __init__(self, names: set[str]) -> None:
        self._names = names
        self._lengths = sorted({len(text) for text in names})

    def of(self, text: str, *, is_read: bool) -> list[tuple[str, bool]]:
        """The text itself, and those of the other side that begin it; each with whether it is one that is read.

        Where both sides have one text, it counts as the read side's.
        """
        within = (text[:length] for length in self._lengths if length < len(text) + (not is_read))
        return [(text, is_read), *((one, not is_read) for one in within if one in self._names)]
