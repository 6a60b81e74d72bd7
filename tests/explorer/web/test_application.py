"""The page's server on a real session: answers count once, other windows are told, and nothing breaks or is written."""

from __future__ import annotations

from html import escape as html_escape
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lxml import html

import rosprivacy
from rosprivacy.explorer.edits import element_id
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.catalogs.words import Words
from tests.helpers.explorers import BARE, FACTORY, Explorer, copied, label, node, version
from tests.helpers.languages import english_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    Explore = Callable[..., Explorer]

CAMERA, ARCHIVE = node("/safety_camera"), node("/archive_server")
VIDEO = {"brings": "Video"}
POSTS = ("/label", "/undo", "/redo", "/save", "/merge", "/resume", "/forget")


def test_an_answer_is_in_the_session_and_saved_when_that_is_asked(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(BARE, tmp_path / "new.labels.yaml")
    client = explorer.client()
    answer = label(client, CAMERA, "source", **VIDEO, note="it films the arm", by="A. Lee")
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    assert explorer.session.version == 1
    assert not explorer.labels.exists()
    page = client.get("/").text
    assert "/safety_camera – brings it in" in page
    assert 'value="A. Lee"' in page  # who answers need not say it again
    assert client.post("/save", data={"version": version(client)}).status_code == 303
    text = explorer.labels.read_text("utf-8")
    assert parse_labels(text, load(), name="saved").entries
    assert "A. Lee" in text
    assert "Saved to" in client.get("/").text
    assert "Saved to" not in client.get("/").text  # told once


def test_a_file_that_is_not_there_yet_was_changed_by_nobody(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(BARE, tmp_path / "new.labels.yaml")
    client = explorer.client()
    assert client.get("/now").json() == {"version": 0, "disk": False, "inputs": ""}
    assert 'role="alert"' not in client.get("/").text
    explorer.labels.write_text("labels: 1\nnodes: {/navigator: conduit}\n", "utf-8")
    assert client.get("/now").json()["disk"]
    assert 'role="alert"' in client.get("/").text


def test_what_the_labels_contradict_is_told_and_nothing_is_changed(explore: Explore, tmp_path: Path) -> None:
    file = tmp_path / "own.labels.yaml"
    file.write_text("labels: 1\nnodes:\n  /safety_camera: {source: {Video: [/safety_video]}}\n", "utf-8")
    explorer = explore(BARE, file)
    client = explorer.client()
    answer = label(client, element_id(("", "topic", "/safety_video")), "mundane", about="*")
    assert answer.status_code == 422
    assert "This cannot be said" in answer.text
    assert "own.labels.yaml:3" in answer.text
    assert explorer.session.version == 0


def test_a_label_is_taken_away(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path))
    client = explorer.client()
    assert len(explorer.session.findings) == 2
    assert label(client, CAMERA, "nothing").status_code == 303
    assert len(explorer.session.findings) == 1
    assert label(client, CAMERA, "nothing").status_code == 422  # there is none any more


def test_what_is_looked_for_by_its_whole_name_is_found_first(explore: Explore, tmp_path: Path) -> None:
    client = explore(BARE, tmp_path / "new.labels.yaml").client()
    for wanted in ("/robot_camera", "/ROBOT_CAMERA/get_parameters", "get_parameters"):
        page = html.fromstring(client.get("/", params={"find": wanted}).text)
        first = page.cssselect("#rows .row .name")[0].text_content()
        assert first == wanted.casefold() if wanted.startswith("/") else wanted in first


@pytest.mark.parametrize("element", [CAMERA, ARCHIVE])
def test_an_answer_about_nothing_chosen_takes_no_source_and_no_leak_away(
    explore: Explore, tmp_path: Path, element: str
) -> None:
    """Where nothing is open, what an element brings in or lets out is not chosen beforehand: a key alone ended it."""
    explorer = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path))
    client = explorer.client()
    there = f"/?at={element}"
    form = next(one for one in html.fromstring(client.get(there).text).forms if one.get("id") == "answers")
    assert ("about", "Video") not in form.form_values()
    refused = client.post("/label", data={**dict(form.form_values()), "role": "conduit"})
    assert refused.status_code == 422
    assert "Choose the kinds of data" in refused.text
    assert len(explorer.session.findings) == 2
    assert label(client, element, "conduit", about="Video").status_code == 303  # a person who says so is believed
    assert len(explorer.session.findings) == (1 if element == CAMERA else 0)


def test_a_broader_kind_beside_a_narrower_one_can_be_answered_for(explore: Explore, tmp_path: Path) -> None:
    """A tracker makes tracks of places: both go on, and each is a question of its own."""
    file = tmp_path / "own.labels.yaml"
    tracker = "{conduit: [Location], derives: [{from: Location, to: PersonTrack}]}"
    file.write_text(f"labels: 1\nnodes:\n  /lidar: {{source: [Location]}}\n  /person_tracker: {tracker}\n", "utf-8")
    explorer = explore(ROOT / "examples" / "care-home" / "care-home.policy.xml", file)
    client, tracks = explorer.client(), element_id(("", "topic", "/person_tracker/tracks"))
    form = next(one for one in html.fromstring(client.get(f"/?at={tracks}").text).forms if one.get("id") == "answers")
    chosen = [value for name, value in form.form_values() if name == "about" and value]
    assert chosen == ["Location", "PersonTrack"]


def test_a_limit_of_a_channel_outlives_an_answer_about_one_kind_and_is_told_when_it_goes(
    explore: Explore, tmp_path: Path
) -> None:
    file = tmp_path / "own.labels.yaml"
    file.write_text(
        "labels: 1\nnodes: {/safety_camera: {source: [Video]}}\ntopics:\n  /safety_video: {only: [Voice]}\n"
    )
    explorer = explore(BARE, file)
    client, channel = explorer.client(), element_id(("", "topic", "/safety_video"))
    there = ("topics", "/safety_video")
    assert label(client, channel, "sensitive", about="Video").status_code == 303
    assert explorer.session.entries[there] == {"only": ["Voice", "Video"]}
    assert "a limit was stated" not in client.get("/").text
    assert label(client, channel, "sensitive", about="*").status_code == 303
    assert explorer.session.entries[there] == "sensitive"
    assert "a limit was stated: it carries at most voice, video of persons." in client.get("/").text


def test_a_file_that_somebody_else_changed_is_not_written_over(explore: Explore, tmp_path: Path) -> None:
    file = copied(FACTORY / "run1.labels.yaml", tmp_path)
    explorer = explore(BARE, file)
    client = explorer.client()
    label(client, ARCHIVE, "leak", about="Video")
    client.get("/")
    others = file.read_text("utf-8") + "channels:\n  /new_pose: mundane  # by hand <b>\n"
    file.write_text(others, "utf-8")
    assert client.get("/now").json() == {"version": 1, "disk": True, "inputs": ""}
    assert "+  /new_pose: mundane  # by hand &lt;b&gt;" in client.get("/").text
    answer = client.post("/save", data={"version": version(client)})
    assert answer.status_code == 409
    assert "+  /new_pose: mundane  # by hand &lt;b&gt;" in answer.text
    assert file.read_text("utf-8") == others
    assert client.post("/merge", data={"version": version(client)}).status_code == 303
    assert client.post("/save", data={"version": version(client)}).status_code == 303
    assert client.get("/now").json()["disk"] is False
    text = file.read_text("utf-8")
    assert "/new_pose: mundane  # by hand <b>" in text
    assert "/archive_server" in text


@pytest.mark.parametrize(("language", "review"), [("en", False), ("de", True)])
def test_files_that_are_not_what_was_read_are_told_as_long_as_they_are_not(
    explore: Explore, tmp_path: Path, language: str, *, review: bool
) -> None:
    """An editor's change of a policy; its name is shown as text."""
    copied(FACTORY / "node.xml", tmp_path)
    policy = copied(BARE, tmp_path).rename(tmp_path / "<b>.policy.xml")
    labels = copied(FACTORY / "run1.labels.yaml", tmp_path)
    client = explore(policy, labels, language=language, review=review).client()
    assert 'id="inputs"' not in client.get("/").text
    policy.write_text(policy.read_text("utf-8") + "<!-- more -->", "utf-8")
    told = Words(language)("explorer.inputs", files=str(policy))
    assert client.get("/now").json() == {"version": 0, "disk": False, "inputs": told}
    for _ in range(2):  # it stands there, whoever looks again
        (said,) = html.fromstring(client.get("/").text).xpath("//*[@role='alert']/*[@id='inputs']")
        assert said.text_content() == told


@pytest.mark.slow
def test_what_a_session_left_is_offered_once(explore: Explore, tmp_path: Path) -> None:
    for choice, edits in (("/resume", 1), ("/forget", 0)):
        folder = tmp_path / choice[1:]
        first = explore(BARE, tmp_path / "new.labels.yaml", journal=folder)
        label(first.client(), CAMERA, "source", **VIDEO)
        first.session.close()  # it ends, and was not saved
        explorer = explore(BARE, tmp_path / "new.labels.yaml", journal=folder)
        client = explorer.client()
        assert "1 answer of it is kept" in client.get("/").text
        assert client.post(choice, data={"version": version(client)}).status_code == 303
        assert len(explorer.session.edits) == edits
        assert "answer of it is kept" not in client.get("/").text


def test_read_only_shows_everything_and_changes_nothing(explore: Explore, tmp_path: Path) -> None:
    file = copied(FACTORY / "run2.labels.yaml", tmp_path)
    before = file.read_bytes()
    explorer = explore(BARE, file, read_only=True)
    client = explorer.client()
    for path in POSTS:
        fields = {"version": "0", "element": CAMERA, "role": "nothing"}
        assert client.post(path, data=fields).status_code == 403
    page = client.get(f"/?at={CAMERA}").text
    assert "Read only" in page
    tries = "@action = '/try' or starts-with(@action, '/try?')"  # changes nothing
    enabled = f"//form[@method='post'][not({tries})]//button[not(@disabled or ancestor::fieldset[@disabled])]"
    assert [button.text_content() for button in html.fromstring(page).xpath(enabled)] == []
    assert explorer.session.version == 0
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    "path",
    ["/static/../application.py", "/static/%2e%2e/application.py", "/static/..%2fapplication.py", "/static/", "/static",
     "/static/explore.css/", "/templates/page.html.j2", "//etc/passwd", "/label", "/static/%00"],
)  # fmt: skip
def test_no_path_of_a_browser_opens_a_file(explore: Explore, tmp_path: Path, path: str) -> None:
    answer = explore(BARE, tmp_path / "new.labels.yaml").client().get(path)
    assert answer.status_code in (404, 405, 307)
    assert "import" not in answer.text


def test_style_and_script_are_ours(explore: Explore, tmp_path: Path) -> None:
    client = explore(BARE, tmp_path / "new.labels.yaml").client()
    for name, kind in (("explore.css", "text/css"), ("explore.js", "text/javascript")):
        answer = client.get(f"/static/{name}")
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith(kind)
        assert "http" not in answer.text.replace("http://www.w3.org", "")


EVIL = ("'\"><img src=x onerror=alert(1)>", "{{ 7*7 }}", "</script><script>alert(1)</script>")


@pytest.mark.parametrize("evil", EVIL)
def test_a_hostile_text_is_text_wherever_it_comes_from(explore: Explore, tmp_path: Path, evil: str) -> None:
    policy = tmp_path / "p.policy.xml"
    text = BARE.read_text("utf-8").replace("node.xml", str(FACTORY / "node.xml"))
    policy.write_text(text.replace('path="/factory"', f'path="/{html_escape(evil)}"'), "utf-8")
    client = explore(policy, copied(FACTORY / "run1.labels.yaml", tmp_path), root=FACTORY.parents[1]).client()
    label(client, ARCHIVE, "leak", about="Video", by=evil)
    page = html.fromstring(client.get("/", params={"at": node("/navigator"), "find": evil}).text)
    assert page.xpath("string(//input[@name='by']/@value)") == evil
    assert page.xpath("string(//input[@name='find']/@value)") == evil
    assert f"enclave /{evil}" in page.xpath("string(//p[@class='facts'])")
    assert page.xpath("//img | //script[not(@src)] | //@onerror") == []


def test_what_is_switched_off_is_neither_asked_nor_drawn(explore: Explore, tmp_path: Path) -> None:
    client = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path)).client()
    lines = "//*[contains(@class, 'line')]"
    for view in ("", "draw=all&"):
        shown, none = (html.fromstring(client.get(f"/?{view}{more}").text) for more in ("", "hide=Video"))
        assert shown.xpath(lines)
        assert shown.xpath("//a[@class='row']")
        assert not none.xpath("//*[contains(@class, 'look-way') or contains(@class, 'look-shortest')]")
        assert not none.xpath("//ol[@class='rows']//a[starts-with(@id, 'first') or starts-with(@id, 'exits')]")


def test_the_report_of_now_is_a_file_to_keep(explore: Explore, tmp_path: Path) -> None:
    client = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), language="de").client()
    answer = client.get("/report")
    assert answer.headers["content-disposition"] == 'attachment; filename="privacy-report.html"'
    assert '<html lang="de">' in answer.text
    assert "/archive_server" in answer.text


queries = st.one_of(
    st.text(max_size=60),
    st.lists(
        st.tuples(st.sampled_from(["at", "hide", "find", "finding", "closes", "trial", "x"]), st.text(max_size=20)),
        max_size=5,
    ).map(lambda pairs: "&".join(f"{key}={value}" for key, value in pairs)),
)


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Explorer]:
    explorer = Explorer(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path_factory.mktemp("opened")))
    yield explorer
    explorer.site.close()


@settings(suppress_health_check=[HealthCheck.too_slow])
@given(query=queries)
def test_no_address_breaks_the_page(opened: Explorer, query: str) -> None:
    response = opened.site._page(query)
    assert response.status_code == 200


@settings(suppress_health_check=[HealthCheck.too_slow])
@given(body=st.binary(max_size=200), path=st.sampled_from(["_label", "_undo", "_redo", "_save", "_merge"]))
def test_no_bytes_in_the_place_of_a_form_change_anything(opened: Explorer, body: bytes, path: str) -> None:
    before = opened.labels.read_bytes()
    response = opened.site._changed(getattr(opened.site, path), body, "")
    assert response.status_code == 422
    assert opened.session.version == 0
    assert opened.labels.read_bytes() == before


@pytest.mark.slow
@pytest.mark.parametrize("language", ["de", "fr"])
def test_elements_findings_and_trials_speak_the_readers_language(
    explore: Explore, tmp_path: Path, language: str
) -> None:
    explorer = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), language=language)
    client, filmed = explorer.client(), node("/robot_camera")
    trial = {"version": "0", "what": "storage", "element": filmed, "days": "30", "country": "DE"}
    addresses = [client.post("/try", data=trial).headers["location"]]
    addresses += [
        f"/?finding={explorer.session.findings[0].id}&closes=1",
        f"/?at={filmed}",
        f"/?at={node('/navigator')}",
    ]
    for address in addresses:
        whole = html.fromstring(client.get(address).text)
        assert whole.get("lang") == language
        for foreign in whole.xpath("//bdi | //*[@class='name'] | //option | //*[@lang='en'] | //title | //code"):
            foreign.drop_tree()
        marks = whole.xpath("//@aria-label | //@placeholder | //@title")
        assert english_in(" ".join([whole.text_content(), *marks]), language, ["rosprivacy explore"]) == []


@pytest.mark.slow
def test_every_element_can_be_looked_at_whatever_is_said_of_it(explore: Explore, tmp_path: Path) -> None:
    labels = tmp_path / "labels.yaml"
    said = "{/robot_video: {only: [HomeMap]}, /safety_video: {never: [Voice]}, /new_pose: sensitive}"
    labels.write_text(f"labels: 1\nnodes: {{/safety_camera: {{source: [Video]}}}}\nchannels: {said}\n", "utf-8")
    client = explore(BARE, labels).client()
    for element in rosprivacy.analyze(BARE, labels).analysis.graph.elements:
        page = client.get(f"/?at={element_id(element.identity)}")
        assert (page.status_code, "h-ask" in page.text) == (200, True), element
