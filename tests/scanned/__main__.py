"""How much of twenty public systems a scan finds: ``python -m tests.scanned FOLDER [--missed] [--wrong]``.

FOLDER holds a checkout of each system of ``systems.jsonl``, in a folder of its name there; those that are not there are
not measured. ``--truth DIR`` takes what the readers wrote from another folder, as that of the sealed half.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from rosprivacy.ingest.scan.checkout import read_checkout
from tests.scanned.measuring import Counts, measured
from tests.scanned.truth import HERE, READERS, systems, truth


def main() -> None:
    """Print recall, precision, and what becomes of what is missed."""
    parser = argparse.ArgumentParser(prog="python -m tests.scanned")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--truth", type=Path, default=HERE)
    parser.add_argument("--missed", action="store_true")
    parser.add_argument("--wrong", action="store_true")
    arguments = parser.parse_args()
    whole = Counts()
    number = disputed = 0
    for one in systems():
        root = arguments.folder / one.system
        if not root.is_dir() or not (arguments.truth / READERS[0] / f"{one.system}.jsonl").is_file():
            continue
        true = truth(one.system, arguments.truth)
        whole += measured(one.system, read_checkout(str(root)), true)
        number, disputed = number + 1, disputed + len(true.disputed)
    print(f"{number} systems; disputed by the readers and left out: {disputed}")
    for sort in sorted(whole.true):
        lost = f"missed: {whole.named[sort]} named by a gap, {whole.lost[sort]} lost without a word"
        share = f"recall {whole.found[sort]}/{whole.true[sort]} = {whole.recall(sort):.2f}"
        print(f"{sort:9} {share}, precision {whole.precision(sort):.2f}; {lost}")
    print("known: " + ", ".join(f"{how} {count}" for how, count in sorted(whole.known.items()) if how))
    print("".join(f"{line}\n" for line in sorted(whole.missed) if arguments.missed), end="")
    print("".join(f"wrong: {line}\n" for line in sorted(whole.wrongs) if arguments.wrong), end="")


if __name__ == "__main__":
    main()
