"""The process that ``graphviz.py`` starts: jobs from standard input, pictures to standard output.

A job is two parts, each after its length in 8 bytes: JSON, then DOT. The answer is a line of JSON, then ``size`` bytes.
"""

from __future__ import annotations

import json
import math
import os
import signal
import sys
from pathlib import Path
from typing import Any, BinaryIO


def main() -> None:
    """Draw until there is nothing more to read."""
    # Nothing is imported from the folder of this file, whose names may be those of packages.
    here = str(Path(__file__).resolve().parent)
    sys.path[:] = [folder for folder in sys.path if folder != here]
    # Graphviz and others may print to file 1: the answers go out by another number.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    jobs = sys.stdin.buffer
    while (head := _part(jobs)) is not None and (dot := _part(jobs)) is not None:
        job = json.loads(head)
        if hasattr(signal, "alarm"):  # should our parent be gone: no layout outlives its limit for long
            signal.alarm(math.ceil(job["seconds"]) + 5)
        error, data, loaded = "", b"", True
        try:
            data = _draw(job, dot.decode())
        except ImportError as problem:  # most likely a library of the system that a wheel leaves out
            error, loaded = str(problem), False
        except Exception as problem:  # noqa: BLE001 - whatever it is, the parent says it
            error = str(problem) or type(problem).__name__
        if hasattr(signal, "alarm"):
            signal.alarm(0)
        answers.write(json.dumps({"error": error, "size": len(data), "loaded": loaded}).encode() + b"\n" + data)
        answers.flush()


def _part(stream: BinaryIO) -> bytes | None:
    length = stream.read(8)
    return stream.read(int.from_bytes(length, "big")) if length else None


def _draw(job: dict[str, Any], dot: str) -> bytes:
    import pygraphviz  # noqa: PLC0415 - not everywhere: without it the error is an answer too

    graph = pygraphviz.AGraph(string=dot)
    for name, value in job["attributes"].items():
        graph.graph_attr[name] = value
    data: bytes = graph.draw(format=job["form"], prog=job["engine"])
    graph.close()
    return data


if __name__ == "__main__":
    main()
