"""One input of a target -> what became of it: accepted, refused as it should be, or a fault of ours.

In: a prepared folder that is the current one. Out: ``Outcome``.
"""

from __future__ import annotations

import contextlib
import hashlib
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, ModelError, QueryError, RosPrivacyError
from tests.fuzzing.choices import Choices
from tests.fuzzing.label_texts import BASE, BASE_LABELS, EXAMPLE_FLEET, STAR_LABELS
from tests.fuzzing.mutations import SECRET, hide, mutate, plant, words
from tests.fuzzing.watch import Hang, Watch
from tests.fuzzing.whole import report_whole, run_command

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from types import TracebackType

    from tests.fuzzing.targets import Target

MUTATED = 5  # one input in so many is mutated as text too
REFUSALS = (InputErrors, InputError, ModelError, QueryError)
Files = dict[str, bytes]


@dataclass(frozen=True)
class Outcome:
    """What became of an input.

    Attributes
    ----------
    kind
        ``accepted``, ``refused`` or ``fault``.
    fault
        What is wrong and where, alike for the same fault; with the traceback below.
    seconds
        Of processor time.
    """

    kind: str
    seconds: float
    fault: str = ""
    trace: str = ""


def prepare(folder: Path) -> Path:
    """Make the folder in which inputs are read, with hostile links to one beside it; return that one."""
    outside = folder.parent / "outside"
    folder.mkdir(parents=True)
    hide(outside)
    plant(folder, outside)
    base = {"base.xml": BASE, "base.yaml": BASE_LABELS, "star.yaml": STAR_LABELS, "example.yaml": EXAMPLE_FLEET}
    for name, text in base.items():
        (folder / name).write_text(text, "utf-8")
    return outside


def files_of(target: Target, data: bytes, outside: Path) -> Files:
    """The files that some bytes stand for."""
    choices = Choices(data)
    made = target.make(choices)
    files = {name: text if isinstance(text, bytes) else text.encode("utf-8", "replace") for name, text in made.items()}
    if target.words and choices.once_in(MUTATED):
        name = next(iter(files))
        files[name] = mutate(choices.random(), files[name], words(target.words, outside))
    return files


def write(files: Mapping[str, bytes]) -> None:
    for name, data in files.items():
        path = Path(name)
        if path.parent.name:
            path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def warm(target: Target, outside: Path) -> None:
    """Do once, unwatched, what the first input of a process would pay for: imports, the ontology, its cache."""
    write(files_of(target, b"", outside))
    for act in (target.read, *([target.analyse] if target.analyse else [])):
        with contextlib.suppress(Exception):  # what is wrong is told when it is watched
            act()


def judge_reading(target: Target, watch: Watch) -> Outcome:
    """Read what lies in the folder."""
    return _judged(target.read, watch)


def judge_whole(target: Target, watch: Watch, *, twice: bool) -> Outcome:
    """Analyse what was accepted, and write it in every format; ``twice`` holds the bytes to be the same again."""
    assert target.analyse
    analyse = target.analyse
    return _judged(lambda: report_whole(analyse(), twice=twice), watch)


def judge_command(target: Target, watch: Watch, read: str) -> Outcome:
    """Run the command on it: its exit code is one of the table, and of what the reader said."""
    return _judged(lambda: run_command(target.arguments, refused=read == "refused"), watch)


def _judged(act: Callable[[], object], watch: Watch) -> Outcome:
    kind, fault, trace = "accepted", "", ""
    with watch:
        try:
            act()
        except REFUSALS as error:
            kind, fault = "refused", _message_fault(error)
        except Hang as error:
            fault, trace = f"hang in {_where(error.__traceback__)}", traceback.format_exc(limit=-30)
        except Exception as error:  # noqa: BLE001 - every one is a fault of ours
            fault = f"{type(error).__name__} in {_where(error.__traceback__)}"
            trace = traceback.format_exc(limit=-30)
    fault = "; ".join([*watch.broken, *([fault] if fault else [])])
    return Outcome("fault" if fault else kind, watch.seconds, fault, trace)


def _message_fault(error: RosPrivacyError) -> str:
    """What is wrong with a message: it has to be lines of 'what is wrong; what to do', fit for a terminal."""
    for line in str(error).split("\n"):
        if not line.isprintable():
            return f"unprintable message of {type(error).__name__}: {line.encode('unicode_escape').decode()[:80]}"
        if ": " not in line or "; " not in line:
            return f"message of {type(error).__name__} without what to do: {line[:80]}"
        if SECRET in line:
            return "a message tells what a file of others holds"
    return ""


def _where(trace: TracebackType | None) -> str:
    """The innermost place in our code."""
    frames = traceback.extract_tb(trace)
    ours = [f for f in frames if "rosprivacy/" in f.filename and "site-packages" not in f.filename]
    ours = [f for f in ours if "/tests/" not in f.filename] or frames
    return f"{Path(ours[-1].filename).name}:{ours[-1].name}" if ours else "?"


def named(target: Target, outcome: Outcome) -> str:
    """A short name for a fault, the same for all inputs that show it."""
    return f"{target.name}-{hashlib.sha256(outcome.fault.encode()).hexdigest()[:8]}"
