"""The explorer's page for tests: a session of files of ours behind its server, and clients that opened the link."""

from __future__ import annotations

import re
import shutil
import threading
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from starlette.testclient import TestClient

from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.application import Site
from rosprivacy.explorer.web.cypher_site import StoredSite
from rosprivacy.explorer.web.guard import RequestDoor
from rosprivacy.explorer.web.review_site import ReviewSite
from rosprivacy.explorer.web.serving import bound_socket, server
from rosprivacy.question import question_of
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_system
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

PORT = 8700
FACTORY = ROOT / "examples" / "factory"
BARE, FILTERED = FACTORY / "before.policy.xml", FACTORY / "after.policy.xml"


class Explorer:
    """A session and its site.

    Parameters
    ----------
    labels
        The file that is edited; it need not be there.
    root
        What the policy may include from.
    journal
        Where what is not saved is written down.
    review
        Whether it asks one question at a time.
    fleet
        Whether the policy is a fleet file, which names its label files itself.
    decisions
        Where decisions about findings are written.
    types
        What was observed of the types of channels.
    """

    def __init__(
        self, policy: Path, labels: Path, *, port: int = PORT, read_only: bool = False, language: str = "en",
        root: Path | None = None, journal: Path | None = None, review: bool = False, fleet: bool = False,
        decisions: Path | None = None, types: Path | None = None,
    ) -> None:  # fmt: skip
        settings = Settings(
            include_root=str(root) if root else None,
            decisions=str(decisions) if decisions else None,
            types=(str(types),) if types else (),
        )
        self.labels, self.door = labels, RequestDoor(port, read_only)
        self.session = (
            Session.open_fleet(str(policy), settings, journal=journal)
            if fleet
            else Session.open([str(policy)], [str(labels)], settings, journal=journal)
        )
        self.site = (ReviewSite if review else Site)(self.session, settings, Words(language), self.door)
        self.app = self.site.application()

    def client(self) -> TestClient:
        """A browser that has opened the link."""
        client = TestClient(self.app, base_url=f"http://127.0.0.1:{self.door.port}", follow_redirects=False)
        client.headers["origin"] = f"http://127.0.0.1:{self.door.port}"
        assert client.get(self.door.link).status_code == 200
        return client


class _Stored(Explorer):
    """What stands in a database, as a page shows it; the server is gone when it is asked."""

    def __init__(self, policy: Path, labels: Path, *, port: int = PORT) -> None:
        asked = question_of(Settings())._replace(every=True)
        system = replace(robot_system((str(policy),), (str(labels),), asked), under=None)
        self.labels, self.door, self.session = (
            labels,
            RequestDoor(port, read_only=True),
            Session.of_stored(system, asked),
        )
        self.site = StoredSite(self.session, Settings(), Words("en"), self.door, _gone)
        self.app = self.site.application()


def _gone() -> NoReturn:
    raise DatabaseError("no Neo4j answers there")


begin_stored = _Stored


def node(name: str) -> str:
    """The id of a node."""
    return element_id(("", "node", name))


def label(client: TestClient, element: str, role: str, **fields: Any) -> Any:
    """Post an answer as the page of now does."""
    return client.post("/label", data={"version": version(client), "element": element, "role": role, **fields})


def version(client: TestClient) -> str:
    """The version that the page shows."""
    found = re.search(r'data-version="(\d+)"', client.get("/").text)
    assert found
    return found[1]


def copied(file: Path, folder: Path) -> Path:
    """A label file of the examples that a test may change."""
    return Path(shutil.copy(file, folder / file.name))


@contextmanager
def served(policy: Path, labels: Path, **how: Any) -> Iterator[Explorer]:
    """The page on a real server of this machine."""
    with bound_socket(0) as listening:
        explorer = Explorer(policy, labels, port=listening.getsockname()[1], **how)
        running = server(explorer.app)
        thread = threading.Thread(target=running.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            yield explorer
        finally:
            running.should_exit = True
            thread.join()
            explorer.site.close()
