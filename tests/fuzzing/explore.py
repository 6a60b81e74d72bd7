"""One slice of one target, guided by coverage: started by ``run.py`` as a process of its own.

    python -m tests.fuzzing.explore TARGET FOLDER --inputs N [--seed 1] [--whole-every 35]

libFuzzer (atheris) mutates the bytes behind the choices and keeps in ``FOLDER/corpus/TARGET`` what reaches new code.
Only readers are watched; what analyses and reports runs as fast as it does.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import tempfile
import time
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Never

import atheris

from tests.fuzzing.record import Counts, save

READERS = [
    "rosprivacy.ingest", "rosprivacy.ontology.own", "rosprivacy.ontology.lines", "rosprivacy.ontology.turtle",
    "rosprivacy.analysis.durations", "rosprivacy.analysis.text", "rosprivacy.analysis.written_names",
    "rosprivacy.queries.library", "rosprivacy.report.compare", "rosprivacy.spark.parquet",
]  # fmt: skip
if TYPE_CHECKING:
    from types import FrameType

    from tests.fuzzing import judge
    from tests.fuzzing.kept_graphviz import kept_graphviz
    from tests.fuzzing.targets import TARGETS, Target
    from tests.fuzzing.watch import Watch, peak
else:
    with atheris.instrument_imports(include=READERS):
        from tests.fuzzing import judge
        from tests.fuzzing.kept_graphviz import kept_graphviz
        from tests.fuzzing.targets import TARGETS
        from tests.fuzzing.watch import Watch, peak
LONGEST = 400  # bytes of choices
FLUSH = 15  # seconds between two writings of the counts
TWICE = 10  # of so many reports one is written twice, to compare the bytes
COMMANDS = 20  # for so many reports one command is run


class Slice:
    """Judges inputs and counts them, until there are enough or it is asked to stop."""

    def __init__(
        self, target: Target, folder: Path, watch: Watch, outside: Path, asked: argparse.Namespace, held: ExitStack
    ) -> None:
        self.held = held
        self.target, self.folder, self.watch, self.outside = target, folder, watch, outside
        self.inputs, self.whole_every = asked.inputs, asked.whole_every
        self.counts = Counts()
        self.stopping = False
        self._written = time.monotonic()
        self._due = self._commands_due = 0.0

    def stop(self, _signal: int, _frame: FrameType | None) -> None:
        self.stopping = True

    def one(self, data: bytes) -> None:
        """Judge one input; what libFuzzer calls."""
        files = judge.files_of(self.target, data, self.outside)
        judge.write(files)
        read = judge.judge_reading(self.target, self.watch)
        self.counts.inputs += 1
        self.counts.accepted += read.kind == "accepted"
        self.counts.slowest = max(self.counts.slowest, read.seconds)
        self._faulty(read, data, files)
        self._further(read, data, files)
        if self.stopping or self.counts.inputs >= self.inputs:
            self.end()
        if time.monotonic() - self._written > FLUSH:
            self._flush()

    def _further(self, read: judge.Outcome, data: bytes, files: judge.Files) -> None:
        """Now and then report on what was accepted, and run the command on whatever it is."""
        self._due += bool(self.whole_every) and 1 / self.whole_every
        if self._due >= 1 and read.kind == "accepted" and self.target.analyse:
            whole = judge.judge_whole(self.target, self.watch, twice=self.counts.whole % TWICE == 0)
            self.counts.whole += whole.kind == "accepted"
            self.counts.unfit += whole.kind == "refused"
            self._due -= whole.kind == "accepted"
            self.counts.slowest_whole = max(self.counts.slowest_whole, whole.seconds)
            self._faulty(whole, data, files)
            self._commands_due += 1 / COMMANDS
        if self._commands_due >= 1 and read.kind != "fault" and self.target.arguments:
            self._commands_due -= 1
            command = judge.judge_command(self.target, self.watch, read.kind)
            self.counts.commands += not command.fault
            self._faulty(command, data, files)

    def _faulty(self, outcome: judge.Outcome, data: bytes, files: judge.Files) -> None:
        """Keep the first input of each fault, as the files that a test can take."""
        if not outcome.fault:
            return
        name = judge.named(self.target, outcome)
        if not self.counts.fault(name, outcome.fault):
            return
        place = self.folder / "faults" / name
        place.mkdir(parents=True, exist_ok=True)
        for file, content in files.items():
            (place / file).parent.mkdir(parents=True, exist_ok=True)
            (place / file).write_bytes(content)
        (place / "fault.txt").write_text(f"{outcome.fault}\n{data.hex()}\n{outcome.trace}", "utf-8", "replace")
        self._flush()

    def _flush(self) -> None:
        self._written = time.monotonic()
        used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        self.counts.cpu = sum(one.ru_utime + one.ru_stime for one in used)
        self.counts.peak = peak()
        save(self.folder / "slice.json", asdict(self.counts))

    def end(self) -> Never:
        """Tidy up, write the counts and leave: libFuzzer does not come back."""
        os.chdir("/")
        self.held.close()
        self._flush()
        os._exit(0)


def main() -> None:
    """Run a slice."""
    parser = argparse.ArgumentParser(description="One slice of one target.")
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--inputs", type=int, required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--whole-every", type=float, default=0, help="a report for so many inputs; 0 for none")
    asked = parser.parse_args()
    folder, target = asked.folder.resolve(), TARGETS[asked.target]
    corpus = folder / "corpus" / target.name
    (folder / "faults").mkdir(parents=True, exist_ok=True)
    corpus.mkdir(parents=True, exist_ok=True)
    memory = Path("/dev/shm")  # noqa: S108 - a disk would be the slowest part
    with ExitStack() as stack:
        temporary = stack.enter_context(tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None))
        place = Path(temporary, "root")
        outside = judge.prepare(place)
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        os.chdir(place)
        watch = Watch(place, outside, folder)
        judge.warm(target, outside)
        stack.enter_context(watch.guard)
        stack.enter_context(kept_graphviz())
        piece = Slice(target, folder, watch, outside, asked, stack)
        signal.signal(signal.SIGTERM, piece.stop)
        options = [
            f"-seed={asked.seed}", f"-max_len={LONGEST}", "-timeout=60", "-rss_limit_mb=4096", "-handle_term=0",
            f"-artifact_prefix={folder}/faults/{target.name}-", str(corpus),
        ]  # fmt: skip
        atheris.Setup([sys.argv[0], *options], piece.one)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
