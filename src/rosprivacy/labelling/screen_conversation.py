"""Screens to a person, one element at a time, until nothing is left to look at or the person stops.

In: which screens there are now, who looks at them, and what keeps an answer. Out: how it ended. It knows no terminal,
no page and no file. ``ScreenConversation`` asks somebody for the next key, ``ScreenSteps`` is given one key after the
other; both go the same way. Every answer is kept before the next screen. What a person leaves open is not stated, and
not asked again in this conversation; but an exit that gets more kinds of data is, if the person has said that it is
one.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, Protocol

from rosprivacy.analysis.suggesting.evidence import DERIVATION, SOURCE, SURE, WrittenLabel
from rosprivacy.analysis.suggesting.screens import CHANNELS, ON_A_PAGE, ticked_beforehand, toggled
from rosprivacy.labelling.conversation import FOUND_SINCE, NO, QUIT, UNDO

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rosprivacy.analysis.suggesting.evidence import Identity
    from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine

ENTER, BACK, MORE, LISTS, ALL = "\n", "b", "+", "l", "a"
STAYS_OPEN = "nothing is ticked: nothing is written, and it stays open"
NOTHING_BEFORE = "this is the first screen"
NO_ANSWER = "there is no answer to take back"
ONE_BY_ONE = "what could hide a leak is taken by Enter, for one channel"
OPPOSITE = "a line that is ticked says the opposite: untick that first"


class Listener(Protocol):
    """Who hears what becomes of answers."""

    def remark(self, remark: str) -> None:
        """Hear what became of the answer."""
        ...


class Viewer(Listener, Protocol):
    """Who looks at screens, and gives a key for each."""

    def key(self, screen: Screen, ticks: frozenset[int], first: int) -> str | WrittenLabel:
        """Return a key, or a label in place of an answer; nothing if there is no more.

        Parameters
        ----------
        first
            The place of the first line that is shown.
        """
        ...

    def screens_ahead(self, number: int) -> None:
        """Hear how many screens come after the next one, as far as it is known."""
        ...

    def end(self, rest: int) -> str:
        """Return a key where no screen is left, but other elements are that can be asked about."""
        ...


class Step(NamedTuple):
    """What a person did: with a screen, or by a label that was typed in place of an answer.

    Attributes
    ----------
    changes
        How many changes of the file it made.
    """

    screen: Screen | None
    ticks: frozenset[int] = frozenset()
    changes: int = 0
    refused: bool = False


class ScreenInHand(NamedTuple):
    """The screen that a person looks at.

    Attributes
    ----------
    first
        The place of the first line that has a number.
    number
        Which screen it is, of those that were looked at; the first is 1.
    ahead
        How many come after it, as far as it is known.
    """

    screen: Screen
    ticks: frozenset[int]
    number: int
    ahead: int
    first: int = 0


@dataclass
class ScreenSteps:
    """One conversation, key by key.

    Attributes
    ----------
    now
        The screens under the labels as they are.
    keep, refuse
        Keeps lines as labels, or that they were refused, before it returns; returns remarks if it could not.
    typed
        Keeps a label that was typed in place of an answer; returns remarks.
    undo
        Takes so many changes back that were made last; returns why not, or nothing.
    rest
        How many elements are on no screen, and can be asked about as lists.
    """

    now: Callable[[], Sequence[Screen]]
    keep: Callable[[Sequence[ScreenLine]], tuple[str, ...]]
    refuse: Callable[[Sequence[ScreenLine]], tuple[str, ...]]
    viewer: Listener
    typed: Callable[[WrittenLabel], tuple[str, ...]] = lambda _: ("no label is kept here",)
    undo: Callable[[int], str] = lambda _: "nothing is taken back here"
    rest: Callable[[], int] = lambda: 0
    steps: list[Step] = field(default_factory=list)
    _in_hand: ScreenInHand | None = None
    _pending: list[Screen] = field(default_factory=list)
    _stale: bool = True
    _revisited: Step | None = None  # whose screen comes next

    @property
    def answers(self) -> int:
        """How many answers are kept."""
        return sum(bool(step.changes) for step in self.steps)

    def look(self) -> ScreenInHand | None:
        """Return the screen in hand, the same one until it is answered; nothing if none is left."""
        if self._in_hand is None and (screen := self._next()):
            number = 1 + sum(step.screen is not None for step in self.steps)
            ticks = self._first_ticks(screen)
            self._in_hand = ScreenInHand(screen, ticks, number, len(self._unseen_screens()) - 1)
        return self._in_hand

    def press(self, key: str | WrittenLabel) -> None:
        """Do what a key says of the screen in hand, or, where none is left, go back."""
        if self._in_hand is None:
            if key in (BACK, UNDO):
                self._back(to_answer=key == UNDO)
            return
        screen, ticks, _, _, first = self._in_hand
        if key == MORE:
            first = first + ON_A_PAGE if first + ON_A_PAGE < len(screen.lines) else 0
            self._in_hand = self._in_hand._replace(first=first)
        elif isinstance(key, str) and key in "123456789" and first + int(key) <= len(screen.lines):
            self.tick(first + int(key) - 1)
        elif self._answered(screen, ticks, key):
            self._in_hand = None

    def tick(self, at: int) -> None:
        """Tick a line of the screen in hand, or untick it."""
        if self._in_hand:
            ticks = self._toggled(self._in_hand.screen, self._in_hand.ticks, at)
            self._in_hand = self._in_hand._replace(ticks=ticks)

    def renew(self) -> None:
        """Look anew, since labels were changed elsewhere: the screen in hand keeps its ticks, if it is there still."""
        if self._in_hand:
            self._revisited = Step(self._in_hand.screen, self._in_hand.ticks)
        self._in_hand, self._stale = None, True

    def _next(self) -> Screen | None:
        """The next screen, without what the person has looked at; nothing if there is no more."""
        again = self._revisited.screen if self._revisited else None
        ahead = self._unseen_screens()
        if self._stale and not (ahead and _begins_data(ahead[0]) and again is None):
            self._pending, self._stale = list(self.now()), False
            ahead = self._unseen_screens()
        if again is not None:
            ahead.sort(key=lambda screen: screen.element.identity != again.element.identity)
        return ahead[0] if ahead else None

    def _unseen_screens(self) -> list[Screen]:
        passed = _passed(self.steps)
        screens = (
            screen._replace(
                lines=tuple(line for line in screen.lines if not _is_passed(screen.element.identity, line, passed))
            )
            for screen in self._pending
        )
        return [screen for screen in screens if any(line.asks for line in screen.lines)]

    def _first_ticks(self, screen: Screen) -> frozenset[int]:
        """What is ticked beforehand; where a person comes back, what was ticked then."""
        before, self._revisited = self._revisited, None
        if before is None or before.screen is None or before.screen.element != screen.element:
            return ticked_beforehand(screen)
        ticked = {before.screen.lines[at].parts for at in before.ticks}
        return frozenset(at for at, line in enumerate(screen.lines) if line.parts in ticked)

    def _toggled(self, screen: Screen, ticks: frozenset[int], at: int) -> frozenset[int]:
        after = toggled(screen, ticks, at)
        if after == ticks:
            self.viewer.remark(OPPOSITE)
        return after

    def _answered(self, screen: Screen, ticks: frozenset[int], key: str | WrittenLabel) -> bool:
        """Take an answer; return whether the screen is left."""
        if isinstance(key, WrittenLabel):
            self._record(Step(None, changes=1), self.typed(key))
            return True
        if key == ENTER:
            return self._take(screen, ticks)
        if key == ALL and screen.stage == CHANNELS:
            return self._take_channels(screen, ticks)
        if key == NO:
            self._record(Step(screen, ticks, 1, refused=True), self.refuse(screen.lines))
            return True
        if key in (BACK, UNDO):
            return self._back(to_answer=key == UNDO)
        self.viewer.remark(f"{key!r} is no answer here")
        return False

    def _take(self, screen: Screen, ticks: frozenset[int]) -> bool:
        """Keep the lines that are ticked; the others stay open."""
        lines = [screen.lines[at] for at in sorted(ticks)]
        if not lines:
            self.viewer.remark(STAYS_OPEN)
        if any(line.hides for line in lines) and self._would_close_untold(screen, lines):
            self.viewer.remark(FOUND_SINCE)
            self._stale = True
            return True
        remarks = self.keep(lines) if lines else ()
        self._record(Step(screen, ticks, changes=int(bool(lines))), remarks)
        return True

    def _take_channels(self, screen: Screen, ticks: frozenset[int]) -> bool:
        """Keep what is ticked on the screen of a channel, and on those of all further channels as it was beforehand."""
        lines = [screen.lines[at] for at in sorted(ticks)]
        if any(line.hides for line in lines):
            self.viewer.remark(ONE_BY_ONE)
            return False
        others = [one for one in self._unseen_screens() if one.stage == CHANNELS and one.element != screen.element]
        lines += [line for one in others for line in one.lines if line.ticked]
        self._record(Step(screen, ticks, changes=int(bool(lines))), self.keep(lines) if lines else ())
        self.steps += [Step(one, ticked_beforehand(one)) for one in others]
        return True

    def _would_close_untold(self, screen: Screen, lines: Sequence[ScreenLine]) -> bool:
        """Whether a line could close a finding that the screen did not tell: the file may have changed."""
        now = [one for one in self.now() if one.element == screen.element]
        there = [line for one in now for line in one.lines]
        return any(
            not any(line.parts <= other.parts and set(other.closes) <= set(line.closes) for other in there)
            for line in lines
            if line.hides
        )

    def _record(self, step: Step, remarks: Sequence[str]) -> None:
        for remark in remarks:
            self.viewer.remark(remark)
        self.steps.append(step)
        self._stale = self._stale or bool(step.changes)

    def _back(self, *, to_answer: bool) -> bool:
        """Go back to the last screen, or to the last answer, and take back what was said there; return whether."""
        at = len(self.steps) - 1
        while to_answer and at >= 0 and not self.steps[at].changes:
            at -= 1
        if at < 0:
            self.viewer.remark(NO_ANSWER if to_answer else NOTHING_BEFORE)
            return False
        step = self.steps[at]
        why = self.undo(step.changes) if step.changes else ""
        if why:
            self.viewer.remark(why)
            return False
        del self.steps[at:]
        self._revisited, self._stale = step, True
        return True


@dataclass
class ScreenConversation(ScreenSteps):
    """One conversation with somebody who gives a key whenever a screen is shown."""

    viewer: Viewer

    def run(self) -> str:
        """Show screens; return nothing if none is left, else the key by which the person has stopped."""
        while True:
            looked = self.look()
            if looked is None and not (self.steps and (rest := self.rest())):
                return ""
            if looked is None:
                key: str | WrittenLabel = self.viewer.end(rest)
                if key not in (BACK, UNDO):
                    return LISTS if key == LISTS else QUIT
            else:
                self.viewer.screens_ahead(looked.ahead)
                key = self.viewer.key(looked.screen, looked.ticks, looked.first)
                if key in ("", QUIT, LISTS):
                    return str(key) or QUIT
            self.press(key)


def _begins_data(screen: Screen) -> bool:
    """Whether a screen says only where data begin, for sure: no other answer changes it."""
    return all(line.role == SOURCE for line in screen.lines) and any(line.confidence in SURE for line in screen.lines)


def _passed(steps: Sequence[Step]) -> frozenset[object]:
    """What a person has looked at: of lines that were ticked or refused each kind, of what was left open the role."""
    passed: set[object] = set()
    for step in steps:
        for at, line in enumerate(step.screen.lines if step.screen else ()):
            identity = step.screen.element.identity if step.screen else None
            by_kind = step.refused or at in step.ticks or line.role in (SOURCE, DERIVATION)
            passed |= {(identity, part) for part in line.parts} if by_kind else {(identity, line.role)}
    return frozenset(passed)


def _is_passed(identity: Identity, line: ScreenLine, passed: frozenset[object]) -> bool:
    return (identity, line.role) in passed or all((identity, part) in passed for part in line.parts)
