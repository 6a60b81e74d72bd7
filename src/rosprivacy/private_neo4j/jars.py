"""The jar files of the private Neo4j: which ones, fetched once, verified, remembered.

They are pinned: ``neo4j-jars.sha256`` names each with its SHA-256; nothing else is fetched or put on the class path.
"""

from __future__ import annotations

import hashlib
import json
import sys
import zipfile
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import DatabaseError, shown
from rosprivacy.private_neo4j.state import extra, write_private

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from jgo.maven import MavenContext

    Progress = Callable[[Iterable[Path], int], Iterable[Path]]
    Stamp = tuple[int, ...]

VERSION = "5.26.30"
BROWSER = "5.24.0"
LIBRARIES = f"org.neo4j:neo4j:{VERSION}+org.neo4j.client:neo4j-browser:{BROWSER}"  # what the pinned files are for
LIST = "neo4j-jars.sha256"
DOWNLOADS = 8  # at once


class PinnedJar(NamedTuple):
    """A jar file that belongs to the server."""

    sha256: str
    path: PurePosixPath  # in a Maven repository: group/…/artifact/version/file


@cache
def pinned() -> tuple[PinnedJar, ...]:
    """Return the jar files in the order of the class path."""
    lines = _list().splitlines()
    parts = [line.split("  ", 1) for line in lines if not line.startswith("#")]
    return tuple(PinnedJar(sha256, PurePosixPath(path)) for sha256, path in parts)


def _list() -> str:
    return files("rosprivacy.private_neo4j").joinpath(LIST).read_text("utf-8")


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
    """Return the jar files, each verified by its SHA-256.

    Once fetched they are remembered in the state folder with size and times: a start needs no network, and reads only
    those again that were changed since.

    Parameters
    ----------
    folder
        The state folder; the jar files themselves are kept where Maven keeps its own.
    progress
        Wraps the jar files and their number while they are fetched and verified.
    """
    listing = folder / "jars.json"
    jars = _remembered(listing)
    if not jars:
        try:
            jars = list(progress(_fetch(), len(pinned())))
        except (OSError, RuntimeError, ValueError, AssertionError) as error:  # all that jgo raises
            # Its text is not shown: it names hosts, maybe with the user's credentials for a mirror.
            hint = "check the network and the repositories in jgo's settings, then try again"
            raise DatabaseError(f"{LIBRARIES}: cannot be fetched ({type(error).__name__}); {hint}") from error
        stamps = {str(jar): _stamp(jar) for jar in jars}
        write_private(listing, json.dumps({"pinned": _version_of_list(), "jars": stamps}))
    return jars


def _remembered(listing: Path) -> list[Path]:
    """Return the jar files that were verified before, by this list of ours, if none was changed since."""
    try:
        known = json.loads(listing.read_text("utf-8"))
        if known["pinned"] != _version_of_list():
            return []
        jars = {Path(jar): tuple(stamp) for jar, stamp in known["jars"].items()}
        return list(jars) if all(_stamp(jar) == stamp for jar, stamp in jars.items()) else []
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return []  # none yet, or not as we wrote it


def _version_of_list() -> str:
    return hashlib.sha256(_list().encode()).hexdigest()


def _stamp(jar: Path) -> Stamp:
    """Return what changes with a file: its size and its times, of which the second cannot be set back."""
    state = jar.stat()
    return state.st_size, state.st_mtime_ns, state.st_ctime_ns


def _fetch() -> Iterator[Path]:
    with extra():
        import truststore  # noqa: PLC0415
        from jgo.config import GlobalSettings  # noqa: PLC0415
        from jgo.maven import MavenContext  # noqa: PLC0415
    truststore.inject_into_ssl()  # as pip does: what the system trusts, such as a company's own authority
    settings = GlobalSettings.load()
    central = MavenContext().remote_repos
    context = MavenContext(repo_cache=settings.repo_cache, remote_repos=central | settings.repositories)
    with ThreadPoolExecutor(DOWNLOADS) as pool:
        try:
            yield from pool.map(lambda jar: _fetch_jar(context, jar), pinned())
        finally:  # on Ctrl-C or a wrong file, do not fetch the rest
            pool.shutdown(cancel_futures=True)


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _fetch_jar(context: MavenContext, jar: PinnedJar) -> Path:
    """Download a jar file if it is not there, and again if it was broken off."""
    *group, artifact, version, file = jar.path.parts
    classifier = file.removeprefix(f"{artifact}-{version}").removesuffix(".jar").removeprefix("-")
    wanted = context.project(".".join(group), artifact).at_version(version).artifact(classifier, "jar")
    for _ in range(2):
        path = Path(wanted.resolve())
        if _digest(path) == jar.sha256:
            return path
        if zipfile.is_zipfile(path):  # whole, and yet another
            problem = "is not the file that this version of rosprivacy was made with: its SHA-256 differs"
            hint = "nothing was started; find out where it comes from, remove it, then try again"
            raise DatabaseError(f"{shown(str(path))}: {problem}; {hint}")
        path.unlink()
    raise ValueError(f"{path} is damaged")
