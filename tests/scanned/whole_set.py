"""What a scan gives of all systems of the labelled set, by numbers only: ``python -m tests.scanned.whole_set FOLDER…``.

A folder holds checkouts, each named OWNER+NAME. Those of ``tests/labelled/systems.jsonl`` are read; a table is printed.
"""

from __future__ import annotations

import json
import sys
import time
import traceback
from collections import defaultdict
from pathlib import Path
from statistics import median, quantiles

from rosprivacy.ingest.scan.checkout import chosen, read_checkout, systems_of

LABELLED = Path(__file__).parents[1] / "labelled" / "systems.jsonl"
SECONDS = "processor time, s"


def figures(folder: Path) -> dict[str, float]:
    """Return what one checkout gives, by what is counted."""
    started = time.process_time()
    checkout = read_checkout(str(folder))
    system = chosen(checkout, systems_of(checkout))
    return {
        "nodes of the launch file that counts (of the code, if there is none)": len(system.nodes),
        "of these with code in the checkout": sum(node.code is not None for node in system.nodes),
        "ends of channels": len(system.ends),
        "gaps": len(system.gaps),
        "uses of what lies outside ROS in code": len(system.externals),
        "what compose files and bridges state": len(checkout.stated),
        "log calls with data of channels": len(system.logs),
        "launch files at the top": len(checkout.launches),
        SECONDS: time.process_time() - started,
    }


def main(folders: list[str]) -> None:
    """Print the table."""
    names = {json.loads(line)["repository"].replace("/", "+") for line in LABELLED.read_text("utf-8").splitlines()}
    there = sorted(path for folder in folders for path in Path(folder).iterdir() if path.name in names)
    columns: dict[str, list[float]] = defaultdict(list)
    crashed = 0
    for path in there:
        try:
            for name, number in figures(path).items():
                columns[name].append(number)
        except Exception:  # noqa: BLE001 - a crash is what is counted
            crashed += 1
            traceback.print_exc()
    graphs = sum(map(bool, columns["ends of channels"]))
    print(f"{len(there)} of {len(names)} systems are there; {graphs} give a graph; {crashed} crashes")
    for name, numbers in columns.items():
        row = f"{name} | {sum(numbers):,.0f}, in {sum(map(bool, numbers))} systems"
        print(f"| {row} | {median(numbers):,.1f} | {quantiles(numbers, n=10)[-1]:,.0f} |")


if __name__ == "__main__":
    main(sys.argv[1:])
