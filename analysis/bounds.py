"""Bounds on what a stranger's input can press on: an answer is whole, or refused with the bound and how to raise it.

Time and memory grow with the bytes of an input, and some grow faster: with pairs of wildcards, with the number that a
group of robots states, with sources times leaks. These are bounded where they are read or made. The bounds are
so large that no system known to us meets one. Never is a bound met by leaving something out in silence (rule S11).
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.written_names import did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model.diagnostic import Place

OPTION = "--bound"
LARGEST = 10**18


def _bound(default: int, counted: str) -> int:
    """Make a field of ``Bounds``; ``counted`` is what there is more or less of, for messages and the documentation."""
    made: int = field(default=default, metadata={"counted": counted})
    return made


@dataclass(frozen=True, slots=True)
class Bounds:
    """How much of each is read or made.

    Attributes
    ----------
    name
        DDS takes 255; the cost of a wildcard grows with its length.
    nesting
        What our formats mean is not ten levels deep; each level is held while a file is read.
    robots
        All robots of a fleet with those of its infrastructure; a group states a million of them in eight bytes.
    flows
        Half as many wildcards as grants match as many names: flows grow with the square of a policy, and so they do in
        the enforced view, where each node of an enclave may do what all of them may.
    comparisons
        Pairs of wildcards times their length, and what DENYs leave of them: the cube of a policy. Of labels by itself:
        globs times names.
    passed_over
        A folder may hold anything, and of each file the beginning is read. Where this bound is met, a warning says how
        many were not looked into, and the verdict is undetermined at best.
    findings
        Sources times leaks times kinds of data: the cube of a label file.
    search_steps
        Each source is followed by itself to all that it reaches.
    path_steps
        For each finding paths that share no flow are counted on all flows between its ends. Where this bound is met,
        the other findings say that one path is there, and a warning says of how many that is so.
    policy_bytes
        Of a policy with all that it includes, where a chain of includes that doubles at each step ends soon.
    """

    name: int = _bound(16_384, "characters in a name")
    nesting: int = _bound(64, "levels of lists and maps")
    robots: int = _bound(200_000, "robots in the fleet")
    flows: int = _bound(1_000_000, "flows between the elements of a robot or a domain")
    comparisons: int = _bound(60_000_000, "steps of comparing wildcards and globs")
    passed_over: int = _bound(10_000, "files of a folder that are looked into, to see whether they are policies")
    findings: int = _bound(200_000, "findings")
    search_steps: int = _bound(100_000_000, "elements reached, counted for each source")
    path_steps: int = _bound(300_000_000, "steps of counting paths")
    policy_bytes: int = _bound(64 * 2**20, "bytes of a policy with all that it includes")

    @classmethod
    def raised(cls, written: Iterable[str]) -> Bounds:
        """Return the bounds with some of them set as on the command line.

        Raises
        ------
        InputErrors
            For a name that is none, with the nearest, and for what is no number.

        Examples
        --------
        >>> Bounds.raised(["robots=500000"]).robots
        500000
        """
        problems = []
        values: dict[str, int] = {}
        for text in written:
            name, _, number = text.partition("=")
            if name not in COUNTED:
                near = nearest(name.casefold(), COUNTED, like=0)
                what = f"{shown(name)!r} is none of {', '.join(COUNTED)}"
                problems.append(InputError(OPTION, 0, what, did_you_mean(near)))
            elif not (number.isascii() and number.isdecimal() and len(number) < len(str(LARGEST)) and int(number)):
                what = f"{shown(text)!r} sets no bound"
                problems.append(InputError(OPTION, 0, what, f"write a whole number above 0, as in {name}=1000"))
            else:
                values[name] = int(number)
        if problems:
            raise InputErrors(problems)
        return replace(cls(), **values)

    def refusal(self, name: str, amount: int | None = None) -> tuple[str, str]:
        """Return what is wrong, and what to do, where there is more of something than a bound.

        Parameters
        ----------
        amount
            How much there is; None where nobody counted on.

        Examples
        --------
        >>> Bounds().refusal("nesting", 70)
        ('70 levels of lists and maps, more than the bound of 64', 'raise it with --bound nesting=N')
        """
        bound = getattr(self, name)
        more = f"more than the bound of {bound:,}"
        told = f"{more} {COUNTED[name]}" if amount is None else f"{amount:,} {COUNTED[name]}, {more}"
        return told, f"raise it with {OPTION} {name}=N"


BOUNDS = Bounds()
COUNTED = {one.name: str(one.metadata["counted"]) for one in fields(Bounds)}


@dataclass(slots=True, eq=False, repr=False)
class Tally:
    """Counts one thing over a whole run, and ends the run at its bound.

    Attributes
    ----------
    error
        Of this kind is the error.
    """

    bounds: Bounds
    name: str
    error: type[InputError] = InputError
    count: int = 0

    @property
    def met(self) -> bool:
        """Whether the bound is reached, for what can be left out and told."""
        bound: int = getattr(self.bounds, self.name)
        return self.count >= bound

    def add(self, amount: int, place: Place) -> None:
        """Count on.

        Raises
        ------
        InputErrors
            Above the bound, with the place at which it was met.
        """
        self.count += amount
        if self.count > getattr(self.bounds, self.name):
            raise InputErrors([self.error(place.file, place.line, *self.bounds.refusal(self.name))])
