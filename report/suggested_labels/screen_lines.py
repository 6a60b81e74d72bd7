"""A screen about one element -> lines for a terminal of 80 columns and 24 lines, without colours.

Each line of it is cut to the width, and a page has room for nine: a key turns to the next. All that stands behind a
line is told by the key for it.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.evidence import CONDUIT, DERIVATION, LEAK, NEVER, SANITIZER, SENSITIVE, SOURCE
from rosprivacy.analysis.suggesting.screens import CHANNELS, ON_A_PAGE
from rosprivacy.analysis.text import counted, cut, printable
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.naming import all_kinds

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine

WIDTH, HEIGHT = 79, 24  # one column is for the sign that something was cut off
NAMED, FINDINGS = 3, 3  # kinds that are named, findings that are told
DOES = {
    SOURCE: "brings data in",
    LEAK: "lets data out",
    DERIVATION: "makes other data",
    SENSITIVE: "carries data of persons",
    SANITIZER: "ends data",
    CONDUIT: "passes data on",
    NEVER: "carries no such data",
}
KEYS = (
    "  Enter takes what is ticked, the rest stays open; a number ticks or unticks it",
    "  n no to all, b back, u undo, ? why, / other label, l as lists, q stop",
)
ALL_CHANNELS = "  a takes what is ticked on all further channels, too"
HELP = (
    "  Enter  what is ticked is written as labels; of the rest nothing is stated",
    "  1-9    ticks a line, or unticks it        +  the next lines of the screen",
    "  n      no to all lines; it is remembered, and not asked again",
    "  b      back to the screen before          u  takes the last answer back",
    "  /      a label is typed as a line: /camera node source Video",
    "  l      asks what is left as lists of elements, one answer for several",
    "  q      ends it; the same command goes on from there",
)
NOTHING_SAYS = "nothing says so"


def screen_lines(screen: Screen, ticks: Collection[int], first: int = 0) -> Iterator[str]:
    """Yield what is asked of one element: the lines from some place on, and what could hang on them.

    >>> from rosprivacy.analysis.model import Confidence, Element
    >>> from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine
    >>> line = ScreenLine("source", ("Video",), (), Confidence.LIKELY, ("it is a camera",))
    >>> print(*screen_lines(Screen(Element("node", "/eye"), (line,)), {0}), sep="|")
    |node /eye: likely brings data in|  1 [x] brings in Video (likely: it is a camera)
    """
    page = screen.lines[first : first + ON_A_PAGE]
    element = screen.element
    yield ""
    yield from wrap(f"{element.kind} {shown(element.name)}: {_likely(screen)}", WIDTH)
    for number, line in enumerate(page, 1):
        tick = "x" if first + number - 1 in ticks else " "
        yield cut(f"  {number} [{tick}] {printable(_line_text(line))}", WIDTH)
    if other := len(screen.lines) - len(page):
        ticked = sum(at not in range(first, first + len(page)) for at in ticks)
        yield f"  and {other} more{f', {ticked} of them ticked' if ticked else ''}: press +"
    yield from _findings(page)


def keys_lines(screen: Screen) -> Sequence[str]:
    """Return which keys there are."""
    return (KEYS[0], ALL_CHANNELS, *KEYS[1:]) if screen.stage == CHANNELS else KEYS


def why_lines(screen: Screen, first: int = 0) -> Iterator[str]:
    """Yield what a screen's lines rest on, and what each key does, on one screen of a terminal."""
    left = HEIGHT - len(HELP) - len(keys_lines(screen)) - 2
    for number, line in enumerate(screen.lines[first : first + ON_A_PAGE], 1):
        kinds = f"{', '.join(line.kinds)}: " if len(line.kinds) > NAMED else ""
        text = f"{kinds}{'; '.join(line.reasons) or NOTHING_SAYS}"
        rows = wrap(printable(text), WIDTH - 5, initial_indent=f"  {number}  ", subsequent_indent="     ")
        if len(rows) > left:
            rows = [*rows[: max(0, left - 1)], f"     and more: rosprivacy suggest --why {shown(screen.element.name)}"]
        yield from rows[: max(0, left)]
        left -= len(rows)
    yield from HELP


def end_lines(rest: int) -> tuple[str, str]:
    """Return what is told where no screen is left.

    >>> end_lines(1)[0]
    '  1 element is left that only gets data, or stands beside others'
    """
    is_left = "is left that only gets data, or stands" if rest == 1 else "are left that only get data, or stand"
    return (
        f"  {counted(rest, 'element')} {is_left} beside others",
        "  l asks about them as lists, Enter ends, b back, u undo",
    )


def _likely(screen: Screen) -> str:
    """What an element is likely to be, in words."""
    return f"{'likely' if screen.is_likely else 'perhaps'} {' and '.join(DOES[role] for role in screen.does)}"


def _line_text(line: ScreenLine) -> str:
    if line.confidence is None:
        return f"{_words(line)} ({NOTHING_SAYS})"
    why = f": {line.reasons[0]}" if line.reasons else ""
    return f"{_words(line)} ({line.confidence}{why})"


def _words(line: ScreenLine) -> str:
    """What a line states.

    >>> from rosprivacy.analysis.suggesting.screens import ScreenLine
    >>> kinds = ("Gait", "Gesture", "Video", "Voice")
    >>> _words(ScreenLine("leak", kinds, (), whole=True)), _words(ScreenLine("leak", kinds, ()))
    ('lets out all 4 kinds of data', 'lets out Gait, Gesture and 2 more kinds')
    >>> _words(ScreenLine("derivation", ("Video",), (), to="FaceImage"))
    'makes FaceImage from Video'
    """
    kinds = _kinds(line)
    if line.role == DERIVATION:
        return f"makes {line.to} from {kinds}"
    verbs = {
        SOURCE: "brings in",
        LEAK: "lets out",
        CONDUIT: "only passes on or drops",
        SANITIZER: "ends",
        SENSITIVE: "can carry",
        NEVER: "carries nothing of",
    }
    return f"{verbs[line.role]} {kinds}"


def _kinds(line: ScreenLine) -> str:
    if line.role == SANITIZER:
        said = line.replies[0].label.roles[SANITIZER]
        return " and ".join(f"{kind} ({method})" for kind, method in said.items())
    if len(line.kinds) <= NAMED:
        return " and ".join((", ".join(line.kinds[:-1]), line.kinds[-1])) if len(line.kinds) > 1 else line.kinds[0]
    if line.whole:
        return all_kinds(line.kinds, line.kinds, IN_ENGLISH)
    return f"{', '.join(line.kinds[: NAMED - 1])} and {counted(len(line.kinds) - NAMED + 1, 'more kind')}"


def _findings(page: Sequence[ScreenLine]) -> Iterator[str]:
    """Yield the findings that lines could close."""
    closes = list(dict.fromkeys(told for line in page for told in line.closes))
    if closes:
        numbers = " and ".join(str(number) for number, line in enumerate(page, 1) if line.closes)
        yield f"  known findings, which {numbers} could close:"
        yield from (cut(f"     {shown(told)}", WIDTH) for told in closes[:FINDINGS])
        if len(closes) > FINDINGS:
            yield f"     and {counted(len(closes) - FINDINGS, 'more finding')}"
