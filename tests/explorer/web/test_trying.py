"""Trials on the page: they say what follows, change nothing, and never look like how it stands; hostile forms too."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any
from urllib.parse import quote_plus

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import html

from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.trial_forms import MOST_KEPT
from tests.helpers.daily import one_in
from tests.helpers.explorers import BARE, FACTORY, FILTERED, Explorer, copied, label, node, version

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from starlette.testclient import TestClient

    Explore = Callable[..., Explorer]

ARCHIVE, CAMERA = node("/archive_server"), node("/robot_camera")
VIDEO = element_id(("", "topic", "/robot_video"))
FLOW = f"{CAMERA}.{VIDEO}"


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    return copied(FACTORY / "run2.labels.yaml", tmp_path)


def tried(client: TestClient, **fields: Any) -> Any:
    return client.post("/try", data={"version": version(client), **fields})


def page(client: TestClient, address: str) -> Any:
    answer = client.get(address)
    assert answer.status_code == 200
    return html.fromstring(answer.text)


def text(of: Any, part: str) -> str:
    return " ".join(" ".join(of.get_element_by_id(part).itertext()).split())


def test_what_closes_a_finding_is_one_click_from_being_tried(explore: Explore, labels: Path) -> None:
    """The proposal's own proof and the trial are two analyses: they have to say the same."""
    explorer = explore(BARE, labels)
    client = explorer.client()
    finding = page(client, page(client, "/").xpath("//a[@class='way']/@href")[0])
    assert not finding.xpath("//div[@class='proposal']")
    asked = page(client, finding.xpath("//a[@data-key='p']/@href")[0])
    said = text(asked, "element")
    assert "With 3 changes, this would be closed: 2 paths to assess." in said
    assert "The analysis was made again with these changes" in said
    whole, *each = asked.xpath("//form[input[@value='proposal']]")
    assert len(each) == 3
    answer = client.post(whole.get("action"), data=dict(whole.form_values()))
    assert answer.status_code == 303
    there = page(client, answer.headers["location"])
    assert "2 paths to assess close 0 paths to assess open 0 paths to assess are then there" in text(there, "element")
    assert "now: data can get to a point of exit; then: not known" in text(there, "element")
    assert "A review is taken to find that /new_pose carries nothing of this: video of persons." in text(
        there, "element"
    )
    assert not there.xpath("//a[@href='/report']")  # that is of how it stands
    for form in each:  # one alone is not enough
        answer = client.post(form.get("action"), data=dict(form.form_values()))
        alone = text(page(client, answer.headers["location"]), "element")
        assert re.search("[12] paths? to assess (is|are) then there", alone)
    assert explorer.session.version == 0
    assert len(explorer.session.findings) == 2


def test_a_trial_is_told_all_the_time_and_nothing_can_be_answered_in_it(explore: Explore, labels: Path) -> None:
    explorer = explore(BARE, labels)
    before = labels.read_bytes()
    client = explorer.client()
    label(client, node("/robot_arm_control"), "conduit", about="*")
    address = tried(client, what="filter", flow=FLOW, data="Video", name="a filter at the camera").headers["location"]
    assert address == "/?trial=a+filter+at+the+camera"
    for more in ("", f"&at={CAMERA}", "&hide=Video", "&draw=all", "&find=video", f"&at={VIDEO}"):
        there = page(client, address + more)
        assert "a filter at the camera: this is a trial. Nothing of it is saved" in text(there, "trial")
        assert there.findtext(".//title").startswith("Trial: ")
        assert there.xpath("string(//h1)").startswith("Trial: ")
        assert not there.xpath(
            "//*[@id='head']//button[@data-key='u' or @data-key='r' or @data-key='Ctrl+S'][not(@disabled)]"
        )
        assert not there.xpath("//form[@id='answers']//fieldset[@class='answers'][not(@disabled)]")
        assert not there.xpath("//form[@class='offer']//button[not(@disabled)]")
        assert not there.xpath("//form[starts-with(@action, '/try')]")
        leads = there.xpath("//a[@data-key='Escape']/@href")
        assert "trial" not in leads[0]
        links = there.xpath("//*[@id='rows' or @id='hand' or @id='drawing']//a[not(ancestor::ul)]/@href")
        assert all("trial=a+filter" in link for link in links if link.startswith("/?"))
        form = there.xpath("//form[@role='search']")[0]
        assert dict(form.form_values())["trial"] == "a filter at the camera"
    back = page(client, "/")
    assert text(back, "trial") == ""
    assert not back.xpath("string(//h1)").startswith("Trial")
    assert labels.read_bytes() == before


def test_a_trial_shows_how_it_would_be(explore: Explore, labels: Path) -> None:
    """List and verdict under the trial are those of the answer that the session gives for it."""
    explorer = explore(BARE, labels)
    client = explorer.client()
    address = tried(client, what="storage", element=CAMERA, country="us").headers["location"]
    there = page(client, address)
    (found,) = explorer.session.scenarios.values()
    assert len(found.difference.opened) == 2  # kept without an end, and abroad
    assert "2 paths to assess open" in text(there, "element")
    assert "storage on trial" in text(there, "rows")
    assert "storage on trial" in text(there, "drawing")
    opened = there.xpath("//h3[.='What opens']/following-sibling::ul[1]//a/@href")
    assert "storage on trial" in text(page(client, opened[0]), "element")
    assert "storage on trial" not in text(page(client, "/"), "rows")


def test_a_doubt_opens_what_the_sanitizer_closes(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(FILTERED, copied(FACTORY / "run5.labels.yaml", tmp_path))
    client = explorer.client()
    assert str(explorer.session.verdict) == "no-leak-found"
    assert page(client, f"/?at={node('/filter')}").xpath("//form[input[@value='doubt']]")
    assert not page(client, f"/?at={CAMERA}").xpath("//form[input[@value='doubt']]")
    address = tried(client, what="doubt", element=node("/filter"), data="*").headers["location"]
    said = text(page(client, address), "element")
    assert "/filter is taken not to clean: any kind of data." in said
    assert "now: none found under the labels given; then: " in said
    (found,) = explorer.session.scenarios.values()
    assert str(found.difference.verdict) != "no-leak-found"


@pytest.mark.slow
def test_trials_are_kept_by_name_made_anew_after_an_edit_and_forgotten(explore: Explore, labels: Path) -> None:
    explorer = explore(BARE, labels)
    client = explorer.client()
    first = tried(client, what="filter", flow=FLOW, data="*").headers["location"]
    tried(client, what="storage", element=CAMERA, days="30")
    assert list(explorer.session.scenarios) == ["Trial 1", "Trial 2"]
    assert "1 path to assess closes" in text(page(client, first), "element")
    label(client, CAMERA, "nothing")  # no source any more: there is nothing left to close
    assert "0 paths to assess close" in text(page(client, first), "element")
    names = page(client, "/").xpath("//ul[@class='trials']//a")
    assert [one.text for one in names] == ["Trial 1", "Trial 2"]
    answer = client.post("/drop?trial=Trial+1", data={"version": version(client), "name": "Trial 1"})
    assert answer.headers["location"] == "/"
    assert list(explorer.session.scenarios) == ["Trial 2"]
    assert page(client, first).xpath("//aside") == []  # a link to it shows how it stands


def test_two_trials_are_tried_together(explore: Explore, labels: Path) -> None:
    """A storage behind the camera opens paths, also where the way of its data to the archive is filtered."""
    explorer = explore(BARE, labels)
    client = explorer.client()
    alone = tried(client, what="filter", flow=FLOW, data="*").headers["location"]
    assert not page(client, alone).xpath("//form[starts-with(@action, '/try')]")  # there is no other one
    for at in (CAMERA, ARCHIVE):
        tried(client, what="storage", element=at, country="us")
    for first, second in (("Trial 1", "Trial 2"), ("Trial 4", "Trial 3")):
        (form,) = page(client, f"/?trial={quote_plus(first)}").xpath("//form[starts-with(@action, '/try')]")
        assert second in form.xpath(".//option/text()")
        assert first not in form.xpath(".//option/text()")
        said = {**dict(form.form_values()), "second": second}
        there = page(client, client.post(form.get("action"), data=said).headers["location"])
    assert text(there, "element").count("A storage is added") == 2
    found = explorer.session.scenarios["Trial 5"]
    assert {flow[1] for flow in found.what_if.flows} == {"storage on trial", "storage on trial 2"}
    closed, opened = ({*explorer.session.scenarios[f"Trial {n}"].difference.opened} for n in (1, 5))
    assert not closed
    assert {*explorer.session.scenarios["Trial 2"].difference.opened} < opened
    assert found.difference.closed == explorer.session.scenarios["Trial 1"].difference.closed
    for wrong in ({"first": "Trial 1"}, {"first": "Trial 1", "second": "Trial 9"}):
        assert tried(client, what="together", **wrong).status_code == 422


def test_what_is_tried_and_not_there_any_more_is_told(explore: Explore, labels: Path) -> None:
    labels.write_text(labels.read_text("utf-8") + "elements:\n  disk: {kind: storage}\n", "utf-8")
    explorer = explore(BARE, labels)
    client = explorer.client()
    disk = element_id(("", "storage", "disk"))
    address = tried(client, what="storage", element=disk).headers["location"]
    explorer.session.unlabel("disk", kind="storage")
    there = page(client, address)
    assert "“Trial 1” cannot be tried any more. This is how it stands." in text(there, "message")
    assert text(there, "trial") == ""


@pytest.mark.slow
def test_no_more_trials_are_kept_than_memory_holds(explore: Explore, labels: Path) -> None:
    client = explore(BARE, labels).client()
    for _ in range(MOST_KEPT):
        assert tried(client, what="filter", flow=FLOW, data="Video").status_code == 303
    answer = tried(client, what="filter", flow=FLOW, data="Video")
    assert answer.status_code == 422
    assert "forget one" in answer.text
    assert tried(client, what="filter", flow=FLOW, data="Video", name="Trial 3").status_code == 303  # in its place


@pytest.mark.parametrize(
    "fields",
    one_in(
        5,
        [
            {},
            {"what": "__class__"},
            {"what": ["filter", "cut"], "flow": FLOW},
            {"what": "filter", "flow": FLOW},
            {"what": "filter", "flow": FLOW, "data": "Nothing"},
            {"what": "filter", "flow": f"{VIDEO}.{CAMERA}", "data": "Video"},  # the other way round
            {"what": "filter", "flow": "/robot_camera./robot_video", "data": "Video"},
            {"what": "filter", "flow": ".", "data": "Video"},
            {"what": "cut", "line": "/etc/passwd"},
            {"what": "cut", "line": "../before.policy.xml:48"},
            {"what": "cut", "line": "l" + "0" * 16},
            {"what": "storage", "element": "disk"},
            {"what": "storage", "element": CAMERA, "days": "-1"},
            {"what": "storage", "element": CAMERA, "days": "0"},
            {"what": "storage", "element": CAMERA, "days": "²"},
            {"what": "storage", "element": CAMERA, "country": "U{"},
            {"what": "storage", "element": CAMERA, "country": "XX"},
            {"what": "doubt", "element": CAMERA, "data": "*"},
            {"what": "doubt", "element": ARCHIVE, "data": "*"},
            {"what": "proposal", "proposal": "7", "step": ""},
            {"what": "proposal", "proposal": "0", "step": "9"},
            {"what": "proposal", "proposal": "-1", "step": ""},
            {"what": "proposal"},
            {"what": "filter", "flow": FLOW, "data": "Video", "name": "a\u202eb"},
            {"what": "filter", "flow": FLOW, "data": "Video", "name": "x" * 61},
        ],
        in_ci=1,
    ),
)
def test_what_cannot_be_tried_is_one_sentence(explore: Explore, labels: Path, fields: dict[str, Any]) -> None:
    explorer = explore(BARE, labels)
    answer = tried(explorer.client(), **fields)
    assert answer.status_code == 422
    assert "This cannot be said" in answer.text
    assert explorer.session.scenarios == {}


EVIL = ("'\"><img src=x onerror=alert(1)>", "{{ 7*7 }}", "</title><script>alert(1)</script>")


@pytest.mark.parametrize("evil", EVIL)
def test_a_hostile_name_is_text(explore: Explore, labels: Path, evil: str) -> None:
    client = explore(BARE, labels).client()
    there = page(client, tried(client, what="filter", flow=FLOW, data="Video", name=evil).headers["location"])
    assert text(there, "trial").startswith(f"{evil}: this is a trial.")
    assert there.xpath("//img | //script[not(@src)] | //@onerror") == []
    form = there.xpath("//ul[@class='trials']//form")[0]
    assert client.post("/drop", data=dict(form.form_values())).status_code == 303


def test_reading_is_trying_but_not_deciding(explore: Explore, labels: Path, tmp_path: Path) -> None:
    explorer = explore(BARE, labels, read_only=True, decisions=tmp_path / "d.yaml")
    client = explorer.client()
    answer = tried(client, what="filter", flow=FLOW, data="Video")
    assert answer.status_code == 303
    assert client.post("/drop", data={"version": "0", "name": "Trial 1"}).status_code == 303
    finding = explorer.session.findings[0].id
    said = {"version": "0", "finding": finding, "choice": "avoid"}
    assert client.post("/decide", data=said).status_code == 403
    assert client.post("/label", data={"version": "0"}).status_code == 403
    assert not (tmp_path / "d.yaml").exists()
    strange = {"origin": "http://elsewhere.example"}
    assert client.post("/try", data={"version": "0", "what": "storage"}, headers=strange).status_code == 403
    del client.headers["origin"]
    assert client.post("/try", data={"version": "0", "what": "storage", "element": CAMERA}).status_code == 403
    assert explorer.session.scenarios == {}


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Explorer]:
    folder = tmp_path_factory.mktemp("opened")
    explorer = Explorer(BARE, copied(FACTORY / "run2.labels.yaml", folder), decisions=folder / "d.yaml")
    yield explorer
    explorer.site.close()


names = st.sampled_from(
    ["what", "flow", "line", "element", "data", "proposal", "step", "days", "country", "name", "first", "second"]
)
values = st.one_of(
    st.text(max_size=12),
    st.sampled_from(["filter", "cut", "doubt", "proposal", "together", FLOW, CAMERA, "*", "0", "Video"]),
)


@pytest.mark.slow
@settings(suppress_health_check=[HealthCheck.too_slow], max_examples=40, deadline=None)
@given(fields=st.lists(st.tuples(names, values), max_size=6), path=st.sampled_from(["_try", "_drop", "_decide"]))
def test_no_fields_break_the_page_or_write_anything(opened: Explorer, fields: list[tuple[str, str]], path: str) -> None:
    from urllib.parse import urlencode

    pairs = [("version", "0"), *((name, value.encode("utf-8", "surrogatepass")) for name, value in fields)]
    response = opened.site._changed(getattr(opened.site, path), urlencode(pairs).encode(), "")
    assert response.status_code in (303, 422)
    assert opened.session.version == 0
    assert not (opened.labels.parent / "d.yaml").exists()
    for name in list(opened.session.scenarios):
        opened.session.drop_scenario(name)
