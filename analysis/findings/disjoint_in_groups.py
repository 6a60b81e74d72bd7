"""How many paths share no flow, where groups of wildcards meet: no pair of a group is looked at but those on a path.

In: steps between states, and groups: some states from each of which a step leads to each of others. Out: the number of
paths that share no step. By layers and blocking flows, each step of capacity one (Dinic 1970; Even and Tarjan 1975).
"""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.bounds import Tally

State = int
Step = tuple[State, State]
Group = tuple[list[State], list[State]]


def number_in_groups(steps: Sequence[Step], groups: Sequence[Group], source: State, leak: State, work: Tally) -> int:
    """Return how many paths from a source to a leak share no step.

    Parameters
    ----------
    groups
        (states, those to each of which there is a step from each of these); no step is there twice.

    Notes
    -----
    O(steps and members of groups), for each of a few rounds.

    Examples
    --------
    >>> from rosprivacy.analysis.bounds import BOUNDS, Tally
    >>> camera, left, right, cloud = range(4)
    >>> groups = [([camera], [left, right]), ([left, right], [cloud])]
    >>> number_in_groups([], groups, camera, cloud, Tally(BOUNDS, "path_steps"))
    2
    """
    search = _Search(steps, groups, source, leak, work)
    number, most = 0, search.upper_bound()
    while number < most and search.layers():
        number += search.blocking()
    return number


class _Search:
    """Steps that no path takes, and those that one does, in rounds."""

    def __init__(self, steps: Sequence[Step], groups: Sequence[Group], source: State, leak: State, work: Tally) -> None:
        self._source, self._leak, self._groups, self._work = source, leak, groups, work
        self._ahead: dict[State, list[State]] = defaultdict(list)
        for before, after in steps:
            self._ahead[before].append(after)
        self._of: dict[State, list[int]] = defaultdict(list)
        for number, (befores, _) in enumerate(groups):
            for before in befores:
                self._of[before].append(number)
        self._into = sum(after == leak for _, after in steps)
        self._path_steps: dict[State, set[State]] = defaultdict(set)  # step of a path, from its end
        self._layer: dict[State, int] = {}

    def upper_bound(self) -> int:
        """No more than there are steps out of the source, or into the leak."""
        out = len(self._ahead[self._source]) + sum(len(self._groups[n][1]) for n in self._of[self._source])
        return min(out, self._into + sum(len(befores) for befores, afters in self._groups if self._leak in afters))

    def layers(self) -> bool:
        """Number the states by steps from the source; whether the leak is among them."""
        self._layer = {self._source: 0}
        left = [list(afters) for _, afters in self._groups]  # not numbered yet
        now = [self._source]
        while now and self._leak not in self._layer:
            new: list[State] = []
            for here in now:
                nexts = [after for after in self._ahead.get(here, ()) if here not in self._path_steps[after]]
                nexts += sorted(self._path_steps[here])
                for number in self._of.get(here, ()):
                    nexts += (after for after in left[number] if here not in self._path_steps[after])
                    left[number] = [after for after in left[number] if here in self._path_steps[after]]
                self._work.count += len(nexts) + 1
                for after in nexts:
                    if after not in self._layer:
                        self._layer[after] = self._layer[here] + 1
                        new.append(after)
            now = new
        return self._leak in self._layer

    def blocking(self) -> int:
        """Take paths from layer to layer until there is none; return how many."""
        waiting: dict[State, list[State]] = {}
        members: list[dict[int, list[State]]] = []
        for _, afters in self._groups:
            by_layer: dict[int, list[State]] = defaultdict(list)
            for after in afters:
                by_layer[self._layer.get(after, -1)].append(after)
            members.append(by_layer)
        dead: set[State] = set()
        number = 0
        path = [self._source]
        while path:
            here = path[-1]
            if here == self._leak:
                self._take(path)
                number, path = number + 1, [self._source]
                continue
            there = self._next(here, waiting, members, dead)
            if there is None:
                dead.add(path.pop())
            else:
                path.append(there)
        return number

    def _next(
        self, state: State, waiting: dict[State, list[State]], members: list[dict[int, list[State]]], dead: set[State]
    ) -> State | None:
        """A state of the next layer that may lead to the leak; each step is tried once."""
        layer = self._layer[state] + 1
        if state not in waiting:
            free = [after for after in self._ahead.get(state, ()) if state not in self._path_steps[after]]
            every = [*free, *sorted(self._path_steps[state])]
            waiting[state] = [after for after in every if self._layer.get(after) == layer]
            self._work.count += len(every) + 1
        while waiting[state]:
            after = waiting[state].pop()
            if after not in dead:
                return after
        for number in self._of.get(state, ()):
            some = members[number].get(layer, [])
            at = len(some) - 1
            while at >= 0:
                self._work.count += 1
                if some[at] in dead:  # for all of the group
                    some[at] = some[-1]
                    some.pop()
                elif state not in self._path_steps[some[at]]:
                    return some[at]
                at -= 1
        return None

    def _take(self, path: list[State]) -> None:
        for before, after in pairwise(path):
            self._work.count += 1
            if after in self._path_steps[before]:  # against the direction: taken back
                self._path_steps[before].remove(after)
            else:
                self._path_steps[after].add(before)
