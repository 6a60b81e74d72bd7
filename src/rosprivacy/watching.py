"""Looks of a door, one after the other -> a line for each change, and for each finding that is new (rule S16).

In: label files, and what was there before and is there now. Out: lines, with their time. A finding is told when what
was seen so far makes it: observation only adds. What types of messages cannot carry closes it as long as the types of
all writers that were seen are known (rule S15).
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.answering import answer
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.running.observation import continued
from rosprivacy.ingest.types.types_file import read_types
from rosprivacy.observing import written
from rosprivacy.question import question_of
from rosprivacy.systems.robot_system import lenient_system, read_label_files

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint
    from rosprivacy.settings import Settings


class Watch:
    """What was told already.

    Parameters
    ----------
    labels
        Label files; without any, only changes are told.

    Raises
    ------
    InputErrors
        With every problem of the label files.
    """

    def __init__(self, labels: tuple[str, ...], settings: Settings) -> None:
        self._question = question_of(settings)
        self._labels: list[Labels] = read_label_files(labels, self._question.vocabulary, settings) if labels else []
        self._complete: Observation | None = None
        self._lines_shown: set[str] = set()
        self._missing: set[str] = set()

    def lines(self, before: Observation | None, now: Observation) -> Iterator[str]:
        """Return what changed, and what is found that was not found before."""
        self._complete = now if self._complete is None else continued(self._complete, now)
        at = now.span.last
        yield from (f"{at} {line}" for line in changed(before, now))
        if self._labels and now:
            yield from (f"{at} {line}" for line in self._findings())

    def _findings(self) -> Iterator[str]:
        made = written(self._complete) if self._complete else None
        if made is None:
            return
        with tempfile.TemporaryDirectory(prefix="rosprivacy-observe-") as folder:
            file, types = Path(folder, "observed.policy.xml"), Path(folder, "observed.types.yaml")
            file.write_bytes(made.policy)
            types.write_text(made.types, "utf-8")
            seen = (read_types(str(types), self._question.settings.bounds),)
            system, missing = lenient_system(((read_policy(str(file)),), ()), self._labels, self._question, seen)
        for one in sorted({str(problem) for problem in missing} - self._missing):
            self._missing.add(one)
            yield f"not seen yet: {one}"
        for finding in answer(system, self._question).analysis.findings:
            if finding.stands and finding.id not in self._lines_shown:
                self._lines_shown.add(finding.id)
                path = " -> ".join(shown(element.name) for element in finding.witness)
                yield f"! new finding [{finding.id}]: {finding.category}: {path}"


DOES = {
    "publish": "publishes",
    "subscribe": "subscribes to",
    "reply": "serves",
    "request": "calls",
    "execute": "executes",
    "call": "calls",
}


def changed(before: Observation | None, now: Observation) -> Iterator[str]:
    r"""Return what came (``+``) and what left (``-``); all of it if nothing was there before.

    >>> from rosprivacy.ingest.running.node_info import read_node_info
    >>> look = read_node_info("/cam\n  Publishers:\n    /image: sensor_msgs/msg/Image\n", "2026-11-22T10:00:00Z")
    >>> list(changed(None, look))
    ['+ node /cam', '+ /cam publishes /image (sensor_msgs/msg/Image)']
    """
    for mark, here, there in (("+", now, before), ("-", before, now)):
        known = {node.name for node in there.nodes} if there else set()
        names = {node.name for node in here.nodes} if here else set()
        yield from (f"{mark} node {shown(name)}" for name in sorted(names - known))
        lines = {_line(one) for one in here.endpoints} if here else set()
        yield from (
            f"{mark} {line}" for line in sorted(lines - ({_line(o) for o in there.endpoints} if there else set()))
        )


def _line(endpoint: ObservedEndpoint) -> str:
    who = endpoint.node or f"participant {endpoint.participant}"
    return shown(f"{who} {DOES[endpoint.role]} {endpoint.name}") + (
        f" ({shown(endpoint.type)})" if endpoint.type else ""
    )
