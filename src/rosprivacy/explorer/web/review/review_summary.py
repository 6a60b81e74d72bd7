"""The end of a review: who decided what, what is open, where data gets out. A session goes in, out comes a ``Summary``.

What is said of findings and of law is what the report says: it is made from the same document.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.edits import ROLES
from rosprivacy.explorer.web.left_open import note_before
from rosprivacy.explorer.web.page import verdict_of
from rosprivacy.explorer.web.review.review_questions import named_with_robots
from rosprivacy.explorer.web.titles import titles_of
from rosprivacy.explorer.web.whose import target_told
from rosprivacy.report.page.doubts import in_doubt
from rosprivacy.report.page.finding_entries import finding_entries
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.kinds import kinds

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.explorer.web.review.review_questions import Asked
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.kinds import Kind


class Decided(NamedTuple):
    """What somebody said of an element."""

    name: str
    said: tuple[str, ...]
    why: str
    by: str


class Open(NamedTuple):
    """What is not decided; ``left`` is what the engineer is to be asked, ``beyond`` as of ``Asked``."""

    id: str
    name: str
    left: str
    can_wait: bool
    beyond: bool


class Summary(NamedTuple):
    """What a review ends with.

    Attributes
    ----------
    verdict
        In words of a review.
    end
        What has to be known of the answers, in sentences.
    kinds
        Kinds of data that get out, with the findings and the provisions to look at.
    followed
        Whether somebody named what brings data in; else nothing was looked for.
    answered
        Whether the file of answers says anything.
    """

    verdict: str
    end: tuple[str, ...]
    decided: tuple[Decided, ...]
    open: tuple[Open, ...]
    kinds: tuple[Kind, ...]
    followed: bool
    answered: bool


def summary_of(standing: Standing, questions: Sequence[Asked], words: Words) -> Summary:
    """Return how a review stands."""
    index = Index(standing.session.result.document(), words)
    verdict = verdict_of(standing)
    decided, followed = tuple(_decided(standing, words)), bool(standing.analysis.emitted)
    return Summary(
        verdict=words.known(f"rv.verdict.{verdict}", words.known(f"verdict.{verdict}", verdict)),
        end=(*_end(questions, words, decided=bool(decided), followed=followed), *in_doubt(index)),
        decided=decided,
        open=tuple(_open(one, standing, words) for one in questions),
        kinds=tuple(kind for kind in kinds(index, finding_entries(index)) if kind.entries),
        followed=followed,
        answered=bool(standing.session.answers),
    )


def _end(questions: Sequence[Asked], words: Words, *, decided: bool, followed: bool) -> Iterator[str]:
    """What has to be known of the answers, in sentences; that nothing was followed comes first."""
    if not followed:
        yield words("rv.end.nothing")
    if questions:
        yield words.count(len(questions), "rv.end.open")
    elif followed:
        yield words("rv.end.none" if decided else "rv.end.unasked")


def _decided(standing: Standing, words: Words) -> Iterator[Decided]:
    titles = titles_of(standing.vocabulary, words)
    for one in standing.session.answers:
        said = tuple(_said(one.value, titles, words))
        told = one.value if isinstance(one.value, dict) else {}
        why = note_before(one.value)
        if said or why:
            name = words.row([shown(one.name), *([target_told(one.target, words)] if one.target else [])])
            yield Decided(name, said, shown(why), shown(str(told.get("author") or "")))


def _open(one: Asked, standing: Standing, words: Words) -> Open:
    name = named_with_robots(one.element, standing, words)
    return Open(one.id, name, shown(one.left), one.can_wait, one.beyond)


def _said(entry: Any, titles: Mapping[str, str], words: Words) -> Iterator[str]:
    """What an entry of a label file says, in plain words."""
    if isinstance(entry, str):
        yield words.known(f"rv.said.{entry}", shown(entry))
    for role in ROLES if isinstance(entry, dict) else ():
        if role in entry:
            what = _what(entry[role], titles, words)
            told = words(f"rv.said.{role}")
            yield words.pair(told, what) if what else told


def _what(said: Any, titles: Mapping[str, str], words: Words) -> str:
    """The kinds of data, or the reason, that a role is said with."""
    if said is True or said is None:
        return ""
    if isinstance(said, dict):
        kinds = said.keys() - {"from", "to"}
        if not kinds:  # a derivation
            return words(
                "rv.made", data=_what(said.get("from"), titles, words), to=_what(said.get("to"), titles, words)
            )
        return words.row(titles.get(kind, shown(str(kind))) for kind in said)
    if isinstance(said, list | tuple):
        return words.row(_what(one, titles, words) for one in said)
    return titles.get(str(said), shown(str(said)))
