"""One slice of one target, guided by coverage: started by ``run.py`` as a process of its own.

    python -m tests.fuzzing.explore TARGET FOLDER --inputs N [--seed 1] [--whole-every 35]

libFuzzer (atheris) mutates the bytes behind the choices and keeps in ``FOLDER/corpus/TARGET`` what reaches new code.
Only readers are watched; what analyses and reports runs as fast as it does.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path

READERS = [
    "rosprivacy.ingest", "rosprivacy.ontology.own", "rosprivacy.ontology.own", "rosprivacy.ontology.turtle",
    "rosprivacy.analysis.durations", "rosprivacy.analysis.text", "rosprivacy.analysis.written_names",
    "rosprivacy.queries.library", "rosprivacy.report.compare", "rosprivacy.parts.parquet",
]  # fmt: skip
LONGEST = 400  # bytes of choices


def main() -> None:
    """Run a slice."""
    import atheris  # before anything of ours, which it has to see when it is loaded

    with atheris.instrument_imports(include=READERS):
        from tests.fuzzing import judge
        from tests.fuzzing.kept_graphviz import kept_graphviz
        from tests.fuzzing.slices import Slice
        from tests.fuzzing.targets import TARGETS
        from tests.fuzzing.watch import Watch
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
            f"-seed={asked.seed}", f"-max_len={LONGEST}", "-len_control=0", "-timeout=60", "-rss_limit_mb=4096",
            "-handle_term=0", f"-artifact_prefix={folder}/faults/{target.name}-", str(corpus),
        ]  # fmt: skip
        atheris.Setup([sys.argv[0], *options], piece.one)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
