"""Files with the text of ``ros2 node info``, and standard input -> a door.

In: names of files, ``-`` for standard input. Out: a door that has looked when the files were last written.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, ObservationError
from rosprivacy.ingest.observe.node_info import HINT, read_node_info
from rosprivacy.ingest.observe.observation import Observation, added_up, moment
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.file_kinds import NODE_INFO, PERMISSIONS, POLICY, kind_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

LONGEST = 64 * 2**20
STANDARD_INPUT = "-"
ANALYSE = "nothing need be observed: rosprivacy analyze FILE"


@dataclass(frozen=True, slots=True)
class TextFiles:
    """A door of texts that were taken before.

    Attributes
    ----------
    files
        Names of files; ``-`` is standard input.
    clock
        Tells the time, for standard input.
    at
        When the texts were taken, if a user says so; else when each file was last written.
    """

    files: tuple[str, ...]
    clock: Callable[[], str]
    at: str = ""

    def looks(self, seconds: float | None = None) -> Iterator[Observation]:  # noqa: ARG002 - files have looked already
        """Read all files.

        Raises
        ------
        InputErrors
            With what is wrong in any of them.
        """
        seen: list[Observation] = []
        problems: list[InputError] = []
        for file in self.files:
            try:
                seen.append(self._read(file))
            except InputError as error:
                problems.append(error)
            except InputErrors as errors:
                problems += errors.errors
        if problems:
            raise InputErrors(problems)
        yield added_up(seen)

    def _read(self, file: str) -> Observation:
        def fail(line: int, problem: str, hint: str) -> ObservationError:
            return ObservationError(name, line, problem, hint)

        name = "standard input" if file == STANDARD_INPUT else file
        if file == STANDARD_INPUT:
            data = sys.stdin.buffer.read(LONGEST + 1)
            if len(data) > LONGEST:
                raise fail(0, f"more than {LONGEST} bytes", "give it in several files")
            at = self.at or self.clock()
        else:
            data = read_regular(file, LONGEST, fail)
            at = self.at or moment(datetime.fromtimestamp(Path(file).stat().st_mtime, UTC))
        kind = kind_of(data)
        if kind not in (None, NODE_INFO):
            instead = ANALYSE if kind in (POLICY, PERMISSIONS) else kind.instead
            raise fail(1, *kind._replace(instead=instead).refused(NODE_INFO.name, name))
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as error:
            raise fail(data.count(b"\n", 0, error.start) + 1, "not UTF-8", HINT) from None
        return read_node_info(text, at, name)
