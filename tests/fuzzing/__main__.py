"""Fuzz the readers, keep what was found, show a record.

    python -m tests.fuzzing run [--minutes M | --inputs N --whole N] [--folder DIR] [--only TARGET]
    python -m tests.fuzzing keep [--folder DIR]       take the shortest new inputs into tests/fuzzing/seeds
    python -m tests.fuzzing table RECORD              the record as Markdown

``make fuzz MINUTES=10`` and ``make fuzz HOURS=2`` run the first. A fault is kept in ``DIR/faults`` as the files that
show it: move them to ``tests/fuzzing/cases/TARGET/NAME``, and they are a test.

Exit code of ``run``: 0 if nothing was wrong, 1 otherwise.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
from pathlib import Path

from platformdirs import user_cache_path

from tests.fuzzing import record, seeds
from tests.fuzzing.run import Run
from tests.fuzzing.targets import TARGETS

ROUND = 20_000  # inputs of a round, where only a time is given
ROUNDS = 10  # where a number of inputs is given
NO_END = 10**9


def main() -> int:
    """Do what is asked."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzzing", description="Fuzz the readers.")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="make inputs and judge what becomes of them")
    run.add_argument("--minutes", type=float, help="of processor time; slices are ended whole")
    run.add_argument("--inputs", type=int, default=100_000, help="without --minutes (default 100000)")
    run.add_argument("--whole", type=int, default=0, help="of these analysed and reported (default a fiftieth)")
    run.add_argument("--seed", type=int, default=1)
    run.add_argument("--only", choices=TARGETS, help="this target only")
    keep = commands.add_parser("keep", help="take what was found into the kept seeds")
    for command in (run, keep):
        command.add_argument("--folder", type=Path, default=user_cache_path("rosprivacy") / "fuzzing")
    shown = commands.add_parser("table", help="show a record as Markdown")
    shown.add_argument("record", type=Path)
    asked = parser.parse_args()
    if asked.command == "table":
        print(record.table(json.loads(asked.record.read_text("utf-8"))), end="")
        return 0
    if asked.command == "keep":
        seeds.keep(asked.folder / "corpus", TARGETS)
        return 0
    return _run(asked)


def _run(asked: argparse.Namespace) -> int:
    shares = {asked.only: 1000} if asked.only else {name: target.share for name, target in TARGETS.items()}
    analysed = sum(share for name, share in shares.items() if TARGETS[name].analyse)
    inputs = ROUND if asked.minutes else asked.inputs
    whole = asked.whole or inputs // 50
    every = inputs * analysed / 1000 / whole if whole and analysed else 0
    work = Run(shares, asked.folder.resolve(), asked.seed, every)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, work.stop)
    if asked.minutes:
        work.slices(inputs * NO_END, NO_END, asked.minutes * 60)
    else:
        work.slices(inputs, min(ROUNDS, max(1, inputs // ROUND)), float("inf"))
    done = work.save()
    print(record.table(done), end="")
    faults = {name: fault for counts in done["targets"].values() for name, fault in counts["faults"].items()}
    for name, fault in sorted(faults.items()):
        print(f"{fault['times']} x {name}: {fault['fault']}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
