"""What the tests need of the network beside Python packages, fetched before they begin: how much, and how far it is."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.private_neo4j.jars import jar_files, pinned
from tests.helpers import java

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

MEGABYTES = 155  # of all jar files; their list names no sizes
STEPS = 10


def missing() -> int:
    """How many of the private Neo4j's jar files are not where Maven keeps them."""
    from jgo.config import GlobalSettings

    kept = Path(GlobalSettings.load().repo_cache)
    return sum(not (kept / jar.path).is_file() for jar in pinned())


def told(jars: Iterable[Path], total: int) -> Iterator[Path]:
    """Say after each tenth how many have come; a log has no bar."""
    for number, jar in enumerate(jars, 1):
        if number * STEPS // total > (number - 1) * STEPS // total:
            print(f"  {number} of {total}", flush=True)
        yield jar


def main() -> None:
    """Fetch them; without a network the tests that need them say so."""
    gone, total = missing(), len(pinned())
    if not gone:
        print(f"Neo4j for the tests: all {total} jar files are here, nothing to fetch")
        keep_classes()
        return
    print(f"Neo4j for the tests: fetching {gone} of {total} jar files ({MEGABYTES} MB in all, once)", flush=True)
    try:
        with tempfile.TemporaryDirectory() as folder:
            jar_files(Path(folder), told)
    except DatabaseError as error:
        print(error, file=sys.stderr)
        return
    keep_classes()


def keep_classes() -> None:
    """Make each start of Java take half as long; without that the tests take longer, and no more."""
    try:
        java.make()
    except (OSError, subprocess.SubprocessError) as error:
        print(f"{error}: each start of Neo4j takes longer", file=sys.stderr)


if __name__ == "__main__":
    main()
