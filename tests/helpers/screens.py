"""Screens of ``rosprivacy suggest --ask`` as tests look at them: as a person in Python, or at a terminal."""

from __future__ import annotations

import os
import pty
import subprocess
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.screens import CHANNELS
from rosprivacy.labelling.asking import off_screens, screens_now, with_lines, with_refusal
from rosprivacy.labelling.screen_conversation import ALL, ENTER, STAYS_OPEN, ScreenConversation
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import DAY, read_until, wait_for_keys
from tests.helpers.observed import robot_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from typing import Any

    from rosprivacy.analysis.suggesting.evidence import WrittenLabel
    from rosprivacy.analysis.suggesting.screens import Screen, ScreenLine
    from rosprivacy.labelling.suggesting import Suggested
    from tests.helpers.command import Cli

PROMPT = b"\n> "


class Looking:
    """Somebody whose keys a function chooses; what is shown is kept."""

    def __init__(self, choose: Callable[[Screen, frozenset[int], int], str | WrittenLabel], last: str = ENTER) -> None:
        self.choose, self.last = choose, last
        self.shown: list[Screen] = []
        self.keys: list[str | WrittenLabel] = []
        self.remarks: list[str] = []
        self.left_open = 0

    def key(self, screen: Screen, ticks: frozenset[int], first: int) -> str | WrittenLabel:
        if not self.shown or self.shown[-1] != screen:
            self.shown.append(screen)
        self.keys.append(self.choose(screen, ticks, first))
        return self.keys[-1]

    def screens_ahead(self, number: int) -> None:
        assert number >= 0

    def end(self, rest: int) -> str:
        assert rest
        self.keys.append(self.last)
        return self.last

    def remark(self, remark: str) -> None:
        if remark == STAYS_OPEN:
            self.left_open += 1
        else:
            self.remarks.append(remark)


def looking(*keys: str) -> Looking:
    """Return somebody who presses these keys, and then stops."""
    left = [*keys]
    return Looking(lambda *_: left.pop(0) if left else "q")


def entering() -> Looking:
    """Return somebody who presses Enter, whatever is shown."""
    return Looking(lambda *_: ENTER)


def hurrying() -> Looking:
    """Return somebody who presses Enter, and at the first channel the key for all channels."""
    return Looking(lambda screen, *_: ALL if screen.stage == CHANNELS else ENTER)


def refusing() -> Looking:
    """Return somebody who says no to every screen."""
    return Looking(lambda *_: "n")


def ticking() -> Looking:
    """Return somebody who ticks all that can be ticked, page by page, and takes it."""
    tried: list[tuple[Screen, int]] = []

    def choose(screen: Screen, ticks: frozenset[int], first: int) -> str:
        page = range(first, min(first + 9, len(screen.lines)))
        for at in page:
            if at not in ticks and (screen, at) not in tried:
                tried.append((screen, at))
                return str(at - first + 1)
        return "+" if page.stop < len(screen.lines) else ENTER

    return Looking(choose)


def screens_of(policy: Path, file: Path, person: Looking, types: Sequence[str] = ()) -> ScreenConversation:
    """Return a conversation about a policy, whose answers go into a label file."""
    settings, texts = Settings(types=tuple(types)), [file.read_text("utf-8")]

    def suggested() -> Suggested:
        return suggest_labels((str(policy),), (str(file),), settings)

    def write(text: str) -> None:
        texts.append(text)
        file.write_text(text, "utf-8")

    def keep(lines: Sequence[ScreenLine]) -> tuple[str, ...]:
        written = with_lines(str(file), lines, "Ada", "2026-01-01", settings)
        write(written.text)
        return written.remarks

    def refuse(lines: Sequence[ScreenLine]) -> tuple[str, ...]:
        refused = [label for line in lines for label in line.refused]
        write(with_refusal(str(file), refused, "Ada", "2026-01-01", settings).text)
        return ()

    def undo(number: int) -> str:
        del texts[-number:]
        file.write_text(texts[-1], "utf-8")
        return ""

    return ScreenConversation(
        lambda: screens_now(suggested()), keep, refuse, person, undo=undo, rest=lambda: off_screens(suggested())
    )


def observed_robot(cli: Cli, robot: dict[str, Any], folder: Path) -> Path:
    """Write what was observed of a robot (``robot.policy.xml``, ``robot.types.yaml``) and an empty label file."""
    (folder / "graph.txt").write_text(robot_text(robot), "utf-8")
    for name in ("robot.policy.xml", "robot.types.yaml"):
        (folder / name).unlink(missing_ok=True)
    done = cli("observe", "--text", "graph.txt", "-o", "robot.policy.xml", "--at", "2026-11-22T10:00:00Z", cwd=folder)
    assert done.returncode == 0, done.stderr
    (folder / "l.yaml").write_text("labels: 1\nauthor: Ada\n", "utf-8")
    return folder


def transcript(command: Sequence[str], folder: Path, keys: str) -> str:
    """Return what a terminal shows while these keys are pressed, one after the other."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "SOURCE_DATE_EPOCH": DAY}
    screen = b""
    with subprocess.Popen(command, cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, env=environment) as process:
        for key in keys:
            screen += read_until(ours, PROMPT)
            wait_for_keys(theirs)
            os.write(ours, key.encode())
        screen += read_until(ours, b"tells all)")
    os.close(theirs)
    os.close(ours)
    assert process.returncode == 0
    return screen.decode().replace("\r\n", "\n")
