"""Questions on the page of a real Neo4j: they read, whatever is tried, and what cannot be answered is told."""

from __future__ import annotations

import threading
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest
from lxml import html
from starlette.testclient import TestClient

from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.cypher_site import AT_ONCE, BOXES, LETTERS, LONGEST_CELL, LONGEST_TEXT, ROWS
from rosprivacy.explorer.web.guard import LARGEST
from rosprivacy.private_neo4j import connection
from rosprivacy.private_neo4j.connection import Connection
from rosprivacy.queries.library import pack
from tests.helpers.askers import ENDLESS, HERE, Asker, asker, load_care_home, told
from tests.helpers.explorers import BARE, node

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from rosprivacy.analysis.answer import Finding
    from tests.helpers.explorers import Explorer

pytestmark = pytest.mark.database
HOSTILE = """<script>alert(1)</script>"' onload=x {{7*7}}"""


def cells(page: Any) -> list[list[str]]:
    return [[cell.text_content() for cell in row.xpath("./td")] for row in page.xpath("//tbody/tr")]


@pytest.fixture(scope="module")
def loaded(neo4j_server: Connection) -> Connection:
    """The care home as robot h1."""
    load_care_home(neo4j_server)
    return neo4j_server


@pytest.fixture(scope="module")
def here(loaded: Connection) -> Iterator[Asker]:
    with asker(loaded) as found:
        yield found


@pytest.fixture(scope="module")
def hasty(loaded: Connection) -> Iterator[Asker]:
    """As ``here``; a question may take 2 seconds."""
    with asker(loaded, seconds=2) as found:
        yield found


def facts(to: Connection) -> list[list[Any]]:
    """How much there is in the database, and of what."""
    with connection.open_driver(to) as driver:
        count = "MATCH (n) OPTIONAL MATCH (n)-[r]->() RETURN labels(n) AS l, count(r) AS r, sum(size(keys(n))) AS k"
        rows = driver.execute_query(f"{count} ORDER BY l").records
        schema = driver.execute_query("SHOW INDEXES YIELD name RETURN name ORDER BY name").records
        return [record.values() for record in (*rows, *schema)]


# --- what is asked and what comes back -------------------------------------------------------------------------------


@pytest.mark.slow
def test_every_question_of_the_pack_is_one_click_away_with_its_fields(here: Asker) -> None:
    links = html.fromstring(here.client.get("/cypher").text).xpath("//nav[@id='questions']//a/@href")
    assert len(links) == len(pack())
    for link, query in zip(links, pack().values(), strict=True):
        page = html.fromstring(here.client.get(link).text)
        (form,) = (form for form in page.forms if form.fields.get("ask"))
        assert form.fields["ask"] == query.name
        fields = {name.removeprefix("p-") for name in form.fields if name.startswith("p-")}
        assert fields == {field.name for field in query.parameters}
        assert query.description in form.text_content()


def test_a_question_of_the_pack_gives_the_rows_of_the_command(here: Asker, loaded: Connection) -> None:
    from rosprivacy.queries.run import run

    page = here.page(ask="findings")
    with connection.open_driver(loaded) as driver:
        rows = run(driver, pack()["findings"].text, {"robot": "", "category": ""}).rows
    assert len(rows) > 2
    assert [row[4:6] for row in cells(page)] == [list(row[4:6]) for row in rows]
    assert f"{len(rows)} rows" in page.findtext(".//title")
    assert cells(here.page(ask="findings", **{"p-category": "Voice"})) == [
        row for row in cells(page) if row[3] == "Voice"
    ]


@pytest.mark.slow
def test_paths_are_drawn_and_stand_in_the_table_too(here: Asker) -> None:
    page = here.page(ask="leak-path-graph")
    assert page.xpath("//*[local-name()='svg'][contains(@class, 'picture')]//*[contains(@class, 'box')]")
    ways = [row[4] for row in cells(page)]  # the way itself
    assert ways
    boxes = page.xpath("//*[contains(@class, 'box')][@data-element]/@href")
    assert boxes
    assert all(here.client.get(address).status_code == 200 for address in boxes)
    names = {a.xpath("./*[local-name()='title']")[0].text.split(" (")[0] for a in page.xpath("//a[@data-element]")}
    assert all(name in " ".join(ways) for name in names)


def test_what_is_no_element_is_drawn_with_its_labels_and_leads_nowhere(here: Asker) -> None:
    page = here.page("MATCH p = (:RosNode)-[:IN_ENCLAVE]->(:Enclave) RETURN p")
    svg = html.tostring(page.xpath("//*[local-name()='svg'][contains(@class, 'picture')]")[0], encoding="unicode")
    assert "IN_ENCLAVE" in svg
    assert "Enclave" in svg
    assert not page.xpath("//a[contains(@class, 'kind-record')]")


def test_rows_without_anything_of_the_graph_have_no_picture_and_say_so(here: Asker) -> None:
    page = here.page("RETURN 1 AS a")
    assert cells(page) == [["1"]]
    assert "No picture" in page.text_content()
    assert "No rows: nothing" in here.page("MATCH (n:Robot {name: 'nobody'}) RETURN n").text_content()


def test_rows_are_bounded_and_it_is_told(here: Asker) -> None:
    page = here.page(f"UNWIND range(1, {ROWS}) AS x RETURN x")
    assert len(cells(page)) == ROWS
    assert "Only the first" not in page.text_content()
    page = here.page(f"UNWIND range(1, {ROWS + 1}) AS x RETURN x")
    assert len(cells(page)) == ROWS
    assert f"Only the first {ROWS} rows are shown" in page.text_content()


def test_letters_are_bounded_and_it_is_told(here: Asker) -> None:
    ((cell,),) = cells(here.page(f"RETURN reduce(t = '', n IN range(1, {LONGEST_CELL + 5}) | t + 'ä') AS t"))
    assert cell.startswith("ä" * LONGEST_CELL)
    assert cell.endswith("… (5 more letters)")
    wide = ", ".join(f"t AS t{n}" for n in range(10))
    text = f"WITH reduce(t = '', n IN range(1, {LONGEST_CELL}) | t + 'a') AS t UNWIND range(1, 100) AS x RETURN {wide}"
    page = here.page(text)
    assert len(cells(page)) == LETTERS // (10 * LONGEST_CELL)
    assert "Only the first" in page.text_content()


def test_a_picture_is_bounded_and_says_how_much_it_shows(here: Asker) -> None:
    page = here.page("MATCH (a:Element), (b:Element) RETURN a, b ORDER BY a.id, b.id")
    assert 2 < len(page.xpath("//a[contains(@class, 'box')]")) <= BOXES
    whole = here.page("MATCH (a) RETURN collect(a) AS every")
    assert len(cells(whole)) == 1


@pytest.mark.slow
def test_a_question_can_be_changed_with_what_was_typed_in_it(here: Asker) -> None:
    for query in pack().values():
        needed = {f"p-{field.name}": "/it's" for field in query.parameters if field.default is None}
        page = here.page(ask=query.name, do="edit", **needed)
        text = page.xpath("//textarea")[0].text
        assert "//" not in text.split("\n")[1]
        assert not [name for name in needed if f"${name.removeprefix('p-')}" in text.replace("$from)", "")]
    page = here.page(ask="findings", do="edit", **{"p-category": "Voice"})
    own = here.page(page.xpath("//textarea")[0].text)
    assert cells(own) == cells(here.page(ask="findings", **{"p-category": "Voice"}))


@pytest.mark.slow
def test_an_element_and_a_finding_lead_to_their_questions(here: Asker) -> None:
    finding: Finding = here.site.session.findings[0]
    page = html.fromstring(here.client.get(f"/?finding={finding.id}").text)
    links = page.xpath("//a[starts-with(@href, '/cypher?')]/@href")
    assert len(links) == 2
    element = html.fromstring(here.client.get(f"/?at={element_id(finding.leak.identity)}").text)
    links += element.xpath("//a[starts-with(@href, '/cypher?')]/@href")
    assert len(links) == 4
    for link in links:
        page = html.fromstring(here.client.get(link).text)
        assert not page.xpath("//table")  # an address asks nothing
        form = page.forms[0]
        answer = html.fromstring(here.client.post("/cypher", data=dict(form.form_values())).text)
        assert cells(answer), link
        asked = form.fields.get("p-element") or form.fields.get("p-leak") or form.fields["p-category"]
        assert asked in (finding.leak.name, finding.category)


def test_the_text_of_a_query_never_comes_from_an_address(here: Asker) -> None:
    for query in (
        "text=RETURN+1",
        "ask=&text=RETURN+1",
        "do=ask&text=RETURN+1&ask=findings",
        "ask=RETURN+1",
        "%ff=%00",
    ):
        page = html.fromstring(here.client.get(f"/cypher?{query}").text)
        assert not page.xpath("//table")
        assert "RETURN 1" not in page.text_content()


# --- what is refused -------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("CREATE (n:ShouldNotBe)", "would write"),
        ("MERGE (n:ShouldNotBe) RETURN n", "would write"),
        ("MATCH (n) SET n.should_not = 1 RETURN n", "would write"),
        ("MATCH (n:Robot) REMOVE n.name", "would write"),
        ("MATCH (n) DETACH DELETE n", "would write"),
        ("MATCH (n) CALL (n) { CREATE (:ShouldNotBe) } IN TRANSACTIONS", "would write"),
        ("FOREACH (x IN [1] | CREATE (:ShouldNotBe))", "would write"),
        ("CREATE INDEX should_not FOR (n:X) ON (n.y)", "would write"),
        ("DROP INDEX should_not IF EXISTS", "would write"),
        ("CALL apoc.create.node(['ShouldNotBe'], {}) YIELD node RETURN node", "apoc.create.node"),
        ("CALL dbms.killConnection('bolt-0')", "calls dbms.killConnection"),
        ("CALL db.clearQueryCaches()", "calls db.clearQueryCaches"),
        ("LOAD CSV FROM 'file:///etc/passwd' AS line RETURN line", "LOAD CSV"),
        ("LOAD CSV FROM 'http://127.0.0.1:1/x' AS line RETURN line", "LOAD CSV"),
        ("RETURN COLLECT { LOAD CSV FROM 'file:///etc/passwd' AS line RETURN line } AS x", "LOAD CSV"),
        ("SHOW USERS", "AdministrationCommand"),
        ("CREATE USER eve SET PASSWORD 'abcdefgh'", "AdministrationCommand"),
        ("RETURN 1; MATCH (n) DETACH DELETE n", "refuses the query"),
        ("RETURN 1 }", "refuses the query"),
        ("RETURN $missing", "refuses the query"),
        ("\x00", "refuses the query"),
        ("MATCH (n:Robto) RETURN n", "did you mean Robot"),
        ("MATCH (n:Robot) RETURN n.nmae", "did you mean name"),
        (ENDLESS, "took longer than 2 s"),
    ],
)
def test_what_does_more_than_read_is_refused_in_one_line_and_nothing_changes(
    hasty: Asker, loaded: Connection, text: str, why: str
) -> None:
    before = facts(loaded)
    answer = hasty.ask(text)
    page = html.fromstring(answer.text)
    assert answer.status_code == 422
    head, line = told(answer).split("\n")
    assert head == "The question was not answered"
    assert why in line
    assert "; " in line  # what to do
    assert not page.xpath("//table")
    kept = page.xpath("//textarea")[0].text or ""
    assert kept.removeprefix("\n") == text.replace("\x00", "\ufffd")
    assert facts(loaded) == before


def test_parameters_that_are_wrong_are_told_and_stay_in_their_fields(here: Asker) -> None:
    answer = here.ask(ask="findings", **{"p-robot": "h2", "p-category": "Vioce"})
    assert answer.status_code == 422
    assert "no robot 'h2' is in the database; did you mean h1?" in told(answer)
    assert "no category 'Vioce' is in the database; did you mean Voice or" in told(answer)
    values = html.fromstring(answer.text).xpath("//input[starts-with(@name, 'p-')]/@value")
    assert sorted(values) == ["Vioce", "h2"]
    assert "from is missing" in told(here.ask(ask="path-between"))
    assert "least: 'many' is not of the type integer" in told(here.ask(ask="shared-channels", **{"p-least": "many"}))


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b"", 422),
        (b"text=", 422),
        (b"text=+%0a", 422),
        (b"ask=no-such-question", 422),
        (b"ask=findings&ask=robots", 422),
        (b"text=a&text=b", 422),
        (b"text=RETURN+1&do=delete", 422),
        (b"ask=../../etc/passwd", 422),
        (b"\xff\xfe", 422),
        (b"text=%ff", 422),
        (b"text=%ed%a0%80", 422),
        (b"ask=findings&p-robot=%00", 422),
        (b"at=%3Cscript%3E&text=RETURN", 422),
        (b"text=" + b"a" * (LONGEST_TEXT + 1), 422),
        (b"text=" + b"a" * LARGEST, 413),
    ],
)
def test_a_malformed_or_oversized_form_is_refused_and_never_breaks(here: Asker, body: bytes, status: int) -> None:
    kind = {"content-type": "application/x-www-form-urlencoded"}
    assert here.client.post("/cypher", content=body, headers=kind).status_code == status


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        f"RETURN {'[' * 3000}1{']' * 3000} AS deep",
        "RETURN reduce(t = [], n IN range(1, 900) | [t]) AS deep",
        f"RETURN {'(' * 9000}1{')' * 9000} AS deep",
        "UNWIND range(1, 200) AS n RETURN reduce(t = 'x', i IN range(1, 24) | t + t) AS long",
        "RETURN 0.0 / 0.0 AS nan, datetime() AS now, duration('P1D') AS d, point({x: 1, y: 2}) AS p",
    ],
)
def test_no_answer_breaks_the_program(here: Asker, text: str) -> None:
    assert here.ask(text).status_code in (200, 422)


def test_only_the_browser_that_opened_the_link_asks_and_only_from_the_page_itself(here: Asker) -> None:
    stranger = TestClient(here.client.app, base_url=HERE["origin"], headers=HERE)
    assert stranger.get("/cypher").status_code == 401
    assert stranger.post("/cypher", data={"text": "RETURN 1"}).status_code == 401
    asked = {"text": "RETURN 1"}
    assert here.client.post("/cypher", data=asked, headers={"host": "rebound.example:8700"}).status_code == 421
    assert here.client.post("/cypher", data=asked, headers={"origin": "http://evil.example"}).status_code == 403
    assert here.client.post("/cypher", data=asked, headers={"origin": "null"}).status_code == 403
    assert here.client.put("/cypher", data=asked).status_code == 405
    assert here.client.get("/cypher/../../etc/passwd").status_code == 404


def test_a_question_reads_so_it_may_be_asked_whether_or_not_anything_may_be_changed(loaded: Connection) -> None:
    for read_only in (True, False):
        with asker(loaded, read_only=read_only) as here:
            assert cells(here.page("MATCH (r:Robot) RETURN r.name AS name")) == [["h1"]]
            assert here.ask("MATCH (r:Robot) SET r.name = 'x'").status_code == 422


def test_a_session_of_files_has_no_such_page(explore: Callable[..., Explorer], tmp_path: Path) -> None:
    client = explore(BARE, tmp_path / "new.labels.yaml").client()
    assert client.get("/cypher").status_code == 404
    assert client.post("/cypher", data={"text": "RETURN 1"}).status_code == 404
    for page in ("/", f"/?at={node('/navigator')}"):
        assert 'href="/cypher' not in client.get(page).text


def test_hostile_names_and_texts_are_text(here: Asker, loaded: Connection) -> None:
    with connection.open_driver(loaded) as driver:
        driver.execute_query("CREATE (:Robot {name: $name})-[:OWNS]->(:Robot {name: '\u202e\x1b[31m'})", name=HOSTILE)
        try:
            answer = here.ask("MATCH p = (r:Robot)-[:OWNS]->(s) RETURN p, r.name AS `<b>\u202e`")
        finally:
            driver.execute_query("MATCH (r:Robot)-[:OWNS]->(s) DETACH DELETE r, s")
    assert answer.status_code == 200
    assert "<script>alert" not in answer.text
    assert "\x1b" not in answer.text
    page = html.fromstring(answer.text)
    assert [script.get("src") for script in page.xpath("//script")] == ["/static/cypher.js"]
    assert not page.xpath("//@onload | //@style | //b[text()='\u202e']")
    assert cells(page)[0][1] == HOSTILE
    refused = here.ask(f"RETURN 1 // </textarea>{HOSTILE}\nRETURN")
    area = html.fromstring(refused.text).xpath("//textarea")[0]
    assert area.text.endswith("\nRETURN")
    assert area.xpath("./*") == []


@pytest.mark.slow
def test_a_question_that_takes_long_holds_no_other_page_up_and_only_some_wait_at_once(loaded: Connection) -> None:
    with asker(loaded, seconds=3) as here:
        statuses: list[int] = []
        threads = [threading.Thread(target=lambda: statuses.append(here.ask(ENDLESS).status_code)) for _ in range(6)]
        for thread in threads:
            thread.start()
        assert here.client.get("/").status_code == 200
        assert not [status for status in statuses if status == 422]  # they are asked still
        for thread in threads:
            thread.join()
        assert sorted(statuses) == [422] * AT_ONCE + [429] * (6 - AT_ONCE)
        assert here.ask("RETURN 1").status_code == 200


def test_a_server_that_is_not_there_any_more_is_told_and_the_text_stays(loaded: Connection) -> None:
    gone = Connection("bolt://127.0.0.1:1", loaded.username, loaded.password)
    stranger = Connection(loaded.uri, loaded.username, "wrong-password")
    with asker(loaded) as here:
        for to, why in ((gone, "no Neo4j answers there"), (stranger, "password is not accepted")):
            here.site._opened = partial(connection.open_driver, to)
            answer = here.ask("RETURN 1 AS kept")
            assert answer.status_code == 503
            assert why in told(answer)
            assert "RETURN 1 AS kept" in answer.text
            assert here.client.get("/").status_code == 200
        here.site._opened = partial(connection.open_driver, loaded)  # it is there again
        assert here.ask("RETURN 1 AS kept").status_code == 200


@pytest.mark.parametrize(("language", "words"), [("de", "Fragen an die Datenbank"), ("fr", "Questions à la base")])
def test_it_speaks_the_language_of_its_reader(loaded: Connection, language: str, words: str) -> None:
    with asker(loaded, language=language) as here:
        page = here.page(ask="leak-path-graph")
        assert words in page.findtext(".//title")
        english = [
            node for node in page.xpath("//body//*[not(ancestor-or-self::*[@lang='en'])]/text()") if " the " in node
        ]
        assert english == []
