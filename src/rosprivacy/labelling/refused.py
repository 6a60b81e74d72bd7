"""What a person has said no to, in the label files that an answer rests on: it is not suggested again."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.suggesting.evidence import LEAK
from rosprivacy.analysis.suggesting.reached_kinds import narrowed
from rosprivacy.analysis.suggesting.written import written
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.yaml_values import MAX_BYTES
from rosprivacy.ingest.suggestions.refusals import refusal_key, refusals_in

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.suggesting.evidence import Label
    from rosprivacy.result import Result

    Identity = tuple[str, str, str]


class Refused(NamedTuple):
    """What was refused.

    Attributes
    ----------
    of_robots
        By robot, as ``refusal_key`` has it; a system that is no fleet is the robot without a name.
    """

    of_robots: Mapping[str, frozenset[str]]
    hierarchy: Hierarchy

    def says(self, label: Label) -> bool:
        """Return whether a label was refused; of a leak, that a broader kind gets out was, too."""
        keys = self.of_robots.get(label.element.robot, self.of_robots.get("", frozenset()))
        kinds = self.hierarchy.ancestors[label.kind] if label.role == LEAK and label.kind else (label.kind,)
        return bool(keys) and any(refusal_key(written(label._replace(kind=kind))) in keys for kind in kinds)

    def silences(self, label: Label, reached: Mapping[Identity, Iterable[str]]) -> bool:
        """Return whether a label need not be suggested: a leak, if all that gets there now was refused.

        Parameters
        ----------
        reached
            Kinds of data that get to elements.
        """
        if self.says(label):
            return True
        there = reached.get(label.element.identity, ()) if label.role == LEAK else ()
        kinds = narrowed(label.kind, there, self.hierarchy)
        return bool(kinds) and all(self.says(label._replace(kind=kind)) for kind in kinds)


def refused_in(result: Result) -> Refused:
    """Return it; of a file that is gone by now, nothing.

    Of robots that are alike, of which one is asked about, only what was refused of each: a no for one robot is none
    for another.

    Raises
    ------
    LabelError
        If a file cannot be read any more.
    """
    own = [one["file"] for one in result.assumptions.get("labels", ())]
    if result.fleet is None:
        return Refused({"": _in_files(own)}, result.vocabulary.hierarchy)
    likeness = result.fleet.likeness
    read = {files: _in_files(files) for files in set(result.label_files.values())}
    of_robots = {
        robot: frozenset.intersection(*(read[result.label_files[one]] for one in likeness.members.get(robot, [robot])))
        for robot in result.label_files
        if robot not in likeness.second
    }
    return Refused(of_robots, result.vocabulary.hierarchy)


def _in_files(files: Iterable[str]) -> frozenset[str]:
    own = [file for file in files if not file.startswith(OURS) and Path(file).is_file()]
    texts = (read_utf8(file, MAX_BYTES, partial(LabelError, file))[0] for file in own)
    return frozenset().union(*map(refusals_in, texts))
