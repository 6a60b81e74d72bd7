"""Where things stand in files: the policy line of a step, the label line of a role, the line of a finding.

In: lines of labels, profiles and channels. Out: places. For readers that show a finding beside a line of a
file: every finding has a place, whatever it rests on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.policy_lines import in_a_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion, Step
    from rosprivacy.analysis.model import Element

    Shown = tuple[str, str, str, str]

NOWHERE = Place("the database", 0)  # what people added there by hand stands in no file


class PlaceIndex(NamedTuple):
    """Looks places up.

    Attributes
    ----------
    roles
        (element at an end of a finding, role, category) -> the line of the label that says so.
    channels
        Channel to be reviewed -> a policy line that names it.
    profiles
        Name of a node -> where its profile begins.
    files
        The label files and policies that the answer rests on: the last resort.
    """

    roles: Mapping[tuple[Shown, str, str], Place]
    channels: Mapping[tuple[str, ...], Place]
    profiles: Mapping[str, Place]
    files: tuple[str, ...]

    def of_finding(self, finding: Finding) -> Place:
        """Return the line that lets the data into the leak; the line of a label where no policy line does (S3)."""
        lines = (place for step in reversed(finding.steps) for place in of_step(step))
        said = (
            self.of_role(element, role, finding.category)
            for element, role in ((finding.leak, "leak"), (finding.source, "source"))
        )
        ends = (self.of_profile(element) for element in (finding.leak, finding.source))
        return _first((*lines, *said, *ends, self.last_resort()))

    def of_question(self, question: OpenQuestion) -> Place:
        """Return where an element that nobody has reviewed begins: a node's profile, a line that names a channel."""
        element = question.element
        return _first((self.of_profile(element), self.channels.get(element.shown_as), self.last_resort()))

    def of_role(self, element: Element, role: str, category: str) -> Place | None:
        """Return the line of the label that gives an element a role for a category, None if no file does."""
        return self.roles.get((element.shown_as, role, category))

    def of_profile(self, element: Element) -> Place | None:
        """Return where a node's profile begins, None if it has none."""
        return self.profiles.get(element.name) if element.is_node else None

    def last_resort(self) -> Place:
        """Return the first line of a file that the answer rests on."""
        return next((Place(file, 1) for file in self.files), NOWHERE)


def roles_of(finding: Finding) -> Iterator[tuple[Shown, str, str]]:
    """Yield (element, role, category) of the labels at the ends of a finding: of the data as they begin, too."""
    yield finding.leak.shown_as, "leak", finding.category
    for category in {finding.category, *(step.category for step in finding.steps[:1])}:
        yield finding.source.shown_as, "source", category


def to_review(analysis: Analysis) -> tuple[OpenQuestion, ...]:
    """Return the open questions to begin with: nodes on the frontier, or all where there are none (rule S11)."""
    return tuple(question for question in analysis.open if question.frontier) or analysis.open


def of_step(step: Step) -> list[Place]:
    """Return the lines that allow a step, sorted; none for a step from a wildcard to what it covers."""
    places = {(grant.place.file, grant.place.line) for grant in step.grants if in_a_file(grant.place)}
    return [Place(*place) for place in sorted(places)]


def _first(places: Iterable[Place | None]) -> Place:
    return next(place for place in places if place is not None)
