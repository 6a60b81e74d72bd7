"""A review, one question at a time: forms as a browser without scripts sends them, in three languages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from lxml import html

from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.answered_entries import left_of
from rosprivacy.explorer.web.review_site import open_elements
from rosprivacy.report.catalogs.words import Words
from tests.helpers.explorers import BARE, FACTORY, Explorer, copied, node
from tests.helpers.languages import english_in
from tests.helpers.paths import ROOT
from tests.helpers.reviews import NAME, answer, heading, insiders_in, page, to_the_end

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Explore = Callable[..., Explorer]

LANGUAGES = ("en", "de", "fr")
CARE = ROOT / "examples" / "care-home" / "care-home.policy.xml"
PLAIN = """<?xml version="1.0"?>
<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>
<profile node="a1" ns="/"><topics publish="ALLOW"><topic>m</topic></topics></profile>
<profile node="b2" ns="/"><topics subscribe="ALLOW"><topic>m</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
OURS = "//code | //option | //*[@lang='en'] | //b"


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_review_goes_from_the_first_question_to_the_report(explore: Explore, tmp_path: Path, language: str) -> None:
    explorer = explore(CARE, tmp_path / "new.labels.yaml", language=language, review=True)
    client, words = explorer.client(), Words(language)
    seen = to_the_end(client)
    assert len(seen) > 10
    last = html.fromstring(seen[-1])
    assert heading(last) == words("review.heading.summary")
    assert words("review.end.none") in seen[-1].replace("&#39;", "'")
    assert NAME in seen[-1]
    assert (
        client.post("/save?step=summary", data={"version": last.xpath("string(//body/@data-version)")}).status_code
        == 303
    )
    assert NAME in explorer.labels.read_text("utf-8")
    assert f'<html lang="{language}">' in client.get("/report").text


@pytest.mark.parametrize("language", LANGUAGES[1:])
def test_every_page_speaks_the_readers_language(explore: Explore, tmp_path: Path, language: str) -> None:
    client = explore(CARE, copied(ROOT / "examples" / "care-home" / "care-home.labels.yaml", tmp_path),
                     language=language, review=True).client()  # fmt: skip
    summary = client.get("/?step=summary").text
    client = explore(BARE, copied(FACTORY / "run1.labels.yaml", tmp_path), language=language, review=True).client()
    skipped = answer(client, "skip")
    assert skipped.status_code == 303
    for text in (summary, client.get("/").text, client.get("/?step=summary").text, answer(client, "absent").text):
        whole = html.fromstring(text)
        assert whole.get("lang") == language
        for left in whole.xpath(OURS):
            left.drop_tree()
        assert english_in(whole.text_content(), language, ["publishes who it saw, never the picture"]) == []


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_no_page_says_words_of_insiders(explore: Explore, tmp_path: Path, language: str) -> None:
    client = explore(CARE, tmp_path / "new.labels.yaml", language=language, review=True).client()
    nothing = [client.get(address).text for address in ("/?step=source", "/?step=summary")]
    file = copied(ROOT / "examples" / "care-home" / "care-home.labels.yaml", tmp_path)
    explorer = explore(CARE, file, language=language, review=True)
    labelled = explorer.client()
    decided = [labelled.get(f"/?at={at}").text for at in explorer.site.standing.carried]  # limits of channels, too
    file.write_text(file.read_text("utf-8") + "# by hand\n", "utf-8")
    changed = labelled.get("/").text
    assert 'role="alert"' in changed
    for text in (*nothing, *decided, changed, *to_the_end(client)):
        assert insiders_in(text, language) == []


def without_suggestions(explore: Explore, tmp_path: Path, **how: Any) -> Explorer:
    """A review of programs of which nothing can be guessed, with no source."""
    policy = tmp_path / "plain.policy.xml"
    policy.write_text(PLAIN, "utf-8")
    return explore(policy, tmp_path / "plain.labels.yaml", review=True, **how)


@pytest.mark.parametrize("language", ["de"])
def test_where_nothing_is_suggested_a_person_is_asked_what_brings_data_in(
    explore: Explore, tmp_path: Path, language: str
) -> None:
    explorer = without_suggestions(explore, tmp_path, language=language)
    client, words = explorer.client(), Words(language)
    first, summary = page(client), page(client, "/?step=summary").text_content()
    assert heading(first) == words("review.heading.source")
    assert words("review.source.nothing") in first.text_content()
    for told in ("review.end.nothing", "review.saved.nothing", "review.out.nothing", "review.progress.none"):
        assert words(told) in summary
    for wrong in ("review.end.none", "review.saved", "review.out.none"):
        assert words(wrong) not in summary
    assert "/a1" in first.xpath("string(//main//ul)")
    assert words("review.source.none") in page(client, "/?step=source&find=nowhere").text_content()
    found = page(client, "/?step=source&find=A1").xpath("//main//li/a")
    assert [one.text_content() for one in found] == [words("review.named", name="/a1", kind=words("review.kind.node"))]
    assert answer(client, "source", found[0].get("href"), brings="Video").status_code == 303
    assert "/b2" in heading(page(client))
    assert explorer.session.result.analysis.emitted
    assert words("review.end.nothing") not in page(client, "/?step=summary").text_content()


def test_who_says_of_everything_that_it_brings_nothing_in_is_told_that_nothing_was_followed(
    explore: Explore, tmp_path: Path
) -> None:
    client, words = without_suggestions(explore, tmp_path).client(), Words("en")
    for name in ("/a1", "/b2"):
        assert answer(client, "none", f"/?at={node(name)}", note="seen").status_code == 303
    summary = page(client, "/?step=summary").text_content()
    assert words("review.end.nothing") in summary
    assert words("review.end.none") not in summary
    assert heading(page(client)) == words("review.heading.source")


@pytest.mark.parametrize("language", ["de"])
def test_what_the_reader_of_labels_refuses_is_told_in_plain_words_first(
    explore: Explore, tmp_path: Path, language: str
) -> None:
    explorer = explore(BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), language=language, review=True)
    client, words = explorer.client(), Words(language)
    explorer.session.label("/robot_camera", source={"Video": ["/robot_video"]}, by=NAME)
    channel = element_id(("", "topic", "/robot_video"))
    refused = answer(client, "mundane", f"/?at={channel}", note="seen", about="Video")
    assert refused.status_code == 422
    message = html.fromstring(refused.text).xpath("//*[@role='alert']/p")
    assert [(one.text_content(), one.get("lang")) for one in message[:1]] == [(words("review.refused"), None)]
    assert message[1:]
    assert {one.get("lang") for one in message[1:]} == {"en"}


@pytest.mark.parametrize("language", ["de"])
def test_answers_of_before_under_other_rules_are_told(explore: Explore, tmp_path: Path, language: str) -> None:
    policy, labels = tmp_path / "plain.policy.xml", tmp_path / "new.labels.yaml"
    policy.write_text(PLAIN, "utf-8")
    first = explore(policy, labels, journal=tmp_path / "journal", review=True)
    assert answer(first.client(), "source", f"/?at={node('/a1')}", brings="Video").status_code == 303
    first.session.close()
    policy.write_text(PLAIN.replace("b2", "b3"), "utf-8")
    client = explore(policy, labels, journal=tmp_path / "journal", language=language, review=True).client()
    assert Words(language)("review.before.changed") in page(client).text_content()


@pytest.mark.parametrize("language", ["de"])
def test_what_is_left_to_the_engineer_stays_open_and_is_told(explore: Explore, tmp_path: Path, language: str) -> None:
    explorer = explore(BARE, copied(FACTORY / "run1.labels.yaml", tmp_path), language=language, review=True)
    client, words = explorer.client(), Words(language)
    before = len(explorer.session.questions())
    first = heading(page(client))
    assert answer(client, "skip", note="does it keep them?").status_code == 303
    assert len(explorer.session.questions()) == before
    assert heading(page(client)) != first
    summary = page(client, "/?step=summary")
    told = words("review.left.told", why=f"{NAME} – does it keep them?")
    assert told in summary.text_content()
    assert words.count(len(summary.xpath("//section[1]//li")), "review.end.open") in summary.text_content()
    address = summary.xpath("//section[1]//li[contains(., 'keep them')]/a/@href")[0]
    assert told in page(client, address).text_content()
    assert answer(client, "conduit", address).status_code == 303
    assert "keep them" not in page(client, "/?step=summary").text_content()
    assert not any(map(left_of, explorer.session.entries.values()))


def test_undo_asks_the_last_question_again(explore: Explore, tmp_path: Path) -> None:
    client = explore(CARE, tmp_path / "new.labels.yaml", review=True).client()
    first = heading(page(client))
    answer(client, "skip")
    whole = page(client)
    assert heading(whole) != first
    back = client.post("/undo", data={"version": whole.xpath("string(//body/@data-version)")})
    assert heading(page(client, back.headers["location"])) == first


@pytest.mark.parametrize("language", ["de"])
def test_what_is_missing_is_told_and_what_was_written_stays(explore: Explore, tmp_path: Path, language: str) -> None:
    explorer = explore(CARE, tmp_path / "new.labels.yaml", language=language, review=True)
    client, words = explorer.client(), Words(language)
    for role, fields, missing in [
        ("", {"note": "w"}, "review.need.role"),
        ("absent", {}, "review.need.note"),
        ("none", {"note": " "}, "review.need.note"),
        ("source", {"by": "", "note": "w"}, "review.need.by"),
    ]:
        refused = answer(client, role, **fields)
        assert refused.status_code == 422
        whole = html.fromstring(refused.text)
        assert words(missing) in whole.text_content()
        assert whole.xpath("//input[@name='role'][@checked]/@value") == ([role] if role else [])
        assert whole.xpath("string(//input[@name='note']/@value)") == fields.get("note", "")
    assert explorer.session.version == 0


def test_a_reason_is_asked_for_where_data_would_be_followed_no_longer(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(BARE, copied(FACTORY / "run1.labels.yaml", tmp_path), review=True)
    client = explorer.client()
    for name, role in (("/navigator", "sanitizer"), ("/navigator", "absent")):
        address = f"/?at={node(name)}"
        assert answer(client, role, address, method="drop").status_code == 422
        assert answer(client, role, address, method="drop", note="measured").status_code == 303
    assert answer(client, "sanitizer", f"/?at={node('/emergency_stop')}", note="measured").status_code == 422  # how?
    assert explorer.session.entries["nodes", "/navigator"]["absent"] == "measured"


def test_read_only_shows_questions_and_summary_and_changes_nothing(explore: Explore, tmp_path: Path) -> None:
    explorer = explore(BARE, copied(FACTORY / "run1.labels.yaml", tmp_path), review=True, read_only=True)
    client = explorer.client()
    assert answer(client, "skip").status_code == 403
    for address in ("/", "/?step=summary"):
        whole = page(client, address)
        enabled = "//form[@method='post']//button[not(@disabled or ancestor::fieldset[@disabled])]"
        assert whole.xpath(enabled) == []
        assert "Read only" in whole.text_content()
    assert client.get("/report").status_code == 200


def test_a_stale_or_hostile_form_changes_nothing(explore: Explore, tmp_path: Path) -> None:
    evil = "'\"><img src=x onerror=alert(1)>"
    explorer = explore(CARE, tmp_path / "new.labels.yaml", review=True)
    client = explorer.client()
    answer(client, "skip", note=evil, by=evil)
    for address in ("/", "/?step=summary", "/?at=%00&step=x"):
        assert page(client, address).xpath("//img | //script") == []
    for fields in ({"version": "0"}, {"element": "e0"}, {"note": ["a", "b"]}, {"brings": "Nothing"}):
        assert answer(client, "source", **fields).status_code in (409, 422)
    assert client.post("/label?at=x", content=b"\xff\xff").status_code == 422
    assert len(explorer.session.edits) == 1


def test_what_an_element_does_with_data_stays_when_it_brings_none_in(explore: Explore, tmp_path: Path) -> None:
    labels = tmp_path / "l.yaml"
    labels.write_text("labels: 1\nnodes:\n  /archive_server: {leak: [Voice], author: B. Roy}\n")
    explorer = explore(BARE, labels, review=True)
    client = explorer.client()
    answer(client, "none", f"/?at={node('/archive_server')}", note="a disk")
    entry = explorer.session.entries["nodes", "/archive_server"]
    assert entry["leak"] == ["Voice"]
    assert entry["author"] == "B. Roy"
    assert "a disk" in entry["note"]


def test_a_note_of_something_else_hides_no_question(explore: Explore, tmp_path: Path) -> None:
    labels = tmp_path / "l.yaml"
    before = asked_names(explore(BARE, labels, review=True))
    assert "/robot_camera" in before
    labels.write_text("labels: 1\nnodes:\n  /robot_camera: {note: above the door}\n")
    explorer = explore(BARE, labels, review=True)
    assert asked_names(explorer) == before
    answer(explorer.client(), "none", f"/?at={node('/robot_camera')}", note="a dummy")
    assert asked_names(explorer) == before - {"/robot_camera"}


def asked_names(explorer: Explorer) -> set[str]:
    return {one.element.name for one in open_elements(explorer.site.standing)}
