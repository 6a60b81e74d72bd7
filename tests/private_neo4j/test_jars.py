"""The jar files of the private Neo4j are those that were pinned, or nothing is started.

The list was made from what jgo resolves, by ``python -m tests.private_neo4j.test_jars``.
"""

from __future__ import annotations

import hashlib
import io
import os
import shutil
import sys
import threading
import zipfile
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.private_neo4j import connection, jars

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.private_neo4j.connection import Connection

LIST = Path(jars.__file__).with_name(jars.LIST)
HEAD = """\
# The jar files of the private Neo4j, by SHA-256, in the order of its class path; paths as in a Maven repository.
# Made by `python -m tests.private_neo4j.test_jars`; in ~/.m2/repository this is what `sha256sum --check` reads.
"""
Mirror = dict[str, bytes]


def a_jar(text: str) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as jar:
        jar.writestr(zipfile.ZipInfo("Some.class"), text)
    return packed.getvalue()


def listed() -> str:
    """The list as it is to be: what jgo resolves now."""
    import jgo

    lines = []
    for artifact in jgo.resolve(jars.LIBRARIES):
        digest = hashlib.sha256(Path(artifact.resolve()).read_bytes()).hexdigest()
        lines.append(f"{digest}  {PurePosixPath(artifact.component.path_prefix) / artifact.filename}\n")
    return HEAD + "".join(lines)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty Maven repository of the user's own; NEO4J_URI is not set, and nothing was started yet."""
    monkeypatch.setenv("JGO_CONFIG_FILE", str(tmp_path / "jgo.conf"))
    monkeypatch.setenv("ROSPRIVACY_DATA", str(tmp_path / "data"))
    monkeypatch.delenv("NEO4J_URI", raising=False)
    (tmp_path / "jgo.conf").write_text(f"[settings]\nrepo_cache = {tmp_path / 'm2'}\n", "utf-8")
    return tmp_path / "m2"


@pytest.fixture
def mirror(cache: Path) -> Iterator[Callable[[bytes], None]]:
    """A Maven repository on this machine that serves one jar for all, with a SHA-1 that fits."""
    served = {"": b""}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            jar = served[""]
            body = hashlib.sha1(jar).hexdigest().encode() if self.path.endswith(".sha1") else jar  # noqa: S324 - Maven's
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: Any) -> None: ...

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with (cache.parent / "jgo.conf").open("a", encoding="utf-8") as config:
            config.write(f"[repositories]\ncentral = http://127.0.0.1:{server.server_port}\n")
        yield partial(served.__setitem__, "")
        server.shutdown()


@pytest.fixture
def one(monkeypatch: pytest.MonkeyPatch) -> Path:
    """One small jar is pinned, not Neo4j's; return where it is in a repository."""
    path = PurePosixPath("org/example/some/1.0/some-1.0-natives.jar")
    only = jars.PinnedJar(hashlib.sha256(a_jar("good")).hexdigest(), path)
    monkeypatch.setattr(jars, "pinned", lambda: (only,))
    return Path(path)


def refused(call: Callable[[], object]) -> str:
    with pytest.raises(DatabaseError) as error:
        call()
    assert "\n" not in str(error.value)
    return str(error.value)


def test_the_list_names_each_jar_once_with_a_hash() -> None:
    names = [jar.path for jar in jars.pinned()]
    assert len(names) == len(set(names)) == 217
    assert all(len(bytes.fromhex(jar.sha256)) == 32 for jar in jars.pinned())
    assert PurePosixPath(f"org/neo4j/neo4j/{jars.VERSION}/neo4j-{jars.VERSION}.jar") in names
    browser = f"org/neo4j/client/neo4j-browser/{jars.BROWSER}/neo4j-browser-{jars.BROWSER}.jar"
    assert PurePosixPath(browser) in names


@pytest.mark.usefixtures("local_extra")
def test_what_a_mirror_puts_in_place_of_a_jar_is_not_started(mirror: Callable[[bytes], None], cache: Path) -> None:
    """Its SHA-1 fits, and it is a whole jar file: only the pinned hash tells."""
    mirror(a_jar("of somebody else"))
    said = refused(connection.start)
    assert said.startswith(f"{cache}{os.sep}org")
    assert "is not the file that this version of rosprivacy was made with: its SHA-256 differs; nothing was st" in said
    assert not connection.status().running
    assert not (cache.parent / "data" / "neo4j" / "jars.json").exists()
    assert not (cache.parent / "data" / "neo4j" / "conf").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("local_extra")
@pytest.mark.parametrize("there", ["nothing", "half", "page"])
def test_a_jar_that_was_broken_off_is_fetched_again(
    there: str, mirror: Callable[[bytes], None], cache: Path, one: Path, tmp_path: Path
) -> None:
    good = a_jar("good")
    mirror(good)
    if there != "nothing":
        (cache / one).parent.mkdir(parents=True)
        (cache / one).write_bytes(good[: len(good) // 2] if there == "half" else b"<html>sign in first</html>")
    assert jars.jar_files(tmp_path) == [cache / one]
    assert (cache / one).read_bytes() == good


@pytest.mark.usefixtures("local_extra")
def test_a_jar_that_stays_damaged_is_an_error(
    mirror: Callable[[bytes], None], cache: Path, one: Path, tmp_path: Path
) -> None:
    mirror(b"<html>sign in first</html>")
    assert "cannot be fetched (ValueError); check the network" in refused(lambda: jars.jar_files(tmp_path))
    assert not (cache / one).exists()


@pytest.mark.usefixtures("local_extra")
def test_a_verified_jar_is_read_again_only_if_it_was_changed(
    mirror: Callable[[bytes], None], cache: Path, one: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mirror(a_jar("good"))
    jar = cache / one
    assert jars.jar_files(tmp_path) == [jar]
    with monkeypatch.context() as patch:
        patch.setattr(jars, "_digest", None)  # nothing is hashed
        patch.setitem(sys.modules, "jgo", None)  # and nothing looked up
        assert jars.jar_files(tmp_path) == [jar]

    before = jar.stat()
    jar.write_bytes(a_jar("evil"))
    os.utime(jar, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert (jar.stat().st_size, jar.stat().st_mtime_ns) == (before.st_size, before.st_mtime_ns)
    assert refused(lambda: jars.jar_files(tmp_path)).startswith(f"{jar}: is not the file that ")
    jar.unlink()
    assert jars.jar_files(tmp_path) == [jar]
    assert jar.read_bytes() == a_jar("good")


@pytest.mark.usefixtures("local_extra")
def test_jars_that_another_list_verified_are_verified_again(
    mirror: Callable[[bytes], None], cache: Path, one: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mirror(a_jar("good"))
    assert jars.jar_files(tmp_path) == [cache / one]
    monkeypatch.setattr(jars, "_list", lambda: "another")
    other = jars.PinnedJar("0" * 64, PurePosixPath(one))
    monkeypatch.setattr(jars, "pinned", lambda: (other,))
    assert "its SHA-256 differs" in refused(lambda: jars.jar_files(tmp_path))


@pytest.mark.slow
@pytest.mark.database
def test_one_changed_jar_among_all_is_enough(private_neo4j: Connection, cache: Path, tmp_path: Path) -> None:
    """A start with all the real files, of which one has a class more."""
    known = jars._remembered(Path(private_neo4j.origin).parent / "jars.json")
    for jar, real in zip(jars.pinned(), known, strict=True):
        (cache / jar.path).parent.mkdir(parents=True, exist_ok=True)
        (cache / jar.path).symlink_to(real)
    changed = cache / jars.pinned()[100].path
    real = changed.resolve()
    changed.unlink()
    shutil.copy(real, changed)
    with zipfile.ZipFile(changed, "a") as jar_file:
        jar_file.writestr("evil/Evil.class", "x")
    assert refused(connection.start).startswith(f"{changed}: is not the file that ")
    assert not (tmp_path / "data" / "neo4j" / "server.json").exists()


@pytest.mark.thorough  # what Maven's repository has; `make locks` is when our list changes
@pytest.mark.database
def test_the_list_is_what_jgo_resolves(local_extra: None) -> None:  # noqa: ARG001 - it brings jgo
    assert LIST.read_text("utf-8") == listed()


if __name__ == "__main__":
    LIST.write_text(listed(), "utf-8")
