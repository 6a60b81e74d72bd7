"""The jar files of the private Neo4j: which ones, fetched once, remembered, checked."""

from __future__ import annotations

import json
import sys
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import ParseError

from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.state import extra, write_private

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    Progress = Callable[[Iterable[Path], int], Iterable[Path]]

VERSION = "5.26.30"
BROWSER = "5.24.0"
LIBRARIES = f"org.neo4j:neo4j:{VERSION}+org.neo4j.client:neo4j-browser:{BROWSER}"
JARS = 217  # that these need; for the progress only
DOWNLOADS = 8  # at once


def on_terminal() -> bool:
    """Return whether a person sees what is printed to standard error."""
    return sys.stderr is not None and sys.stderr.isatty()  # None after `2>&-`


def bar(jars: Iterable[Path], total: int) -> Iterable[Path]:
    """Show on a terminal how many of the jar files have been fetched."""
    if not on_terminal():
        return jars
    from rich.console import Console  # noqa: PLC0415 - light start
    from rich.progress import track  # noqa: PLC0415

    return track(jars, "Fetching Neo4j (155 MB, once)", total, console=Console(stderr=True), transient=True)


def jar_files(folder: Path, progress: Progress = bar) -> list[Path]:
    """Return the jar files; once fetched they are remembered in the state folder, and a start needs no network.

    Parameters
    ----------
    folder
        The state folder; the jar files themselves are kept where Maven keeps its own.
    progress
        Wraps the jar files and their number while they are fetched.

    Raises
    ------
    DatabaseError
        If they cannot be fetched; without the ``[local]`` extra.
    """
    listing = folder / "jars.json"
    jars = _remembered(listing)
    if not jars or not all(jar.is_file() for jar in jars):
        try:
            jars = list(progress(_fetch(), JARS))
        except (OSError, RuntimeError, ValueError, AssertionError, ParseError) as error:  # all that jgo raises
            # Its text is not shown: it names hosts, maybe with the user's credentials for a mirror.
            hint = "check the network and the repositories in jgo's settings, then try again"
            raise DatabaseError(f"{LIBRARIES}: cannot be fetched ({type(error).__name__}); {hint}") from error
        write_private(listing, json.dumps({"libraries": LIBRARIES, "jars": [str(jar) for jar in jars]}))
    return jars


def _remembered(listing: Path) -> list[Path]:
    """Return the jar files of the last start if it was of the same version."""
    try:
        known = json.loads(listing.read_text("utf-8"))
        return [Path(jar) for jar in known["jars"]] if known["libraries"] == LIBRARIES else []
    except (OSError, ValueError, KeyError, TypeError):  # none yet, or not as we wrote it
        return []


def _fetch() -> Iterator[Path]:
    with extra():
        import jgo  # noqa: PLC0415
        import truststore  # noqa: PLC0415
        from jgo.config import GlobalSettings  # noqa: PLC0415
    truststore.inject_into_ssl()  # as pip does: what the system trusts, such as a company's own authority
    settings = GlobalSettings.load()
    try:
        artifacts = jgo.resolve(LIBRARIES, repositories=settings.repositories)
    except ParseError:
        # jgo leaves an empty file where a download was broken off, and takes it for the whole the next time.
        for pom in Path(settings.repo_cache).rglob("*.pom"):
            if not pom.read_bytes().rstrip().endswith(b">"):
                pom.unlink()
        artifacts = jgo.resolve(LIBRARIES, repositories=settings.repositories)
    with ThreadPoolExecutor(DOWNLOADS) as pool:
        try:
            yield from pool.map(_fetch_jar, artifacts)
        finally:  # on Ctrl-C, do not fetch the rest
            pool.shutdown(cancel_futures=True)


def _fetch_jar(artifact: Any) -> Path:
    """Download a jar file if it is not there, and again if it is damaged or was broken off."""
    for _ in range(2):
        path = Path(artifact.resolve())
        try:
            with zipfile.ZipFile(path) as jar:
                if jar.testzip() is None:
                    return path
        except zipfile.BadZipFile:
            pass
        path.unlink()
    raise ValueError(f"{path} is damaged")
