"""Who asks questions on the page of a real database."""

from __future__ import annotations

from contextlib import closing, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from lxml import html
from starlette.testclient import TestClient

from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.cypher_site import StoredSite
from rosprivacy.explorer.web.guard import RequestDoor
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from tests.helpers.explorers import PORT
from tests.helpers.graphs import care_home, rows_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.private_neo4j.connection import Connection

HERE = {"origin": f"http://127.0.0.1:{PORT}"}
ENDLESS = "UNWIND range(1, 1000000000) AS x WITH x WHERE x < 0 RETURN x"


class Asker(NamedTuple):
    """A browser that opened the link, and the site behind it."""

    site: StoredSite
    client: TestClient

    def ask(self, text: str = "", **fields: str) -> Any:
        return self.client.post("/cypher", data={"text": text, **fields})

    def page(self, text: str = "", **fields: str) -> Any:
        answer = self.ask(text, **fields)
        assert answer.status_code == 200, told(answer)
        return html.fromstring(answer.text)


def told(answer: Any) -> str:
    """What the page says above of a question that was not answered."""
    return "\n".join(p.text_content() for p in html.fromstring(answer.text).xpath("//*[@role='alert']/p"))


@contextmanager
def asker(to: Connection, *, read_only: bool = True, language: str = "en", seconds: float = 20.0) -> Iterator[Asker]:
    with connection.open_driver(to) as driver:
        session = Session.open_database(driver)
    door = RequestDoor(PORT, read_only)
    opens = partial(connection.open_driver, to)
    site = StoredSite(session, Settings(), Words(language), door, opens, seconds)
    with closing(site):
        client = TestClient(site.application(), base_url=HERE["origin"], follow_redirects=False)
        client.headers.update(HERE)
        client.get(door.link)
        yield Asker(site, client)


def load_care_home(to: Connection) -> None:
    """Put the care home into an empty database, as robot h1."""
    with connection.open_driver(to) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        result = care_home()
        load(driver, [rows_of("h1", result)], result.vocabulary)
