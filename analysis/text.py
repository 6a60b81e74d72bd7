r"""Text from anybody's files -> text that is fit to be shown: nothing unprintable, nothing endless; things counted.

In: any text. Out: one line, not yet escaped for any format.

Only here is it decided which signs may be shown: those that Python takes as printable. Control signs (C0, C1), ends of
lines, signs that turn the direction of writing (bidi), and halves of surrogate pairs are none of them.
"""

from __future__ import annotations

LONGEST_FIT, TAIL = 160, 40  # a name in a report for people
LONGEST_LINE = 2_000


def printable(text: str) -> str:
    r"""Return the whole text, what cannot be printed escaped; letters that are written from right to left can be.

    >>> printable("/a" + chr(10) + chr(0x202E))
    '/a\\n\\u202e'
    """
    if text.isprintable():  # nearly always, and then it is at once done
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def blanked(text: str, sign: str = " ") -> str:
    """Return the whole text, one sign in place of each that cannot be printed.

    >>> blanked("a" + chr(0x202E) + "b")
    'a b'
    """
    return "".join(c if c.isprintable() else sign for c in text)


def one_line(text: str) -> str:
    """Return a longer text in one line, what cannot be printed as spaces; its end is left out where it is too long.

    >>> one_line("a" + chr(10) + "b"), len(one_line("a" * 9_000))
    ('a b', 2001)
    """
    return cut(blanked(text[: LONGEST_LINE + 1]), LONGEST_LINE)


def fit(text: str) -> str:
    """Return printable text for one line of a report for people; its middle is left out where it is too long.

    >>> fit("/camera"), len(fit("x" * 4000))
    ('/camera', 165)
    """
    line = printable(text)
    return line if len(line) <= LONGEST_FIT else f"{line[: LONGEST_FIT - TAIL]} […] {line[-TAIL:]}"


def shortened(text: str, longest: int) -> str:
    """Return printable text of at most so many signs; its middle is left out where it is too long.

    >>> shortened("/perception/detection/objects", 15)
    '/percep…objects'
    """
    line = printable(text)
    if len(line) <= longest:
        return line
    return line[: longest // 2] + "…" + line[len(line) - (longest - longest // 2 - 1) :]


def utf8(text: str) -> str:
    r"""Return text that UTF-8 can say: half characters (of a file name that is no UTF-8) are escaped.

    >>> print(utf8("a" + chr(0xDC80)))
    a\udc80
    """
    return text.encode("utf-8", "backslashreplace").decode()


def counted(number: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun.

    >>> counted(1, "box", "boxes"), counted(2, "box", "boxes"), counted(1200, "node")
    ('1 box', '2 boxes', '1,200 nodes')
    """
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"


def cut(line: str, width: int) -> str:
    """Return so many signs of a line; its end is left out where it is too long.

    >>> cut("abcdef", 3), cut("abc", 3)
    ('abc…', 'abc')
    """
    return line if len(line) <= width else f"{line[:width]}…"
