"""What of a session a window looks at, as its address says it: which element, which kinds of data, what is looked for.

In: a query string, of anybody. Out: a ``PageView``; what is not known is left out. Nothing of it changes anything.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import parse_qsl, urlencode

if TYPE_CHECKING:
    from collections.abc import Collection

LONGEST = 4_096
ALL = "all"  # in the place of what is drawn
FOUND_BOUND = 200  # letters of what is looked for


class PageView(NamedTuple):
    """What is looked at.

    Attributes
    ----------
    at
        Id of the element in hand; empty for the first question.
    hidden
        Kinds of data that are switched off.
    find
        What names of elements are looked for by.
    whole
        Whether the whole system is drawn, and not only what matters.
    finding
        Id of the finding in hand; empty where an element is in hand.
    closes
        Whether it is told what would close the finding.
    trial
        Name of the trial that is looked at; empty for how it stands.
    ask
        Whether suggestions are gone through, one element a screen.
    """

    at: str = ""
    hidden: tuple[str, ...] = ()
    find: str = ""
    whole: bool = False
    finding: str = ""
    closes: bool = False
    trial: str = ""
    ask: bool = False

    @property
    def address(self) -> str:
        """The page with this view.

        >>> PageView("e1", ("Video", "Voice")).address
        '/?at=e1&hide=Video&hide=Voice'
        """
        pairs = [("at", self.at), *(("hide", kind) for kind in self.hidden), ("find", self.find)]
        pairs += [("draw", ALL)] if self.whole else []
        pairs += [("finding", self.finding), ("closes", "1" if self.closes else ""), ("trial", self.trial)]
        pairs += [("ask", "1" if self.ask else "")]
        query = urlencode([(key, value) for key, value in pairs if value])
        return f"/?{query}" if query else "/"

    def to(self, element: str) -> PageView:
        """Return the view with an element in hand.

        >>> PageView(finding="0123456789abcdef", find="cam").to("e1").address
        '/?at=e1&find=cam'
        """
        return self._replace(at=element, finding="", closes=False, ask=False)

    def switched(self, kind: str) -> PageView:
        """Return the view with a kind of data switched off, or on again.

        >>> PageView(hidden=("Video",)).switched("Video")
        PageView(at='', hidden=(), find='', whole=False, finding='', closes=False, trial='', ask=False)
        """
        if kind in self.hidden:
            return self._replace(hidden=tuple(one for one in self.hidden if one != kind))
        return self._replace(hidden=(*self.hidden, kind))


def trial_in(query: str, trials: Collection[str]) -> str:
    """Return the trial that a query string asks for; empty if there is none of that name.

    >>> trial_in("trial=a+filter&at=e1", {"a filter"})
    'a filter'
    """
    return next((value for key, value in _answer_text(query) if key == "trial" and value in trials), "")


def view_of(
    query: str, elements: Collection[str], kinds: Collection[str], findings: Collection[str] = (), trial: str = ""
) -> PageView:
    """Return the view that a query string asks for.

    Parameters
    ----------
    elements, findings
        Their ids, where a trial is looked at those under it.

    >>> view_of("at=e9&hide=Video&hide=Nothing&find=cam", {"e1"}, {"Video"}).address
    '/?hide=Video&find=cam'
    """
    said = _answer_text(query)
    at = next((value for key, value in said if key == "at" and value in elements), "")
    hidden = dict.fromkeys(value for key, value in said if key == "hide" and value in kinds)
    find = next((value for key, value in said if key == "find"), "")
    finding = next((value for key, value in said if key == "finding" and value in findings), "")
    closes = bool(finding) and ("closes", "1") in said
    ask = ("ask", "1") in said and not (finding or trial)
    return PageView(at, tuple(hidden), find[:FOUND_BOUND], ("draw", ALL) in said, finding, closes, trial, ask)


def _answer_text(query: str) -> list[tuple[str, str]]:
    try:
        return parse_qsl(query[:LONGEST], errors="replace")
    except ValueError:
        return []
