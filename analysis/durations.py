"""ISO 8601 durations, compared as durations: how long data is kept against how long it may be (rule S10).

In: text such as ``P30D`` or ``P1M``, read by isodate. Out: ``Duration``. A month has 28 to 31 days, so months and days
can only be compared from a given day on.

Source: XML Schema 1.1 part 2, section 3.3.6.2, whose four reference days show every way in which two durations can
compare. There ``P1M`` and ``P30D`` are neither equal nor one the longer; here a duration counts as longer than
another if it is from one of these days on, so that doubt is shown and not passed over.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime, timedelta
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

DAYS = (date(1696, 9, 1), date(1697, 2, 1), date(1903, 3, 1), date(1903, 7, 1))
LONGEST = 12_000  # months: a thousand years
LONGEST_NUMBER = 10  # characters, its unit included
UNITS = ("year", "month", "week", "day", "hour", "minute", "second")
_SECOND = timedelta(seconds=1)


@dataclass(frozen=True, slots=True)
class Duration:
    """A length of time.

    Attributes
    ----------
    text
        As written.
    months, seconds
        What it adds up to: years are months, weeks and days are seconds.
    """

    text: str
    months: int
    seconds: float

    def __str__(self) -> str:
        return self.text

    def __add__(self, other: Duration) -> Duration:
        return Duration(f"{self} + {other}", self.months + other.months, self.seconds + other.seconds)

    def after(self, start: date) -> float:
        """Return its length in seconds from the first day of a month on."""
        months = start.year * 12 + start.month - 1 + self.months
        return (date(months // 12, months % 12 + 1, 1) - start) / _SECOND + self.seconds

    def ends(self, start: datetime) -> datetime:
        """Return when it ends that begins at a time; months of no such day end on their last one.

        >>> parse("P1M").ends(datetime(2026, 1, 31)), parse("P1000Y").ends(datetime(9999, 1, 1)) == datetime.max
        (datetime.datetime(2026, 2, 28, 0, 0), True)
        """
        from calendar import monthrange  # noqa: PLC0415 - light start

        months = start.year * 12 + start.month - 1 + self.months
        year, month = months // 12, months % 12 + 1
        try:
            day = min(start.day, monthrange(year, month)[1])
            return start.replace(year=year, month=month, day=day) + timedelta(seconds=self.seconds)
        except (OverflowError, ValueError):  # after the year 9999
            return datetime.max.replace(tzinfo=start.tzinfo)

    def can_be_longer(self, other: Duration) -> bool:
        """Return whether it is longer from some day on.

        >>> parse("P31D").can_be_longer(parse("P1M")), parse("P1M").can_be_longer(parse("P31D"))
        (True, False)
        >>> parse("P12M").can_be_longer(parse("P1Y")), parse("PT24H").can_be_longer(parse("P1D"))
        (False, False)
        """
        return any(self.after(day) > other.after(day) for day in DAYS)


def parse(text: str) -> Duration:
    """Read a duration.

    Raises
    ------
    ValueError
        If it is none, or negative, or has a part of a month, or is longer than a thousand years; the message says
        what is wrong.

    Examples
    --------
    >>> parse("P1Y6M").months, parse("PT36H").seconds
    (18, 129600.0)
    """
    import isodate  # noqa: PLC0415 - light start

    if not text.startswith("P") or text.endswith(("P", "T")):
        raise ValueError("not an ISO 8601 duration")
    try:
        read = isodate.parse_duration(text, as_timedelta_if_possible=False)
    except OverflowError:
        raise ValueError("longer than a thousand years") from None
    except (isodate.ISO8601Error, ValueError, ArithmeticError):
        raise ValueError("not an ISO 8601 duration") from None
    months = read.years * 12 + read.months
    if months != int(months):
        raise ValueError("a part of a month, which has no length of its own")
    if months > LONGEST or read.tdelta > timedelta(days=31 * LONGEST):
        raise ValueError("longer than a thousand years")
    return Duration(text, int(months), read.tdelta / _SECOND)


def parts(text: str) -> tuple[tuple[str, int], ...]:
    """Return the units of a duration and how many there are of each; nothing if it is none or has broken numbers.

    >>> parts("P1Y6M"), parts("PT12H"), parts("P1.5D")
    ((('year', 1), ('month', 6)), (('hour', 12),), ())
    """
    from isodate.isoduration import ISO8601_PERIOD_REGEX  # noqa: PLC0415 - light start

    match = ISO8601_PERIOD_REGEX.fullmatch(text)
    written = [(unit, match[f"{unit}s"]) for unit in UNITS if match[f"{unit}s"]] if match and not match["sign"] else []
    whole = all(number[:-1].isdecimal() and len(number) <= LONGEST_NUMBER for _, number in written)
    return tuple((unit, int(number[:-1])) for unit, number in written) if whole else ()


def ordered(pairs: Iterable[tuple[str, Duration]]) -> tuple[tuple[str, Duration], ...]:
    """Return (category, duration) in the one order in which facts hold them (rule S14).

    >>> [(name, str(kept)) for name, kept in ordered([("Voice", parse("P1M")), ("Video", parse("P1Y"))])]
    [('Video', 'P1Y'), ('Voice', 'P1M')]
    """
    return tuple(sorted(pairs, key=lambda pair: (pair[0], str(pair[1]))))
