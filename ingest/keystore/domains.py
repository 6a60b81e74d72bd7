"""DDS domains that a rule is about."""

from __future__ import annotations

from dataclasses import dataclass

LAST_DOMAIN = 2**32 - 1  # as the schema has it; ROS 2 uses 0 to 232


@dataclass(frozen=True, slots=True)
class Domains:
    """A set of domains.

    Attributes
    ----------
    ranges
        (first, last) of each, both in it, sorted.
    """

    ranges: tuple[tuple[int, int], ...]

    def __contains__(self, domain: int) -> bool:
        """Whether a rule is about a domain.

        >>> 3 in Domains(((0, 0), (2, 5))), 1 in Domains(((0, 0), (2, 5)))
        (True, False)
        """
        return any(first <= domain <= last for first, last in self.ranges)

    def __str__(self) -> str:
        """Return the domains as a person writes them.

        >>> str(Domains(((0, 0), (2, 5))))
        '0, 2 to 5'
        """
        return ", ".join(str(first) if first == last else f"{first} to {last}" for first, last in self.ranges)
