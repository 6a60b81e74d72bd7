"""The page of what is in a real Neo4j: it shows what the analysis of the database says, and changes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.application import Site
from rosprivacy.explorer.web.guard import RequestDoor
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from rosprivacy.systems.stored_system import answer_unwritten
from tests.helpers.explorers import PORT
from tests.helpers.graphs import care_home, rows_of

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Connection


@pytest.mark.slow
@pytest.mark.database
def test_what_is_in_a_database_is_shown_and_not_changed(neo4j_server: Connection) -> None:
    from starlette.testclient import TestClient

    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        result = care_home()
        load(driver, [rows_of("h1", result)], result.vocabulary)
        before = driver.execute_query("MATCH (n)-[r]->(m) RETURN count(n), count(r)").records
        session = Session.open_database(driver)
        assert session.result.to("json1") == answer_unwritten(driver, Settings()).to("json1")
        after = driver.execute_query("MATCH (n)-[r]->(m) RETURN count(n), count(r)").records
    door = RequestDoor(PORT, True)
    site = Site(session, Settings(), Words("en"), door)
    client = TestClient(site.application(), base_url=f"http://127.0.0.1:{PORT}", follow_redirects=False)
    client.headers["origin"] = f"http://127.0.0.1:{PORT}"
    client.get(door.link)
    page = client.get("/")
    assert page.status_code == 200
    assert "What is in the database is shown, and not changed" in page.text
    assert session.findings[0].leak.name in page.text
    assert client.post("/undo", data={"version": "0"}).status_code in (403, 405)
    assert client.get("/?draw=all").status_code == 200
    site.close()
    assert before == after
    with pytest.raises(InputErrors, match="shown, and not changed; change the label file"):
        session.label("/recorder", conduit=True)
    with pytest.raises(InputError, match="shown, and not changed"):
        session.save_as("l.yaml")
