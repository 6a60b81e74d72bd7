"""What stands in one version of a session: made when a page first asks for it, and kept until the next edit.

In: a ``Session``. Out: elements by id, questions, suggestions, why data gets to an element.
"""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.witness import WhyCarried
from rosprivacy.analysis.kernel.vertices import by_identity
from rosprivacy.analysis.suggesting.label_questions import reached_kinds
from rosprivacy.explorer.edits import by_id, element_id
from rosprivacy.explorer.questions import questions
from rosprivacy.mitigation import REPORTED, run_mitigation
from rosprivacy.report.document.analysis import label_key

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from typing import Any

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.review_order import Behind, Shown
    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.questions import RankedQuestion
    from rosprivacy.explorer.session import Session
    from rosprivacy.labelling.suggesting_on_demand import Suggester, Suggestions
    from rosprivacy.mitigation import Mitigation
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result


class Standing:
    """A session as it stands at one version.

    Parameters
    ----------
    suggester
        What suggestions are made by.
    trial
        The answer of a trial that is looked at; None for that of now.
    """

    def __init__(self, session: Session, suggester: Suggester, trial: Result | None = None) -> None:
        self.session, self._suggester, self._trial = session, suggester, trial
        self.version = session.version
        self.result: Result = trial or session.uncounted
        self.analysis: Analysis = self.result.shown
        self.vocabulary: Vocabulary = self.result.vocabulary

    @cached_property
    def elements(self) -> Mapping[str, Element]:
        """All elements, by id."""
        return self.analysis.spread.shape.memoised("page: elements", None, lambda: by_id(self.analysis.graph))

    @cached_property
    def questions(self) -> Sequence[RankedQuestion]:
        """What is left to decide, of each element once: the legs of a service are one question to a person."""
        seen: dict[tuple[str, str, str], RankedQuestion] = {}
        for question in questions(self.result, self.session.outliers, self.order):
            identity = question.element.identity
            first = seen.setdefault(identity, question)
            if first is not question:
                seen[identity] = first._replace(kinds=tuple(sorted({*first.kinds, *question.kinds})))
        return tuple(seen.values())

    @property
    def whole(self) -> Result:
        """The whole answer, which takes longer."""
        return self._trial or self.session.result

    @cached_property
    def findings(self) -> Mapping[str, Finding]:
        """Findings by id."""
        return {finding.id: finding for finding in self.analysis.findings}

    @cached_property
    def document(self) -> Mapping[str, Any]:
        """The document of the answer, for texts that reports have too."""
        return self.whole.document()

    @cached_property
    def mitigation(self) -> Mitigation | None:
        """What would close the findings; None if they are too many to be asked about while a person waits."""
        standing = sum(finding.stands for finding in self.analysis.findings)
        return run_mitigation(self.whole, bounds=self.whole.options.bounds) if standing <= REPORTED else None

    @cached_property
    def open_kinds(self) -> Mapping[str, tuple[str, ...]]:
        """Id of an open element -> the kinds that are open there."""
        return {element_id(question.element.identity): question.kinds for question in self.questions}

    @cached_property
    def order(self) -> Mapping[Shown, Behind]:
        """What stands behind each open element."""
        return self.result.review_order

    @cached_property
    def suggestions(self) -> Suggestions:
        """What could be said of elements."""
        return self._suggester.under(self.result, self.order)

    @cached_property
    def carried(self) -> Mapping[str, tuple[str, ...]]:
        """Id of an element -> kinds of data that are there, in whichever form."""

        def find() -> dict[str, tuple[str, ...]]:
            return {element_id(at): kinds for at, kinds in reached_kinds(self.analysis).items()}

        return self.analysis.spread.course.memoised("page: carried", self.analysis.carried, find)

    @cached_property
    def roles(self) -> Mapping[str, Mapping[str, tuple[str, ...]]]:
        """Id of an element -> kind of data -> what labels say that it does with it."""
        return {element_id(element.identity): roles for element, roles in self.analysis.roles.items()}

    def parts(self, identity: tuple[str, str, str]) -> tuple[Element, ...]:
        """Return what an element is made of: legs of services, sides of wildcards."""
        elements = self.analysis.graph.elements
        return tuple(elements[vertex] for vertex in by_identity(self.analysis.spread)[identity])

    @cached_property
    def why(self) -> WhyCarried:
        """Shortest paths to elements."""
        return WhyCarried(self.result.analysis)

    @cached_property
    def places(self) -> Mapping[tuple[str, str], Sequence[str]]:
        """Section and name, as a label file says them -> ids of elements; of robots that are alike, of the first."""
        places: dict[tuple[str, str], list[str]] = {}
        for at, element in self.elements.items():
            if element.robot not in self.second:
                key = label_key(element)
                places.setdefault((key["section"], key["name"]), []).append(at)
        return places

    @property
    def second(self) -> Collection[str]:
        """Robots that only stand beside others that they are alike to."""
        return self.result.fleet.likeness.second if self.result.fleet else ()

    @cached_property
    def spoken(self) -> frozenset[str]:
        """Ids of the elements that a label file speaks of, by their names."""
        places = [(self.elements[at].robot, place, at) for place, ids in self.places.items() for at in ids]
        says = {robot: self.session.entries_for(robot) for robot in dict.fromkeys(robot for robot, _, _ in places)}
        return frozenset(at for robot, place, at in places if says[robot].get(place) is not None)

    def place_of(self, edit: Edit) -> str:
        """Return the id of an element that an edit is about, an open one first; empty if there is none now."""
        file = os.path.realpath(edit.file)
        about = [
            at
            for at in self.places.get((edit.section, edit.name), ())
            if any(os.path.realpath(target.file) == file for target in self.session.targets_of(self.elements[at]))
        ]
        return next((at for at in self.open_kinds if at in about), about[0] if about else "")

    def entries_of(self, element: Element) -> tuple[Any, ...]:
        """Return what label files say of an element: a robot's own first, and that of its model."""
        entries = (self.session.entry_for(element, only_this_robot=alone) for alone in (True, False))
        return tuple(entry for entry in entries if entry is not None)
