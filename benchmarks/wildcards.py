"""How the flow graph of a policy grows with its wildcards: twice the names, at most 3 times the time, in one run.

    python benchmarks/wildcards.py [--quick]

Shapes of names, as many written as read, 10,000 of each (4,000 with --quick) beside half of them: the flow graph, and
where each meets each the size of what is kept of it, and the whole analysis. Ends with 1 if a bound is missed.
"""

from __future__ import annotations

import pickle
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from measure import Line, compared, print_header, print_line, side_by_side

from rosprivacy.analysis.bounds import Bounds
from rosprivacy.api import analyze
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

BOUND = 3.0  # a step for each pair would take 4
BOUNDS = Bounds(comparisons=10**9, flows=10**7)
OVERLAP = "/robot*/s7* on both sides: each meets each"
LABELS = "labels: 1\nnodes:\n  /writer: {source: [Video]}\n  /reader: {leak: [Video]}\n"
SHAPES: dict[str, tuple[Callable[[int], str], Callable[[int], str]]] = {
    "/ns7/part/* on both sides": (lambda i: f"/ns{i}/part/*", lambda i: f"/ns{i}/part/*"),
    "/robot*/part7/image on both sides": (lambda i: f"/robot*/part{i}/image", lambda i: f"/robot*/part{i}/image"),
    "*/part7/image on both sides": (lambda i: f"*/part{i}/image", lambda i: f"*/part{i}/image"),
    OVERLAP: (lambda i: f"/robot*/s{i}*", lambda i: f"/robot*/s{i}*"),
    "/robot7/* and */image7: each meets each": (lambda i: f"/robot{i}/*", lambda i: f"*/image{i}"),
    "plain names, read as /robot*/part7/*": (lambda i: f"/robot/part{i}/image", lambda i: f"/robot*/part{i}/*"),
    "plain names, read as /robot*/image7": (lambda i: f"/robot/part/image{i}", lambda i: f"/robot*/image{i}"),
}


def written(names: int, shape: str, file: Path) -> str:
    """Return the file of a policy of two nodes: one writes so many names of a shape, one reads as many."""
    written, read = SHAPES[shape]
    profiles = [
        f'<profile ns="/" node="{node}"><topics {role}="ALLOW">'
        + "".join(f"<topic>{name(number)}</topic>" for number in range(names))
        + "</topics></profile>"
        for node, role, name in (("writer", "publish", written), ("reader", "subscribe", read))
    ]
    opening = '<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>'
    file.write_text(f"{opening}{''.join(profiles)}</profiles></enclave></enclaves></policy>", "utf-8")
    return str(file)


def where_all_meet(files: Sequence[str], labels: Path) -> Iterator[Line]:
    """Yield the lines for what is kept of the graph, and for the analysis, of a large policy beside a small one."""
    labels.write_text(LABELS, "utf-8")
    sizes = [len(pickle.dumps(build([read_policy(file)], bounds=BOUNDS))) for file in files]
    texts = [f"{size / 1e6:.1f} MB" for size in sizes]
    yield Line("    what is kept of the graph", texts[0], texts[1], sizes[0] / sizes[1], BOUND)
    seconds = side_by_side(3, *(partial(analyze, file, labels) for file in files))
    yield compared("    files to findings, with the number of paths", seconds, bound=BOUND)


def main() -> int:
    """Print the table; return the exit code."""
    most = 4_000 if "--quick" in sys.argv else 10_000
    print_header()
    missed = 0
    with TemporaryDirectory() as folder:
        for shape in SHAPES:
            files = [written(names, shape, Path(folder, f"{names}.xml")) for names in (most, most // 2)]
            large, small = map(read_policy, files)
            seconds = side_by_side(
                3,
                lambda large=large: build([large], bounds=BOUNDS),  # type: ignore[misc]  # mypy infers no lambda with a default
                lambda small=small: build([small], bounds=BOUNDS),  # type: ignore[misc]  # mypy infers no lambda with a default
            )
            line = compared(f"{most:,} / {most // 2:,} names: {shape}", seconds, bound=BOUND)
            missed += not print_line(line).met
            if shape == OVERLAP:
                missed += sum(not print_line(one).met for one in where_all_meet(files, Path(folder, "labels.yaml")))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
