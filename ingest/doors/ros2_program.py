"""The program ``ros2`` on the path, run to see what runs: ``ros2 node list``, then ``ros2 node info`` for each node.

In: how to run it. Out: a door. No shell is used; every call ends after some time; what it prints is bounded and read as
any text of ``ros2 node info``. Names go to it as arguments only if a node can have them.
"""

from __future__ import annotations

import shutil
import subprocess
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import MiddlewareError, ObservationError, shown
from rosprivacy.ingest.observe.node_info import DOOR, OWN, read_node_info
from rosprivacy.ingest.observe.observation import (
    Observation,
    Span,
    added_up,
)
from rosprivacy.ingest.observe.observed_names import is_name
from rosprivacy.ingest.policies.observed_metadata import SAME_NAME, STILL_CHANGING, UNANSWERED

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rosprivacy.ingest.doors.polling import Wait

LIST, INFO = ("node", "list", "--all"), ("node", "info", "--include-hidden")
PATIENCE = 30.0  # seconds for one call
PAUSE = 1.0  # seconds between two looks
LONGEST = 16 * 2**20  # characters of one answer


@dataclass(frozen=True, slots=True)
class Ros2Program:
    """A door that runs ``ros2``.

    Attributes
    ----------
    clock
        Tells the time, as observations hold it.
    patience
        Seconds that one call may take.
    pause
        Seconds between two looks.
    wait
        Waits so many seconds, and returns whether somebody has asked to stop.
    """

    clock: Callable[[], str]
    patience: float = PATIENCE
    pause: float = PAUSE
    wait: Wait = time.sleep

    def looks(self, seconds: float | None) -> Iterator[Observation]:
        """Look at least once; until the time is over, look again and tell what changed.

        Raises
        ------
        ObservationError
            If there is no ``ros2`` on the path.
        MiddlewareError
            If it fails or does not answer.
        """
        program = shutil.which("ros2")
        if program is None:
            hint = "source the setup file of your ROS 2 installation, or give its output with --text"
            raise ObservationError("ros2", 0, "not found on the path", hint)
        end = None if seconds is None else time.monotonic() + seconds
        before: Observation | None = None
        while True:
            now = self._look(program)
            over = end is not None and time.monotonic() + self.pause >= end
            if before is None or _facts(now) != _facts(before) or over:
                yield now
            if over:
                return
            before = now
            if self.wait(self.pause):
                yield now  # the end of the look
                return

    def _look(self, program: str) -> Observation:
        at = self.clock()
        listed, said = self._nodes(program)
        several = [Observation((DOOR,), Span(at, at), gaps={SAME_NAME: 1} if "exact name" in said else {})]
        unanswered = []
        for node in listed:
            answer, _ = self._run(program, *INFO, node, may_fail=True)
            if answer:
                several.append(read_node_info(answer, at, f"ros2 node info {node}", whole=False))
            else:
                unanswered.append(f"{shown(node)}: listed, and then not found; what it does is not known")
        after, _ = self._nodes(program)
        whole = added_up(several)
        gaps = {**whole.gaps, UNANSWERED: whole.gaps.get(UNANSWERED, 0) + len(unanswered)}
        gaps[STILL_CHANGING] = int(after != listed)
        return replace(whole, gaps=gaps, remarks=(*whole.remarks, *unanswered))

    def _nodes(self, program: str) -> tuple[list[str], str]:
        """The nodes that are there, without those that the program makes for itself, and what it warned of."""
        listed, said = self._run(program, *LIST)
        names = sorted({line.strip() for line in listed.split("\n")})
        return [name for name in names if name.startswith("/") and not name.startswith(OWN)], said

    def _run(self, *command: str, may_fail: bool = False) -> tuple[str, str]:
        """What a call prints; empty if it fails and may."""
        if not all(map(_argument, command[1:])):
            return "", ""
        try:
            done = subprocess.run(  # noqa: S603 - a list of arguments, no shell
                command,
                capture_output=True,
                timeout=self.patience,
                stdin=subprocess.DEVNULL,
                check=False,
                start_new_session=True,  # Ctrl-C is for us
            )
        except subprocess.TimeoutExpired:
            raise MiddlewareError(
                f"{_told(command)}: no answer in {self.patience:g} seconds; is ROS running?"
            ) from None
        except OSError as error:
            raise ObservationError(
                "ros2", 0, f"cannot be run: {error.strerror}", "give its output with --text"
            ) from None
        out, said = (data[:LONGEST].decode("utf-8", "replace") for data in (done.stdout, done.stderr))
        if done.returncode and not may_fail:
            why = next((line for line in reversed(said.split("\n")) if line.strip()), "it does not say why")
            raise MiddlewareError(f"{_told(command)}: failed: {shown(why.strip())}; run it by hand")
        return ("" if done.returncode else out), said


def _argument(word: str) -> bool:
    return is_name(word) or word in (*LIST, *INFO)


def _told(command: Sequence[str]) -> str:
    return shown(" ".join(("ros2", *command[1:])))


def _facts(look: Observation) -> tuple[object, ...]:
    """What changes when something comes or goes: all but the times."""
    nodes = frozenset((node.name, node.enclave) for node in look.nodes)
    return nodes, frozenset(endpoint.identity for endpoint in look.endpoints)
