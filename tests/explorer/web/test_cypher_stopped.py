"""The server is stopped while it answers the page; in a file of its own, since another one runs after it."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.private_neo4j import connection
from tests.helpers.askers import ENDLESS, asker, load_care_home, told

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Connection

pytestmark = [pytest.mark.database, pytest.mark.slow]


def test_a_server_that_is_stopped_while_it_answers_is_told(private_neo4j: Connection) -> None:
    load_care_home(private_neo4j)
    with asker(private_neo4j, seconds=60) as here:
        answers: list[Any] = []
        asking = threading.Thread(target=lambda: answers.append(here.ask(ENDLESS)))
        asking.start()
        asking.join(3)
        assert connection.stop()
        asking.join()
        assert answers[0].status_code == 503
        assert told(answers[0]).endswith(("; start it, or check address and network", "; try again"))
        again = here.ask(ENDLESS)
        assert again.status_code == 503
        assert "no Neo4j answers there" in told(again)
        assert "UNWIND range(1, 1000000000)" in again.text
        assert here.client.get("/").status_code == 200
