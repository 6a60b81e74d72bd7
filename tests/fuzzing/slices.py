"""A slice: inputs of one target, judged and counted until there are enough."""

from __future__ import annotations

import os
import resource
import time
from dataclasses import asdict
from typing import TYPE_CHECKING, NoReturn

from tests.fuzzing import judge
from tests.fuzzing.record import Counts, save
from tests.fuzzing.watch import Watch, peak

if TYPE_CHECKING:
    import argparse
    from contextlib import ExitStack
    from pathlib import Path
    from types import FrameType

    from tests.fuzzing.targets import Target

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
        self._due = 0.5  # so that the number of a short slice is rounded, not cut off: there are many targets
        self._commands_due = 0.0

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

    def end(self) -> NoReturn:
        """Tidy up, write the counts and leave: libFuzzer does not come back."""
        os.chdir("/")
        self.held.close()
        self._flush()
        os._exit(0)
