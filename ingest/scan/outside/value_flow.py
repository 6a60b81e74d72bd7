"""Where values get to: what is assigned, passed and returned in one file of code, whoever calls what and when.

In: steps between variables, parameters, returns and expressions, and where values begin. Out: of each, the origins that
may get there. The order of statements does not count, and a name is one variable in its scope: more is found than may
happen, nothing of these steps is lost. Each step is taken once for each origin, and after ``LIMIT`` origins no more.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping

LIMIT = 32  # origins of one value


class Origin(NamedTuple):
    """Where a value comes from: the line of the call that makes the end of a channel, or that recognises something."""

    line: int
    recognised: bool = False


class LoggedValue(NamedTuple):
    """A call that writes a value into a log.

    Attributes
    ----------
    unit
        The class or function, at the top of the file, that it stands in; of C++ the class.
    line
        Of the call.
    origins
        Where what is written comes from.
    words
        The names that the code writes for it, without literals.
    """

    unit: str
    line: int
    origins: tuple[Origin, ...]
    words: str


class ValueFlow:
    """Steps that values take."""

    def __init__(self) -> None:
        self._steps: dict[Hashable, list[Hashable]] = defaultdict(list)
        self._origins: dict[Hashable, set[Origin]] = defaultdict(set)

    def step(self, source: Hashable, target: Hashable) -> None:
        """Note that what is in the one can get into the other."""
        self._steps[source].append(target)

    def begin(self, target: Hashable, origin: Origin) -> None:
        """Note that a value begins there."""
        self._origins[target].add(origin)

    def origins(self) -> Mapping[Hashable, frozenset[Origin]]:
        """Return the origins of all that something gets into.

        >>> flow = ValueFlow()
        >>> flow.begin("msg", Origin(3))
        >>> flow.step("msg", "self.text")
        >>> flow.step("self.text", "print")
        >>> flow.origins()["print"]
        frozenset({Origin(line=3, recognised=False)})
        """
        reached: dict[Hashable, set[Origin]] = defaultdict(set)
        waiting = [(place, origin) for place, some in self._origins.items() for origin in sorted(some)]
        while waiting:
            place, origin = waiting.pop()
            here = reached[place]
            if origin in here or len(here) >= LIMIT:
                continue
            here.add(origin)
            waiting += [(target, origin) for target in self._steps.get(place, ())]
        return {place: frozenset(some) for place, some in reached.items()}
