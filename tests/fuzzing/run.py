"""A run: slices of all targets in turn, a process at a time, until there are enough inputs, or the time is over.

The record is written after each slice and each minute, and when the run is asked to stop (SIGTERM, Ctrl-C).
"""

from __future__ import annotations

import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from datetime import datetime, timezone
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from tests.fuzzing import record, seeds
from tests.fuzzing.record import Counts
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path
    from types import FrameType

MINUTE = 60
PATIENCE = 30  # seconds for a slice to end when it is asked to
COVERED = re.compile(r"cov: (\d+) .*corp: (\d+)/")


@dataclass
class Run:
    """A run of some targets.

    Attributes
    ----------
    shares
        Of a thousand inputs, by target.
    folder
        For the corpus, the faults and the record; what is there is gone on with.
    """

    shares: dict[str, int]
    folder: Path
    seed: int
    whole_every: float
    targets: dict[str, Counts] = field(default_factory=dict)
    stopping: bool = False
    begun: float = field(default_factory=time.time)

    def stop(self, _signal: int, _frame: FrameType | None) -> None:
        self.stopping = True

    def slices(self, inputs: int, rounds: int, cpu: float) -> None:
        """Run so many inputs in so many rounds, or until so many seconds of processor time are spent."""
        self.folder.mkdir(parents=True, exist_ok=True)
        seeds.unpack(self.folder / "corpus", self.shares)
        for number in range(rounds):
            for target, share in self.shares.items():
                if self.stopping or self.spent() >= cpu:
                    return
                self._slice(target, max(1, inputs * share // 1000 // rounds), self.seed + number)

    def spent(self) -> float:
        return sum(counts.cpu for counts in self.targets.values())

    def save(self, part: tuple[str, Counts] | None = None) -> dict[str, Any]:
        """Write the record, with a slice that is still running."""
        targets = {name: Counts() for name in self.shares}
        for name, counts in [*self.targets.items(), *([part] if part else [])]:
            targets[name].add(counts)
        document = record.document(self._about(), targets)
        record.save(self.folder / "record.json", document)
        return document

    def _about(self) -> dict[str, Any]:
        git = shutil.which("git") or "git"
        commit = subprocess.run([git, "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
        return {
            "begun": datetime.fromtimestamp(self.begun, timezone.utc).isoformat(timespec="seconds"),
            "seconds": round(time.time() - self.begun),
            "commit": commit.stdout.strip() or "unknown",
            "python": platform.python_version(),
            "atheris": version("atheris"),
            "seed": self.seed,
        }

    def _slice(self, target: str, inputs: int, seed: int) -> None:
        """Run one slice; one that ends by itself before it is done is a fault."""
        counted, log = self.folder / "slice.json", self.folder / "slice.log"
        counted.unlink(missing_ok=True)
        command = [sys.executable, "-m", "tests.fuzzing.explore", target, str(self.folder), "--inputs", str(inputs)]
        command += ["--seed", str(seed), "--whole-every", str(self.whole_every)]
        environment = {**os.environ, "PYTHONHASHSEED": "0"}
        with log.open("wb") as said:
            process = subprocess.Popen(command, cwd=ROOT, stdout=said, stderr=said, env=environment)
            self._wait(process, target, counted)
        counts = record.read(counted)
        text = log.read_text("utf-8", "replace")
        if found := COVERED.findall(text):
            counts.coverage, counts.corpus = map(int, found[-1])
        if process.returncode:
            faults = self.folder / "faults"
            faults.mkdir(exist_ok=True)
            (faults / f"{target}-process.log").write_text(text[-20_000:], "utf-8")
            counts.fault(f"{target}-process", f"the process ended with {process.returncode}")
        self.targets.setdefault(target, Counts()).add(counts)
        self.save()

    def _wait(self, process: subprocess.Popen[bytes], target: str, counted: Path) -> None:
        written = time.monotonic()
        asked = 0.0
        while process.poll() is None:
            time.sleep(0.05)
            now = time.monotonic()
            if self.stopping and not asked:
                process.send_signal(signal.SIGTERM)
                asked = now
            if asked and now - asked > PATIENCE:
                process.kill()
            if now - written > MINUTE:
                written = now
                self.save((target, record.read(counted)))
