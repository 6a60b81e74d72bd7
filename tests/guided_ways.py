"""What a person gets from each guided way and by hand, counted on robots whose true ways out are known: a table.

    python -m tests.guided_ways

For each robot of ``tests/cases/try`` and each way: keys, screens, seconds of the processor (the person takes none),
bytes of the label file, findings, and the places where data gets out: true ones that are findings, false ones, and true
ones that are none; of these how many are named as open or not known, and how many are hidden: nobody hears of them.

``try`` is ``rosprivacy try``, which asks for no key. ``from try`` is ``init --from-try``, and Enter on every screen of
``suggest --ask``. ``enter`` begins with an empty label file, and presses at the first channel the key for all channels;
``knowing`` knows which nodes let data out, and ticks these and only these. ``likely`` and ``all`` is ``labels
--accept`` of what is likely, and of all that is suggested. ``by hand`` is a label file that somebody wrote in ten
minutes from the text of ``ros2 node info``, where there is one. The explorer's page is none of these: it asks by the
same suggestions, and in an order of its own that needs a browser to be counted.
"""

from __future__ import annotations

import re
import resource
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml

import rosprivacy
from rosprivacy.analysis.suggesting.screens import CHANNELS
from rosprivacy.labelling.asking import without_channels
from rosprivacy.labelling.screen_conversation import ALL, ENTER
from tests.helpers.command import run
from tests.helpers.paths import ROOT
from tests.helpers.screens import Looking, entering, hurrying, observed_robot, screens_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.analysis.suggesting.screens import Screen
    from rosprivacy.result import Result
    from tests.helpers.command import Cli

    Walk = Callable[["Cli", "Robot", Path], "Counted"]

CASES = ROOT / "tests" / "cases" / "try"
ROBOTS = sorted((*CASES.glob("*.yaml"), *CASES.glob("by_others/*.yaml")))
BY_HAND = {file.parent.name: file for file in sorted(CASES.glob("*/by_hand.labels.yaml"))}
COLUMNS = ("robot", "way", "keys", "screens", "s", "bytes", "findings", "true", "false", "missing", "open", "hidden")
LEAK, OWN, POLICY, TYPES = "leak", "l.yaml", "robot.policy.xml", "robot.types.yaml"


class Robot(NamedTuple):
    """A robot, and the places where data of persons truly gets out of it."""

    name: str
    case: dict[str, Any]
    surely: frozenset[str]
    perhaps: frozenset[str]


class Counted(NamedTuple):
    """What one way gives for one robot.

    Attributes
    ----------
    exits
        Places where data gets out by the answer.
    named
        Places that the answer names as open, or of which it says that it does not know what they do.
    """

    exits: frozenset[str]
    named: frozenset[str]
    findings: int
    label_bytes: int = 0
    keys: int = 0
    screens: int = 0


def main() -> None:
    """Print the table."""
    print("\t".join(COLUMNS))
    for file in ROBOTS:
        robot = read_robot(file)
        for way, walk in WAYS.items():
            if way == "by hand" and robot.name not in BY_HAND:
                continue
            with TemporaryDirectory() as folder:
                observed_robot(run, robot.case, Path(folder))
                begun = _seconds()
                count = walk(run, robot, Path(folder))
                seconds = _seconds() - begun
            found, missing = robot.surely & count.exits, robot.surely - count.exits
            sizes = map(len, (found, count.exits - robot.surely - robot.perhaps, missing, missing & count.named))
            numbers = (count.keys, count.screens, f"{seconds:.1f}", count.label_bytes, count.findings)
            print(*(robot.name, way, *numbers, *sizes, *(sorted(hidden(robot, count)) or "0")), sep="\t", flush=True)


def read_robot(file: Path) -> Robot:
    """Read a robot and its true ways out."""
    case = yaml.safe_load(file.read_text("utf-8"))
    surely = frozenset(way[2] for way in case["truth"] if "may be" not in way)
    return Robot(file.stem, case, surely, frozenset(way[2] for way in case["truth"]) - surely)


def hidden(robot: Robot, count: Counted) -> frozenset[str]:
    """Return the true places of which nobody hears."""
    return robot.surely - count.exits - count.named


def by_try(cli: Cli, robot: Robot, folder: Path) -> Counted:
    """Look at what ``rosprivacy try`` prints."""
    del robot
    text = cli("try", "graph.txt", cwd=folder).stdout
    numbered = frozenset(re.findall(r"^\d\. (/[^,]+), ", text, re.MULTILINE))
    return Counted(numbered, frozenset(re.findall(r"/[\w/]+", text)) - numbered, len(numbered), screens=1)


def from_try(cli: Cli, robot: Robot, folder: Path) -> Counted:
    """Keep what ``try`` has shown, and press Enter on every screen."""
    shown = by_try(cli, robot, folder)
    (folder / OWN).unlink()
    for name in (POLICY, TYPES):
        (folder / name).unlink()
    done = cli("init", "--from-try", "graph.txt", cwd=folder)
    assert done.returncode == 0, done.stderr
    (folder / "robot.labels.yaml").rename(folder / OWN)
    asked = _asked(folder, entering())
    return asked._replace(named=asked.named | shown.named | shown.exits)


def by_enter(cli: Cli, robot: Robot, folder: Path) -> Counted:
    """Press Enter on every screen, and once the key for all channels."""
    del cli, robot
    return _asked(folder, hurrying())


def knowing(cli: Cli, robot: Robot, folder: Path) -> Counted:
    """Tick the nodes that let data out, and no others; take the rest as it is ticked."""
    del cli

    def choose(screen: Screen, ticks: frozenset[int], first: int) -> str:
        for at, line in enumerate(screen.lines[first : first + 9], first):
            if line.role == LEAK and (screen.element.name in robot.surely) is not (at in ticks):
                return str(at - first + 1)
        return ALL if screen.stage == CHANNELS else ENTER

    return _asked(folder, Looking(choose))


def accepting(confidence: str) -> Walk:
    """Return the way of who accepts all suggestions of a confidence and above."""

    def walk(cli: Cli, robot: Robot, folder: Path) -> Counted:
        del robot
        for command in (
            ("suggest", POLICY, "--types", TYPES, "--into", OWN),
            ("labels", "-l", OWN, "--by", "Ada", "--accept", confidence),
        ):
            done = cli(*command, cwd=folder)
            assert done.returncode == 0, done.stderr
        return _answer(folder, folder / OWN)[0]

    return walk


def by_hand(cli: Cli, robot: Robot, folder: Path) -> Counted:
    """Take the label file that somebody wrote by hand."""
    del cli
    return _answer(folder, BY_HAND[robot.name])[0]


WAYS: dict[str, Walk] = {
    "try": by_try,
    "from try": from_try,
    "enter": by_enter,
    "knowing": knowing,
    "likely": accepting("likely"),
    "all": accepting("may"),
    "by hand": by_hand,
}


def _asked(folder: Path, person: Looking) -> Counted:
    screens_of(folder / POLICY, folder / OWN, person, [str(folder / TYPES)]).run()
    count, answer = _answer(folder, folder / OWN)
    named = count.named | {*without_channels(answer)}
    return count._replace(named=named, keys=len(person.keys), screens=len(person.shown))


def _answer(folder: Path, labels: Path) -> tuple[Counted, Result]:
    answer = rosprivacy.analyze(folder / POLICY, labels, types=[folder / TYPES])
    exits = frozenset(finding.leak.name for finding in answer.findings)
    named = frozenset(question.element.name for question in answer.analysis.open)
    named |= {doubt.element.name for doubt in answer.doubts if doubt.element}
    return Counted(exits, named, len(answer.findings), labels.stat().st_size), answer


def _seconds() -> float:
    """Of the processor, for this program and those that it has run."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


if __name__ == "__main__":
    main()
