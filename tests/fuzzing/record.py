"""What a run has tried: counts of each target, added up slice by slice, as JSON and as a table.

In: what the child of each slice has counted. Out: a document that can be kept.
"""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

MEGABYTE = 2**20


@dataclass
class Counts:
    """Of one target.

    Attributes
    ----------
    inputs, accepted
        Read, and of these taken by the reader.
    whole, unfit
        Of the accepted: analysed and written in every format; refused by the analysis, with lines.
    commands
        Run on an input, with a right exit code.
    slowest, slowest_whole
        Seconds of processor time for one input.
    peak
        The most memory of a process, in bytes.
    coverage
        Places in the code of the readers that were reached, as libFuzzer counts them.
    corpus
        Inputs that are kept since they reach something new.
    """

    inputs: int = 0
    accepted: int = 0
    whole: int = 0
    unfit: int = 0
    commands: int = 0
    slowest: float = 0
    slowest_whole: float = 0
    peak: int = 0
    cpu: float = 0
    coverage: int = 0
    corpus: int = 0
    faults: dict[str, dict[str, Any]] = field(default_factory=dict)

    def fault(self, name: str, what: str) -> bool:
        """Count a fault; return whether it is new."""
        new = name not in self.faults
        self.faults.setdefault(name, {"fault": what, "times": 0})["times"] += 1
        return new

    def add(self, other: Counts) -> None:
        """Add a slice."""
        for name in ("inputs", "accepted", "whole", "unfit", "commands", "cpu"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        for name in ("slowest", "slowest_whole", "peak", "coverage", "corpus"):
            setattr(self, name, max(getattr(self, name), getattr(other, name)))
        for name, fault in other.faults.items():
            self.fault(name, fault["fault"])
            self.faults[name]["times"] += fault["times"] - 1


def save(file: Path, document: dict[str, Any]) -> None:
    """Write a document whole or not at all."""
    part = file.with_suffix(".part")
    part.write_text(json.dumps(document, indent=1, sort_keys=True) + "\n", "utf-8")
    os.replace(part, file)  # noqa: PTH105 - says what it does


def read(file: Path) -> Counts:
    """Read the counts of a slice; none where its process ended before it wrote any."""
    return Counts(**json.loads(file.read_text("utf-8"))) if file.is_file() else Counts()


def document(about: dict[str, Any], targets: dict[str, Counts]) -> dict[str, Any]:
    """The record of a run."""
    whole = Counts()
    for counts in targets.values():
        whole.add(counts)
    left_out = ("coverage", "corpus", "faults")  # of a target only
    totals = {name: value for name, value in asdict(whole).items() if name not in left_out}
    return {**about, "totals": totals, "targets": {name: asdict(counts) for name, counts in targets.items()}}


def table(record: dict[str, Any]) -> str:
    """The record as Markdown."""
    lines = [
        "| reader | inputs | accepted | analysed and reported | slowest read | slowest report | coverage | faults |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, counts in record["targets"].items():
        if not counts["inputs"]:
            continue
        share = f"{100 * counts['accepted'] / counts['inputs']:.0f} %"
        seconds = f"{counts['slowest']:.2f} s | {counts['slowest_whole']:.2f} s"
        numbers = f"{counts['inputs']:,} | {share} | {counts['whole']:,}"
        lines.append(f"| {name} | {numbers} | {seconds} | {counts['coverage']:,} | {len(counts['faults'])} |")
    totals = record["totals"]
    said = f"{totals['inputs']:,} inputs, {totals['accepted']:,} accepted, {totals['whole']:,} analysed and reported"
    spent = f"{totals['commands']:,} commands; {totals['cpu'] / 3600:.2f} hours of processor time, at most"
    return "\n".join(
        [*lines, "", f"{said}, {spent} {totals['peak'] / MEGABYTE:.0f} MB; commit {record['commit']}.", ""]
    )
