"""What a scan gives of many checkouts, by numbers only: ``python -m tests.scanned.whole_set FOLDER…``.

Each folder within FOLDER is read as one checkout. Those named OWNER+NAME after a line of
``tests/labelled/systems.jsonl``, which says their commits, are counted as systems of the labelled set.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import traceback
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
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


def table(columns: dict[str, list[float]]) -> list[str]:
    """Return a line for what is counted: its sum, in how many checkouts it is, the median and the ninth decile."""
    lines = ["| counted | sum | checkouts | median | ninth decile |", "| --- | --- | --- | --- | --- |"]
    for name, numbers in columns.items():
        ninth = quantiles(numbers, n=10)[-1] if len(numbers) > 1 else numbers[0]
        row = f"{sum(numbers):,.0f} | {sum(map(bool, numbers))} | {median(numbers):,.1f} | {ninth:,.0f}"
        lines.append(f"| {name} | {row} |")
    return lines


def tried(folder: Path) -> dict[str, float] | str:
    """Return the figures of a checkout, or how reading it crashed."""
    try:
        return figures(folder)
    except Exception:  # noqa: BLE001 - a crash is what is counted
        return traceback.format_exc()


def main(words: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.scanned.whole_set")
    parser.add_argument("folders", type=Path, nargs="+", metavar="FOLDER")
    parser.add_argument("--jobs", type=int, help="processes at once; by default as many as there are processors")
    arguments = parser.parse_args(words)
    names = {json.loads(line)["repository"].replace("/", "+") for line in LABELLED.read_text("utf-8").splitlines()}
    checkouts = sorted(path for folder in arguments.folders for path in folder.iterdir() if path.is_dir())
    columns: dict[str, list[float]] = defaultdict(list)
    crashed = 0
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for path, counts in zip(checkouts, pool.map(tried, checkouts), strict=True):
            if isinstance(counts, str):
                crashed += 1
                print(path, counts, sep="\n", file=sys.stderr)
                continue
            for name, number in counts.items():
                columns[name].append(number)
    graphs = sum(map(bool, columns["ends of channels"]))
    labelled = sum(path.name in names for path in checkouts)
    print(f"{len(checkouts)} checkouts, {labelled} of the {len(names)} systems of the labelled set among them")
    print(f"{graphs} give a graph; {crashed} crashes")
    print(*table(columns), sep="\n")


if __name__ == "__main__":
    main()
