"""What suggesting labels costs beside analysing the same system, each with its document, in one run: less.

A robot of 10,000 elements: drivers, detectors, planners and bridges by turns, with and without message types, every
tenth driver a source. Suggesting is what comes after the analysis: rules are read, evidence of packages, types, names,
data flow and neighbours is joined, put in order and told. Analysing is what comes before it: policy and labels are
read, analysed and told. As in the command, a process does each of both once: who analyses the same system again and
again finds its names remembered. What ships with the program is parsed before: neither side pays for it here.
"""

from __future__ import annotations

import gc
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, TypeVar

from measure import Row, calls, compared, counted, processor

from rosprivacy.cli import ENOUGH
from rosprivacy.labelling.suggesting import suggested
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from measure import Measured

    Robot = tuple[tuple[str], tuple[str]]  # its policies and its label files
T = TypeVar("T")
BOUND = 1.0  # suggesting costs less than analysing
CALLS = 1.25  # another Python makes other calls of one comprehension
ELEMENTS = 10_000
PARTS = (  # of a chain: the node, what it publishes, its type; each reads what the one before it publishes
    ("camera_driver", "camera/image_raw", "sensor_msgs/msg/Image"),
    ("face_detector", "faces", "hri_msgs/msg/IdsList"),
    ("person_tracker", "people", "people_msgs/msg/People"),
    ("planner", "cmd_vel", "geometry_msgs/msg/Twist"),
    ("cloud_bridge", "status", "std_msgs/msg/String"),
)
PER_CHAIN = 2 * len(PARTS)  # elements


def robot(elements: int, folder: Path, *, typed: bool) -> Robot:
    """Write a policy of so many elements and its labels."""
    profiles, types, sources = [], [], []
    for chain in range(elements // PER_CHAIN):
        before = ""
        for node, topic, type_ in PARTS:
            name = f"/r{chain}/{topic}"
            reads = f'<topics subscribe="ALLOW"><topic>{before}</topic></topics>' if before else ""
            writes = f'<topics publish="ALLOW"><topic>{name}</topic></topics>'
            profiles.append(f'<profile ns="/r{chain}" node="{node}">{writes}{reads}</profile>')
            types.append(f"  {name}: {{types: [{type_}]}}\n")
            before = name
        if chain % 10 == 0:
            sources.append(f"  /r{chain}/camera_driver: {{source: [Video]}}\n")
    policy, labels = folder / "p.xml", folder / "l.yaml"
    opening = '<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>'
    policy.write_text(f"{opening}{''.join(profiles)}</profiles></enclave></enclaves></policy>", "utf-8")
    said = "topics:\n" + "".join(types) if typed else ""
    labels.write_text("labels: 1\nnodes:\n" + "".join(sources) + said, "utf-8")
    return (str(policy),), (str(labels),)


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    rounds = 5 if quick else 9
    for typed in (False, True):
        what = f"suggest, {ELEMENTS:,} elements, {'types known' if typed else 'names only'}"
        yield Row(
            what,
            "reading, analysing",
            partial(measured, rounds, typed=typed, quick=quick),
            CALLS if quick else BOUND,
            counts=quick,
        )


def measured(rounds: int, *, typed: bool, quick: bool) -> Measured:
    """Compare suggesting with the analysis that comes before it, each round in a new process."""
    with TemporaryDirectory() as small, TemporaryDirectory() as large:
        first, second = robot(PER_CHAIN, Path(small), typed=typed), robot(ELEMENTS, Path(large), typed=typed)
        if quick:
            suggested_calls, analysed_calls, number = anew(calls_once, first, second)
            return counted(suggested_calls, analysed_calls, f"{number:,} suggestions")
        each = [anew(once, first, second) for _ in range(rounds)]
    suggesting, analysing, made = zip(*each, strict=True)
    return compared((suggesting, analysing), f"{made[0]:,} suggestions")


def anew(work: Callable[[Robot, Robot], T], first: Robot, second: Robot) -> T:
    """Do it in a new process."""
    with ProcessPoolExecutor(1, get_context("spawn")) as process:
        return process.submit(work, first, second).result()


def once(first: Robot, second: Robot) -> tuple[float, float, int]:
    """Suggest for the second robot; return the seconds of that and of analysing it, and the number of suggestions.

    By the first one what ships with the program is parsed.
    """
    gc.set_threshold(ENOUGH)  # as the command does
    settings = Settings()
    suggested(answer_robot(*first, settings), settings).document()
    begin = processor()
    result = answer_robot(*second, settings)
    result.document()
    middle = processor()
    document = suggested(result, settings).document()
    return processor() - middle, middle - begin, len(document["suggestions"])


def calls_once(first: Robot, second: Robot) -> tuple[int, int, int]:
    """The same with the number of calls in place of seconds."""
    settings = Settings()
    suggested(answer_robot(*first, settings), settings).document()
    results, documents = [], []

    def analyse() -> None:
        results.append(answer_robot(*second, settings))
        results[0].document()

    analysed = calls(analyse)
    return (
        calls(lambda: documents.append(suggested(results[0], settings).document())),
        analysed,
        len(documents[0]["suggestions"]),
    )
