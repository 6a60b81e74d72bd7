"""The summary for works councils: an HTML file without a script, one A4 page in print for most systems.

In: an ``Outline``. Out: HTML. It tells what the report tells and nothing else: its rows are those of the rights of the
persons, of the register. Which groups of persons are employees the program cannot know: it lists all that labels name,
and those of which nothing is stated. What a council has to know first stands first, where persons are recognised or
judged, and what is open: where there are many places, the table goes on to a second page, and the summary never calls
itself one page.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.page.html import environment_of, hashed, in_html
from rosprivacy.report.page.look_at import unconfirmed_notes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.look_at import LookAt
    from rosprivacy.report.page.outline import Outline
    from rosprivacy.report.page.persons import DataPlace

DECIDED = "measures"  # the field of the assessment that tells what was decided
MARK = "*"  # of a provision of which something is not confirmed; twice for the second such note


class CouncilRow(NamedTuple):
    """Data at a place that are protected alike on their way: whose, and for how long which are kept."""

    persons: str
    periods: tuple[tuple[str, str], ...]
    measures: tuple[str, ...]


class CouncilPlace(NamedTuple):
    """A place where data of persons can get to, and who operates it where, with what can be there."""

    name: str
    kind: str
    recipient: str
    rows: tuple[CouncilRow, ...]


class CouncilLaw(NamedTuple):
    """A provision to look at.

    Attributes
    ----------
    dates
        From when on it applies, with the mark of a note.
    """

    name: str
    meaning: str
    dates: str


class CouncilLaws(NamedTuple):
    """The provisions, when they were read, and what is not confirmed, each with its mark."""

    provisions: tuple[CouncilLaw, ...]
    reviewed: str
    notes: tuple[tuple[str, str], ...]


def works_council(report: Outline) -> str:
    """Return the page. Complexity: O(size of the rights of the persons)."""
    environment, css, _ = environment_of(report.words.language)
    places = tuple(_places(report))
    data = "; ".join(kinds for place in places for row in place.rows for kinds, _ in row.periods)
    page = environment.get_template("works_council.html.j2").render(
        r=report,
        t=in_html(report.words),
        policy=f"default-src 'none'; style-src '{hashed(css)}'; img-src data:; base-uri 'none'; form-action 'none'",
        css=Markup(css),  # noqa: S704 - our own file
        places=places,
        kinds=[kind for kind in report.kinds if kind.title in data],
        measures=[field.line for field in report.assessment.general if field.key == f"sign.{DECIDED}" and field.line],
        laws=_laws(report.further.at_work, report.words),
    )
    return page.strip() + "\n"


def _places(report: Outline) -> Iterator[CouncilPlace]:
    """The places of all groups of persons, each once; what is alike of several groups or kinds of data is one row."""
    groups: dict[DataPlace, list[str]] = {}
    for group in report.persons.rights:
        for place in group.places:
            groups.setdefault(place, []).append(group.name)
    for same in grouped(groups, lambda place: (place.name, place.kind, place.recipient)):
        rows = tuple(
            CouncilRow(
                report.words.row(groups[some[0]]), tuple((at.data, at.retention) for at in some), some[0].measures
            )
            for some in grouped(same, lambda place: (tuple(groups[place]), place.measures))
        )
        yield CouncilPlace(same[0].name, same[0].kind, same[0].recipient, rows)


def _laws(laws: tuple[LookAt, ...], words: Words) -> CouncilLaws:
    """What each says, with its title where that names an act or a judgment; what several share is told once."""
    notes = {note: MARK * number for number, note in enumerate(unconfirmed_notes(laws), 1)}
    return CouncilLaws(
        tuple(
            CouncilLaw(
                name=words.pair(law.name, law.title) if any(map(str.isdigit, law.title)) else law.name,
                meaning=law.meaning,
                dates=law.applies + notes.get(law.unconfirmed, ""),
            )
            for law in laws
        ),
        _reviewed(laws, words),
        tuple((mark, note) for note, mark in notes.items()),
    )


def _reviewed(laws: tuple[LookAt, ...], words: Words) -> str:
    """When we read most of them, and the others by name; empty without any."""
    by_date = Counter(law.reviewed for law in laws)
    if not by_date:
        return ""
    (usual, _), *others = by_date.most_common()
    named = [words.pair(words.row(law.name for law in laws if law.reviewed == date), date) for date, _ in others]
    return "; ".join((words("works_council.reviewed", date=usual), *named))
