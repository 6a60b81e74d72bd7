"""What a person is asked of elements, and what can be said of them: rows, replies, questions.

An answer that takes data away is for one row alone, which the person has picked or opened: never for a group. The one
exception are lists of open channels, ``LISTED``: they are shown whole, and confirmed by their number of rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.alike_channels import Alike
    from rosprivacy.analysis.suggesting.written import WrittenLabel

BRINGS_IN, LETS_OUT, MAKES, GOES_ON, GOES_THROUGH = "brings-in", "lets-out", "makes", "goes-on", "through"
LISTED = "listed"
YES, AT_MOST_ONE, NOTHING = "y", "123456789", "0"
OUT, PASSES = "1", "2"  # of nodes
MOST_ROWS = 26  # a letter for each, and no more than a person reads


class Reply(NamedTuple):
    """What can be said of one row.

    Attributes
    ----------
    key
        The sign that says it.
    label
        What is then written.
    takes_away
        Whether it says that data do not go on: it is for one row alone.
    reasons
        Why just this is proposed: they stand in the note.
    """

    key: str
    label: WrittenLabel
    takes_away: bool = False
    reasons: tuple[str, ...] = ()


class Row(NamedTuple):
    """One element, and what can be said of it.

    Attributes
    ----------
    kinds
        The data that it is about.
    replies
        By key. A key that several rows of a question have says the same of each, of its own kinds of data.
    refused
        What is remembered if a person says no.
    closes
        Findings of such data: a reply that takes them away may close these.
    alike
        Of an open channel: what it shares with others of which nothing of it can be said together; empty if it is for
        itself.
    doubtful
        Of an open node: something suggests that it lets data out or ends them, or no policy lets them go on. That it
        only passes on is said of it where it is picked, or alone.
    each
        If it is about several kinds: a row for each of them.
    """

    element: Element
    kinds: tuple[str, ...]
    replies: tuple[Reply, ...]
    reasons: tuple[str, ...]
    refused: tuple[WrittenLabel, ...] = ()
    closes: tuple[str, ...] = ()
    alike: Alike = frozenset()
    doubtful: bool = False
    each: tuple[Row, ...] = ()

    def reply(self, key: str) -> Reply | None:
        """Return what a key says; None if it says nothing here."""
        return next((one for one in self.replies if one.key == key), None)

    def saying(self, key: str) -> Row:
        """Return the row of which nothing can be said any more but what a key says."""
        return self._replace(replies=tuple(one for one in self.replies if one.key == key))


class Question(NamedTuple):
    """Rows that are asked about together.

    Attributes
    ----------
    about
        ``BRINGS_IN``, ``LETS_OUT``, ``MAKES``: what a node does. ``GOES_ON``: open nodes, which let data out, or only
        pass them on. ``GOES_THROUGH``: open channels. ``LISTED``: several of these, of which one thing is said together
        that takes data away, and nothing else can be said.
    """

    about: str
    rows: tuple[Row, ...]

    def keys(self) -> tuple[str, ...]:
        """Return the keys that say something of all rows; of several none that takes data away.

        Of a list none: it is confirmed by its number of rows (``Conversation``).
        """
        if self.about == LISTED:
            return ()
        first, *others = self.rows
        return tuple(
            one.key
            for one in first.replies
            if all(row.reply(one.key) for row in others) and not (others and one.takes_away)
        )
