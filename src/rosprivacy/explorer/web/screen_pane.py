"""The pane of a screen about one element: what it likely does, line by line; and what is told of the last key.

In: the conversation, a session as it stands. Out: a ``Pane``, and a ``Message``. Which element comes, its lines and its
ticks are those of ``suggest --ask``: nothing of that is decided here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.evidence import SANITIZER
from rosprivacy.analysis.suggesting.screens import CHANNELS, ON_A_PAGE
from rosprivacy.analysis.text import printable
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.suggestion_screens import KEYS
from rosprivacy.explorer.web.element_pane import confidence_beside, form_role
from rosprivacy.explorer.web.page import Message
from rosprivacy.explorer.web.panes import Pane, title_of
from rosprivacy.labelling.answered_file import CHANGED
from rosprivacy.labelling.conversation import FOUND_SINCE, UNDO
from rosprivacy.labelling.screen_conversation import (
    BACK,
    NO_ANSWER,
    NOTHING_BEFORE,
    ONE_BY_ONE,
    OPPOSITE,
    STAYS_OPEN,
)

if TYPE_CHECKING:
    from rosprivacy.analysis.suggesting.screens import ScreenLine
    from rosprivacy.explorer.suggestion_screens import SuggestionScreens
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.report.catalogs.words import Words

VALUES = dict(zip(KEYS, ("take", "all", "no", "back", "undo"), strict=True))  # in a form
KEY_OF = {value: key for key, value in VALUES.items()}
FINDINGS = 3  # that are told
NOTES = (STAYS_OPEN, NOTHING_BEFORE, NO_ANSWER)  # remarks on what is no problem
REMARKS = {
    STAYS_OPEN: "open",
    NOTHING_BEFORE: "first",
    NO_ANSWER: "no-answer",
    ONE_BY_ONE: "one-by-one",
    OPPOSITE: "opposite",
    FOUND_SINCE: "since",
    CHANGED: "changed",
}  # what the conversation remarks -> in the reader's language


def screen_pane(screens: SuggestionScreens, standing: Standing, view: PageView, by: str, words: Words) -> Pane:
    """Return what a person sees of the screen in hand, or that none is left."""
    looked = None if screens.waits else screens.look()
    pane = Pane(
        at="", waits=screens.waits, turn=screens.turn, begun=screens.begun, file=shown(str(screens.file)),
        leave=view.to("").address, keys=VALUES, asks_who=not screens.author, by=by,
    )  # fmt: skip
    if looked is None:
        pane.rest = 0 if screens.waits or not screens.begun else screens.rest
        return pane
    screen = looked.screen
    lines = [_line(at, line, at in looked.ticks, standing, words) for at, line in enumerate(screen.lines)]
    does = words.row(words(f"explorer.screen.does.{form_role(role)}") for role in screen.does)
    findings = tuple(dict.fromkeys(shown(told) for line in screen.lines for told in line.closes))
    pane.at = element_id(screen.element.identity)
    pane.leave = view.to(pane.at).address
    pane.name = shown(screen.element.full_name)
    pane.kind = words.of_value(f"kind.{screen.element.kind}", screen.element.kind)
    pane.does = words("explorer.screen.likely" if screen.is_likely else "explorer.screen.perhaps", does=does)
    pane.number = words("explorer.screen.number", n=looked.number, all=looked.number + looked.ahead)
    pane.channels = screen.stage == CHANNELS
    pane.lines = lines
    pane.closing = words.row(words.number(at) for at, line in enumerate(screen.lines, 1) if line.closes)
    pane.closes = words.first(findings, FINDINGS)
    return pane


def _line(at: int, line: ScreenLine, ticked: bool, standing: Standing, words: Words) -> Pane:  # noqa: FBT001 - of a tick
    titles = [title_of(kind, standing.vocabulary, words) for kind in line.kinds]
    if line.role == SANITIZER:
        said = line.replies[0].label.roles[SANITIZER].items()
        vocabulary = standing.vocabulary
        titles = [f"{title_of(kind, vocabulary, words)} ({words(f'explorer.method.{how}')})" for kind, how in said]
    data, to = words.row(titles), title_of(line.to, standing.vocabulary, words) if line.to else ""
    if line.whole and len(titles) > 1:
        data = words("explorer.screen.kinds", n=len(titles), data=data)
    return Pane(
        number=at + 1,
        key=str(at + 1) if at < ON_A_PAGE else "",
        ticked=ticked,
        told=confidence_beside(
            words(f"explorer.tick.{form_role(line.role)}", data=data, to=to), line.confidence, words
        ),
        reasons=tuple(map(printable, line.reasons)),
    )


def told_of_key(screens: SuggestionScreens, key: str, words: Words, *, changed: bool) -> Message | None:
    """Return what is told of a key: that the file is another one, and what the conversation remarks."""
    known = [words(f"explorer.screen.remark.{REMARKS[one]}") for one in screens.remarks if one in REMARKS]
    others = tuple(shown(one) for one in screens.remarks if one not in REMARKS)
    if changed:
        back = key in (BACK, UNDO)
        done = words("explorer.undone") if back else words("explorer.screen.written", file=shown(str(screens.file)))
        known.insert(0, done)
    if not known and not others:
        return None
    text, *notes = known or [words("explorer.screen.remarked")]
    return Message("done" if changed or set(screens.remarks) <= set(NOTES) else "problem", text, tuple(notes), others)
