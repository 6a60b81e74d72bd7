"""A cluster of Spark on this machine: a master and two workers, processes of their own."""

from __future__ import annotations

import os
import socket
import subprocess
import time
from contextlib import ExitStack, contextmanager, suppress
from typing import TYPE_CHECKING

from rosprivacy.parts import session as spark
from rosprivacy.parts.session import HOST

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

OPENED = [f"--add-opens=java.base/{name}=ALL-UNNAMED" for name in ("java.lang", "java.nio", "sun.nio.ch", "java.util")]


@contextmanager
def spark_cluster(folder: Path, host: str = HOST, port: int = 0) -> Iterator[tuple[str, list[int]]]:
    """Start one, with its logs in a folder; on a port that is free where none is named.

    Yields
    ------
    tuple[str, list[int]]
        The address of the master, and the workers' numbers as processes.
    """
    home, java = spark._spark_home(), spark._java_home(folder)
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PYSPARK"))}
    environment |= {"SPARK_LOCAL_IP": HOST, "SPARK_HOME": str(home), "JAVA_HOME": str(java)}
    environment |= {"SPARK_SCALA_VERSION": "2.13", "PATH": os.defpath}  # the first is set by the scripts of Spark
    with socket.socket() as some:
        some.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        some.bind((HOST, port))
        port = int(some.getsockname()[1])
    address = f"spark://{host}:{port}"
    deploy, common = "org.apache.spark.deploy", ["--host", host, "--webui-port", "0"]
    roles = [
        [f"{deploy}.master.Master", *common, "--port", str(port)],
        *([f"{deploy}.worker.Worker", *common, "-c", "1", "-m", "1g", "-d", str(folder / n), address] for n in "ab"),
    ]
    with ExitStack() as stack:
        numbers = []
        for number, role in enumerate(roles):
            log = stack.enter_context((folder / f"{number}.log").open("wb"))
            process = subprocess.Popen(
                [str(java / "bin" / "java"), *OPENED, "-Xmx300m", "-cp", str(home / "jars" / "*"), *role],
                cwd=folder, env=environment, stdout=log, stderr=log,
            )  # fmt: skip
            stack.callback(process.wait)
            stack.callback(process.terminate)
            numbers.append(process.pid)
            for _ in range(600 if number == 0 else 0):
                with suppress(OSError), socket.create_connection((HOST, port), 1):
                    break
                time.sleep(0.1)
        yield address, numbers[1:]
