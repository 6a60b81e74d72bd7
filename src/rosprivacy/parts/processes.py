"""The parts of a fleet on the processors of this machine: processes that end with the run, values that lie in files.

In: units of a fleet. Out: ``Parts``. What is asked for more than once is written to a folder of this run, so that
memory holds one part for each process, however large the fleet is.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import shutil
import signal
import sys
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from multiprocessing import util
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import ClusterError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.parts.kept_parts import KeptParts
    from rosprivacy.parts.units import Unit

SAFE_PATH = {"PYTHONSAFEPATH": "1"}  # from Python 3.11 on: the current folder is not searched for modules
UNITS = 50  # to a part: a process holds it easily, and there are parts enough for many processors
KILLED = (
    "--engine parts: a process ended before its part was done, as by a lack of memory; "
    "give it more, and --resume DIR to go on with the parts that are done"
)


@dataclass(frozen=True, slots=True)
class PartStep:
    """A function of a part: the file that it lies in, and the folder for what comes of it; empty: it is made anew."""

    function: str
    folder: str


@dataclass(frozen=True, slots=True)
class LocalParts:
    """The parts of a fleet, and what is done with each before it is asked for.

    Attributes
    ----------
    folder
        Of this run, which nobody else may read: what lies there is unpickled.
    names
        Of the parts, in order.
    resumed
        Parts that a run before has read, and that this one keeps for the next; None: nobody asked for that.
    """

    pool: ProcessPoolExecutor
    folder: Path
    names: tuple[str, ...]
    progress: Callable[[Sequence[str]], Iterable[str]]
    resumed: KeptParts | None
    steps: tuple[PartStep, ...]

    def map(self, function: Callable[[Any], Any], *, keep: bool = False) -> LocalParts:
        """Do the same with each part, when it is asked for."""
        number = len(list(self.folder.glob("*.function")))
        if self.resumed and len(self.steps) == 1:
            function = partial(self.resumed.built, build=function)
        file = self.folder / f"{number}.function"
        file.write_bytes(pickle.dumps(function))
        kept = self.folder / str(number)
        if keep:
            kept.mkdir()
        return replace(self, steps=(*self.steps, PartStep(str(file), str(kept) if keep else "")))

    def collect(self) -> Iterator[Any]:
        """Give what comes of each part, in order; an error in one is raised here."""
        names = self.progress(self.names) if not Path(self.steps[1].folder, "0").exists() else self.names
        values = self.pool.map(partial(_value, steps=self.steps), range(len(self.names)))
        try:
            for _, value in zip(names, values, strict=True):
                yield value
        except BrokenProcessPool:
            raise ClusterError(KILLED) from None


@contextmanager
def environment(changed: Mapping[str, str]) -> Iterator[None]:
    """Change variables of the environment for as long as the block lasts."""
    before = {key: os.environ.get(key) for key in changed}
    os.environ.update(changed)
    try:
        yield
    finally:
        for key, value in before.items():
            if value is None:
                del os.environ[key]
            else:
                os.environ[key] = value


@contextmanager
def safe_path() -> Iterator[None]:
    """Keep processes that Python starts in the block from running modules of the current folder, as ``python -P``."""
    with environment(SAFE_PATH):
        if sys.version_info >= (3, 11):
            yield
            return
        # Python 3.10 does not know the variable, and it has no public way to start its processes with ``-I``.
        given = util._args_from_interpreter_flags  # type: ignore[attr-defined]  # noqa: SLF001
        util._args_from_interpreter_flags = lambda: ["-I", *given()]  # type: ignore[attr-defined]  # noqa: SLF001
        try:
            yield
        finally:
            util._args_from_interpreter_flags = given  # type: ignore[attr-defined]  # noqa: SLF001


@contextmanager
def processes(
    progress: Callable[[Sequence[str]], Iterable[str]], resumed: KeptParts | None = None
) -> Iterator[Callable[[Sequence[Unit]], LocalParts]]:
    """Start a process for each processor that this one may use, and give what puts units to parts.

    Raises
    ------
    ClusterError
        In the block, if a process ends before its part is done.
    """
    context = multiprocessing.get_context("spawn")  # a copy of this process would have its threads' locks, too
    with TemporaryDirectory(prefix="rosprivacy-parts-") as folder, safe_path():
        pool = ProcessPoolExecutor(_processors(), context, _begin, (folder,))
        try:
            yield partial(_scattered, pool, Path(folder), progress, resumed)
        finally:
            pool.shutdown(cancel_futures=True)


def _scattered(
    pool: ProcessPoolExecutor,
    folder: Path,
    progress: Callable[[Sequence[str]], Iterable[str]],
    resumed: KeptParts | None,
    units: Sequence[Unit],
) -> LocalParts:
    """Put units to parts, in order."""
    chunks = [tuple(units[start : start + UNITS]) for start in range(0, len(units), UNITS)]
    begun = folder / "units"
    begun.mkdir()
    for number, chunk in enumerate(chunks):
        (begun / str(number)).write_bytes(pickle.dumps(chunk))
    names = tuple(chunk[0].name for chunk in chunks)
    return LocalParts(pool, folder, names, progress, resumed, (PartStep("", str(begun)),))


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def _begin(folder: str) -> None:
    """A process of the pool ends with the one that it works for, which alone says what Ctrl+C does.

    Where that one was killed, it removes the folder of the run, which nobody else would.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def end_with_it() -> None:
        parent.join()
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)

    Thread(target=end_with_it, daemon=True).start()


def _value(part: int, steps: Sequence[PartStep]) -> Any:
    """In a process of the pool: what comes of a part, from the last step of which it is kept."""
    files = [Path(step.folder, str(part)) if step.folder else None for step in steps]
    last = max(number for number, file in enumerate(files) if file and file.exists())
    kept = files[last]
    assert kept is not None
    value = pickle.loads(kept.read_bytes())  # noqa: S301 - of this run's own folder
    for step, file in zip(steps[last + 1 :], files[last + 1 :], strict=True):
        value = _function(step.function)(value)
        if file:
            file.write_bytes(pickle.dumps(value))
    return value


@lru_cache(maxsize=8)
def _function(file: str) -> Callable[[Any], Any]:
    function: Callable[[Any], Any] = pickle.loads(Path(file).read_bytes())  # noqa: S301 - of this run's own folder
    return function
