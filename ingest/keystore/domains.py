"""DDS domains that a rule is about, and sets of domains.

A range without ``<max>`` is open-ended in the standard; Fast DDS and Cyclone DDS read it as one domain. So a rule is
about some domains surely, and about others perhaps.

Source: DDS-Security 1.1, 9.4.1.2.4.1; ``CommonParser.cpp`` of Fast DDS, ``access_control_parser.c`` of Cyclone DDS.
"""

from __future__ import annotations

from dataclasses import dataclass

LAST_DOMAIN = 2**32 - 1  # as the schema has it
LAST_OF_ROS = 232  # the ports of UDP suffice for no more
Spans = tuple[tuple[int, int], ...]
"""(first, last) of each range of domains, both in it."""


@dataclass(frozen=True, slots=True)
class Domains:
    """A set of domains.

    Attributes
    ----------
    closed
        The ranges that have both ends, sorted.
    opened
        Where ranges without ``<max>`` begin, sorted.
    """

    closed: Spans
    opened: tuple[int, ...] = ()

    @property
    def spans(self) -> Spans:
        """All that a rule may be about.

        >>> Domains(((0, 0),), (7,)).spans == ((0, 0), (7, LAST_DOMAIN))
        True
        """
        return (*self.closed, *((first, LAST_DOMAIN) for first in self.opened))

    @property
    def certain(self) -> Spans:
        """What it is about to every middleware.

        >>> Domains(((0, 0),), (7,)).certain
        ((0, 0), (7, 7))
        """
        return (*self.closed, *((first, first) for first in self.opened))

    def __contains__(self, domain: int) -> bool:
        """Whether a rule may be about a domain.

        >>> 3 in Domains(((0, 0), (2, 5))), 1 in Domains(((0, 0), (2, 5)))
        (True, False)
        """
        return bool(common(self.spans, ((domain, domain),)))

    def surely(self, domain: int) -> bool:
        """Return whether a rule is about a domain to every middleware.

        >>> Domains((), (7,)).surely(7), Domains((), (7,)).surely(8), 8 in Domains((), (7,))
        (True, False, True)
        """
        return bool(common(self.certain, ((domain, domain),)))

    def __str__(self) -> str:
        """Return the domains as a person writes them.

        >>> str(Domains(((0, 0), (2, 5)), (7,)))
        '0, 2 to 5, 7 and above'
        """
        return written(self.spans)


def common(one: Spans, other: Spans) -> Spans:
    """Return what is in both.

    >>> common(((0, 5), (9, 9)), ((3, 7),))
    ((3, 5),)
    """
    both = ((max(a, c), min(b, d)) for a, b in one for c, d in other)
    return tuple(sorted({(first, last) for first, last in both if first <= last}))


def without(spans: Spans, taken: Spans) -> Spans:
    """Return what is left when some domains are taken out.

    >>> without(((0, 9),), ((3, 4), (9, 20)))
    ((0, 2), (5, 8))
    """
    for low, high in taken:
        spans = tuple(
            (first, last)
            for start, end in spans
            for first, last in ((start, min(end, low - 1)), (max(start, high + 1), end))
            if first <= last
        )
    return tuple(sorted(set(spans)))


def written(spans: Spans) -> str:
    """Return ranges as a person writes them.

    >>> written(((0, 0), (2, 5)))
    '0, 2 to 5'
    """
    return ", ".join(
        str(first) if first == last else f"{first} and above" if last == LAST_DOMAIN else f"{first} to {last}"
        for first, last in spans
    )
