"""A system of which little is said yet -> what gets out of it if suggestions are right; nothing is written.

In: an answer, as it is stated. Out: ``Trial``. The verdict stays that of what is stated, and at best undetermined.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.suggesting.evidence import written
from rosprivacy.analysis.suggesting.trial import opening, ways_out
from rosprivacy.labelling.asking import with_more
from rosprivacy.labelling.knowledge import NO_FILES
from rosprivacy.labelling.suggesting import suggested

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.evidence import LabelProposal
    from rosprivacy.analysis.suggesting.trial import WayOut
    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

ORIGIN = "what is suggested"  # in place of the name of a label file


class Trial(NamedTuple):
    """What comes of a system if suggestions are right.

    Attributes
    ----------
    stated
        The answer without them, which is the answer.
    supposed
        The proposals that count: none of them closes a way.
    left_out
        Proposals of the same sort that go against what is stated.
    ways
        Places where data gets out, what weighs most first.
    unknown
        Nodes of which neither labels nor suggestions say anything, by name.
    """

    stated: Result
    supposed: tuple[LabelProposal, ...]
    left_out: tuple[LabelProposal, ...]
    ways: tuple[WayOut, ...]
    unknown: tuple[Element, ...]


def tried(stated: Result, settings: Settings, files: UserFiles = NO_FILES) -> Trial:
    """Return what comes of a system if suggestions are right.

    Parameters
    ----------
    stated
        Of a robot, read from files.

    Raises
    ------
    InputErrors
        With every problem of the rules and packages.
    """
    proposals = suggested(stated, settings, files).proposals
    candidates = opening(proposals, sourced=bool(stated.analysis.emitted))
    supposed, after = _supposed(stated, candidates)
    known = frozenset(finding.id for finding in stated.analysis.findings)
    ways = ways_out(after.analysis.findings, supposed, stated.vocabulary.categories, known)
    spoken = {one.label.element.identity for one in proposals}
    elements = stated.analysis.graph.elements
    spoken |= {elements[vertex].identity for vertex, said in stated.bound.elements.items() if said}
    unknown = tuple(element for element in elements if element.is_node and element.identity not in spoken)
    left_out = tuple(one for one in candidates if one not in supposed)
    return Trial(stated, supposed, left_out, ways, tuple(sorted(unknown, key=lambda element: element.name)))


def _supposed(stated: Result, proposals: Sequence[LabelProposal]) -> tuple[tuple[LabelProposal, ...], Result]:
    """All proposals that can be said beside what is stated, and the answer with them."""
    try:
        return tuple(proposals), _with(stated, proposals)
    except InputErrors:
        pass
    fitting: list[LabelProposal] = []
    for one in proposals:
        try:
            _with(stated, [*fitting, one])
        except InputErrors:
            continue
        fitting.append(one)
    return tuple(fitting), _with(stated, fitting)


def _with(stated: Result, proposals: Sequence[LabelProposal]) -> Result:
    after = with_more(stated, (written(one.label) for one in proposals), ORIGIN)
    assert after is not None
    return after
