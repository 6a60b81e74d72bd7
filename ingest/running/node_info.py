"""The text of ``ros2 node info``, from files, standard input or the program itself -> observations.

In: what ``ros2 node list -a``, and ``ros2 node info`` for each node, print on both their outputs, of any distribution
and middleware. Out: ``Observation``, and two doors. The text has no enclaves and no times: when it was taken is said by
who knows. The program is run without a shell; every call ends after some time, what it prints is bounded, and names go
to it as arguments only if a node can have them.

Source: ros2cli 0.36.1, ``ros2node/verb/info.py``: a node's full name alone on a line, sections with two spaces before
them, entries with four, an empty line for an empty section.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass, field, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, MiddlewareError, ObservationError, noting, shown
from rosprivacy.analysis.model import WITHOUT_WARNINGS
from rosprivacy.ingest.policies.observed_metadata import SAME_NAME, STILL_CHANGING, UNANSWERED
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.file_kinds import NODE_INFO, PERMISSIONS, POLICY, kind_of
from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint, ObservedNode, Span, added_up, moment
from rosprivacy.ingest.running.observed_names import is_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.ingest.reading.file_kinds import FileKind
    from rosprivacy.ingest.running.doors import Wait

DOOR = "text"
SECTIONS = {
    "Subscribers": "subscribe",
    "Publishers": "publish",
    "Service Servers": "reply",
    "Service Clients": "request",
    "Action Servers": "execute",
    "Action Clients": "call",
}
MOST_PROBLEMS = 20
HINT = "give the output of `ros2 node info`, one node after the other"
_SECTION = re.compile(r"  ([A-Z][A-Za-z ]+):\s*")
_ALIKE = re.compile(r'There are ([0-9]{1,9}) nodes in the graph with the exact name *"?([^"\s]{0,300})')
_SILENT = re.compile(r"Unable to find node '?([^'\s]{0,300})")
_OF_A_TOOL = re.compile(r"(?:WARNING|\[(?:WARN|INFO|ERROR)\]|[0-9.]+ \[)")
OWN = "/_ros2cli"  # nodes of the program that looks

LONGEST = 64 * 2**20
STANDARD_INPUT = "-"
ANALYSE = "nothing need be observed: rosprivacy analyze FILE"
LIST, INFO = ("node", "list", "--all"), ("node", "info", "--include-hidden")
PATIENCE = 30.0  # seconds for one call
PAUSE = 1.0  # seconds between two looks
LONGEST_ANSWER = 16 * 2**20  # characters of one answer


def read_node_info(text: str, at: str, name: str = "text", *, whole: bool = True) -> Observation:
    r"""Read the text.

    Parameters
    ----------
    at
        When it was taken.
    name
        Of the file, for messages.
    whole
        Whether it is all that was printed about a system; else it is one answer of several.

    Raises
    ------
    InputErrors
        With the first lines that are something else; with one, if no line is of a node.

    Examples
    --------
    >>> seen = read_node_info("/cam\n  Publishers:\n    /image: sensor_msgs/msg/Image\n", "2026-11-22T10:00:00Z")
    >>> [(one.node, one.role, one.name, one.type) for one in seen.endpoints]
    [('/cam', 'publish', '/image', 'sensor_msgs/msg/Image')]
    """
    reader = _NodeInfoReader(name, Span(at, at))
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), 1):
        reader.line(number, line.rstrip())
    if reader.problems:
        raise InputErrors(reader.problems[: MOST_PROBLEMS if reader.nodes else 1])
    reader.ended(whole=whole)
    return Observation(
        (DOOR,), reader.span, tuple(reader.nodes), tuple(reader.endpoints), (), reader.gaps, tuple(reader.remarks)
    )


@dataclass(slots=True)
class _NodeInfoReader:
    """Goes through the lines once."""

    file: str
    span: Span
    node: str = ""
    role: str = ""
    begun: bool = False  # whether a section of the node has come since its name
    names: Counter[str] = field(default_factory=Counter)  # node -> how often its name stands there
    blocks: Counter[str] = field(default_factory=Counter)  # node -> how often with sections behind it
    alike: dict[str, int] = field(default_factory=dict)  # node -> how many the tool says there are
    sections: dict[str, set[str]] = field(default_factory=dict)
    silent: dict[str, str] = field(default_factory=dict)  # node -> what is to be said of it
    warned: bool = False  # whether anything is there of standard error
    shared: bool = False
    nodes: list[ObservedNode] = field(default_factory=list)
    endpoints: list[ObservedEndpoint] = field(default_factory=list)
    gaps: dict[str, int] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    problems: list[InputError] = field(default_factory=list)

    def line(self, number: int, line: str) -> None:
        """One line; what is none of the format's is a problem."""
        if line.startswith("/"):
            self.node, self.role, self.begun = line, "", False
            self.names[line] += 1
            self.nodes.append(ObservedNode(line, self.span))
        elif line.startswith(" "):
            self._of_node(number, line)
        elif line:
            self._of_tool(number, line)

    def _of_node(self, number: int, line: str) -> None:
        section, (name, colon, types) = _SECTION.fullmatch(line), line.partition(":")
        if section and section[1] in SECTIONS and self.node:
            self.role = SECTIONS[section[1]]
            self.blocks[self.node] += not self.begun
            self.begun = True
            self.sections.setdefault(self.node, set()).add(self.role)
        elif colon and self.role and name.startswith("    ") and not name.startswith("     "):
            self.endpoints.extend(self._endpoints(name[4:], types))
        else:
            self._problem(number, line)

    def _of_tool(self, number: int, line: str) -> None:
        """What the tool writes to standard error."""
        self.warned = True
        if match := _ALIKE.match(line):
            self.alike[match[2]] = int(match[1])
        elif match := _SILENT.match(line):
            self.silent[match[1]] = line
        elif "share an exact name" in line:
            self.shared = True
        elif not _OF_A_TOOL.match(line):
            self._problem(number, line)

    def ended(self, *, whole: bool) -> None:
        """What is missing: nodes behind one name, nodes that did not answer, what the tool said beside its answers."""
        for node, heads in self.names.items():
            blocks = self.blocks[node]
            self.alike[node] = max(self.alike.get(node, 1), blocks, heads - blocks)
            if not blocks:
                self.silent.setdefault(node, f"{node}: only its name is there, so what it does is not known")
            elif len(self.sections[node]) < len(SECTIONS):
                self.silent[node] = f"{node}: not all of its sections are there, so not all that it does is known"
        for node, several in self.alike.items():
            self._gap(SAME_NAME, several - 1, f"{several} nodes are named {node}: what only one of them does is known")
        if self.shared:
            self.gaps.setdefault(SAME_NAME, 1)
        for node, remark in self.silent.items():
            self._gap(UNANSWERED, int(not node.startswith(OWN)), remark)
        self.nodes = [one for one in self.nodes if self.blocks[one.name] or not one.name.startswith(OWN)]
        names = (*self.names, *(one.name for one in self.endpoints))
        if whole and not self.warned and not any("/_" in name for name in names):
            self.gaps[WITHOUT_WARNINGS] = 1

    def _endpoints(self, name: str, types: str) -> Iterator[ObservedEndpoint]:
        """One for each type; two types of one channel are two facts."""
        for kind in [part.strip() for part in types.split(",")]:
            yield ObservedEndpoint(self.node, self.role, name, self.span, kind)

    def _gap(self, gap: str, number: int, remark: str) -> None:
        if number > 0:
            self.gaps[gap] = self.gaps.get(gap, 0) + number
            self.remarks.append(shown(remark))

    def _problem(self, number: int, line: str) -> None:
        what = f"not the output of `ros2 node info`: {shown(repr(line))}"
        self.problems.append(ObservationError(self.file, number, what, HINT))


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
        """Read all files; ``InputErrors`` has every problem."""
        yield observed_in(self.files, self._read)

    def _read(self, file: str) -> Iterator[Observation]:
        text, at, name = text_of_what_runs(file, self.at, self.clock)
        yield read_node_info(text, at, name)


def observed_in(files: Iterable[str], read: Callable[[str], Iterable[Observation]]) -> Observation:
    """Return what several files say together; ``InputErrors`` has every problem of all of them."""
    seen: list[Observation] = []
    problems: list[InputError] = []
    for file in files:
        with noting(problems):
            seen += read(file)
    if problems:
        raise InputErrors(problems)
    return added_up(seen)


def text_of_what_runs(
    file: str, at: str, clock: Callable[[], str], purpose: FileKind = NODE_INFO
) -> tuple[str, str, str]:
    """Read a text of what runs.

    Parameters
    ----------
    at, clock
        See ``TextFiles``.
    purpose
        What it has to be.

    Returns
    -------
    text, at, name
        When it was taken, and what the file is called in messages.

    Raises
    ------
    ObservationError
        If it cannot be read, or is something else.
    """

    def fail(line: int, problem: str, hint: str) -> ObservationError:
        return ObservationError(name, line, problem, hint)

    name = "standard input" if file == STANDARD_INPUT else file
    if file == STANDARD_INPUT:
        data = sys.stdin.buffer.read(LONGEST + 1)
        if len(data) > LONGEST:
            raise fail(0, f"more than {LONGEST} bytes", "give it in several files")
        at = at or clock()
    else:
        data = read_regular(file, LONGEST, fail)
        at = at or moment(datetime.fromtimestamp(Path(file).stat().st_mtime, timezone.utc))
    kind = kind_of(data)
    if kind not in (None, purpose):
        instead = ANALYSE if kind in (POLICY, PERMISSIONS) else kind.instead
        raise fail(1, *kind._replace(instead=instead).refused(purpose.name, name))
    try:
        return data.decode("utf-8-sig"), at, name
    except UnicodeDecodeError as error:
        raise fail(data.count(b"\n", 0, error.start) + 1, "not UTF-8", HINT) from None


@dataclass(frozen=True, slots=True)
class Ros2Program:
    """A door that runs ``ros2``.

    Attributes
    ----------
    patience
        Seconds that one call may take.
    pause
        Seconds between two looks.
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
                f"{_notes(command)}: no answer in {self.patience:g} seconds; is ROS running?"
            ) from None
        except OSError as error:
            raise ObservationError(
                "ros2", 0, f"cannot be run: {error.strerror}", "give its output with --text"
            ) from None
        out, said = (data[:LONGEST_ANSWER].decode("utf-8", "replace") for data in (done.stdout, done.stderr))
        if done.returncode and not may_fail:
            why = next((line for line in reversed(said.split("\n")) if line.strip()), "it does not say why")
            raise MiddlewareError(f"{_notes(command)}: failed: {shown(why.strip())}; run it by hand")
        return ("" if done.returncode else out), said


def _argument(word: str) -> bool:
    return is_name(word) or word in (*LIST, *INFO)


def _notes(command: Sequence[str]) -> str:
    return shown(" ".join(("ros2", *command[1:])))


def _facts(look: Observation) -> tuple[object, ...]:
    """What changes when something comes or goes: all but the times."""
    nodes = frozenset((node.name, node.enclave) for node in look.nodes)
    return nodes, frozenset(endpoint.identity for endpoint in look.endpoints)
