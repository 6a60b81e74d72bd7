"""No output says what is false in law: protections, national law, provisions, instruments (from files to output).

An office in Germany: a camera, an emotion estimate, a watch list, a blur; an archive in the US, a disk in India.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.report.catalogs.words import Words, plain
from tests.helpers.fleet_files import policy
from tests.helpers.pages import LANGUAGES, record_rows, seen

if TYPE_CHECKING:
    from rosprivacy.result import Result

POLICY = policy(
    "camera>/image<", "mic>/audio<", "emotion>/mood<image", "guard>/alarm<image", "blur>/blurred<image",
    "recorder><image,mood,alarm", "trainer><blurred", "teleop><image,audio",
)  # fmt: skip
LABELS = """labels: 1
context: [workplace, public-space]
country: {country}
purpose: protection of the site
legal_basis: [6(1)(f)]
nodes:
  /camera: {{source: [Video], subjects: [employees, visitors]}}
  /mic: {{source: [Voice], subjects: [employees]}}
  /emotion: {{derives: [{{from: Video, to: EmotionEstimate}}], sanitizer: {{Video: drop}}}}
  /guard: {{derives: [{{from: Video, to: WatchListMatch}}], sanitizer: {{Video: drop}}}}
  /blur: {{sanitizer: {{Video: pseudonymise}}}}
  /recorder: conduit
  /trainer: conduit
  /teleop: conduit
channels: {{/image: sensitive, /audio: sensitive, /mood: sensitive, /alarm: sensitive, /blurred: sensitive}}
elements:
  archive: {{kind: storage, country: US, retention: {{Video: P90D, PersonalData: P1Y}}, encrypted: false, {transfer}}}
  training set: {{kind: storage, country: BR, encrypted: true}}
  cabin: {{kind: person, country: JP}}
flows:
  - {{from: /recorder, to: archive}}
  - {{from: /trainer, to: training set}}
  - {{from: /teleop, to: cabin}}
"""
CLAUSES = "transfer: standard-clauses"


def office(folder: Path, country: str = "DE", transfer: str = CLAUSES, **settings: Any) -> Result:
    labels = LABELS.format(country=country, transfer=transfer)
    if not country:
        labels = labels.replace("country: \n", "")
    (folder / "p.xml").write_text(POLICY, "utf-8")
    (folder / "l.yaml").write_text(labels, "utf-8")
    return rosprivacy.analyze(folder / "p.xml", folder / "l.yaml", **settings)


def test_a_row_of_the_record_states_its_own_time_limit_and_measures(tmp_path: Path) -> None:
    told = record_rows(office(tmp_path))
    training, archive, cabin = (told["video of persons", name] for name in ("training set", "archive", "cabin"))
    assert (training["retention"], cabin["retention"]) == ("to be completed", "to be completed")
    assert "30(1)(f)" in training["complete"]
    assert archive["retention"].startswith("archive: 90 days")
    assert "/blur (video of persons): pseudonymises" in training["measures"]
    assert "training set: encrypted" in training["measures"]
    assert "archive: not encrypted" in archive["note"]
    for row in told.values():
        assert not any(name in row["measures"] for name in ("/emotion", "/guard"))
    assert "/blur" not in archive["measures"] + cabin["measures"]
    assert "training set" not in archive["measures"] + cabin["measures"]


def test_the_persons_of_what_is_made_are_those_of_the_sources_that_reach_the_maker() -> None:
    """The shipped fleet: only the guides recognise faces, and their cameras are about visitors."""
    fleet = rosprivacy.analyze_fleet(Path("examples/fleet/fleet.yaml").resolve())
    made = {exit_: row["subjects"] for (kind, exit_), row in record_rows(fleet).items() if kind == "face template"}
    assert set(made.values()) == {"visitors"}
    part = next(p for p in answers(fleet)[121].split("<p><strong>") if p.startswith("face template"))
    assert "visitors" in part
    assert not any(group in part for group in ("patients", "staff"))


def answers(result: Result) -> dict[int, str]:
    file = json.loads(seen(result, "cnil-pia"))
    return {one["reference_to"]: one["data"]["text"] or "\n".join(one["data"]["list"]) for one in file["answers"]}


def test_who_recognises_or_judges_persons_is_no_measure(tmp_path: Path) -> None:
    result = office(tmp_path)
    measures = json.loads(seen(result, "cnil-pia"))["measures"]
    assert "/blur" in str(measures)
    assert not any(name in f"{measures}{answers(result)[324]}" for name in ("/emotion", "/guard"))
    for language in LANGUAGES:
        words = Words(language)
        page = seen(result, "works-council", language)
        recognised, _, rest = page.partition(plain(words("works_council.open")))
        recognised = recognised.partition(plain(words("works_council.recognised")))[2]
        protections = rest.partition(plain(words("works_council.measures")))[2]
        assert "/blur" in protections
        assert all(f"{name} (" not in protections for name in ("/emotion", "/guard"))
        assert all(name in recognised for name in ("/emotion", "/guard"))


def test_a_transfer_that_is_stated_to_have_no_basis_reads_so(tmp_path: Path) -> None:
    """No adequacy decision stands at a recipient whose label says ``transfer: none``."""
    for language in LANGUAGES:
        words = Words(language)
        for form in ("works-council", "html"):
            page = seen(office(tmp_path, transfer="transfer: none"), form, language)
            assert plain(words.pair("US", words("transfer.none"))) in page


@pytest.mark.slow
@pytest.mark.parametrize(
    ("country", "language", "there", "not_there"),
    [
        ("DE", "de", ["§ 26 BDSG", "§ 87 Abs. 1 Nr. 6 BetrVG"], ["Code du travail"]),
        ("DE", "fr", ["§ 26 BDSG"], ["L2312-38"]),
        ("FR", "de", ["L2312-38"], ["BDSG", "BetrVG"]),
        ("AT", "de", ["Nationales Recht von AT", "§ 96 Abs. 1 Z 3 ArbVG"], ["BDSG", "BetrVG", "StGB", "ArGV"]),
        ("CH", "fr", ["Droit national de CH", "art. 26 OLT 3"], ["L2312-38", "code du travail", "ArbVG"]),
        ("ES", "en", ["National law of ES"], ["BDSG", "ArbVG", "United Kingdom", "Illinois"]),
        ("", "de", ["nationale Recht des Landes der Verwendung"], ["BDSG", "BetrVG", "StGB"]),
    ],
)
def test_national_law_is_that_of_the_stated_country(
    tmp_path: Path, country: str, language: str, there: list[str], not_there: list[str]
) -> None:
    result = office(tmp_path, country)
    page = seen(result, "works-council", language)
    assert all(text in page for text in there)
    for text in (page, seen(result, "html", language)):
        assert not [name for name in not_there if name in text]


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_works_council_reads_what_the_ai_act_says_of_work(tmp_path: Path, language: str) -> None:
    result = office(tmp_path)
    page = seen(result, "works-council", language)
    named = {row["provision"]: row for row in result.document()["look_at"]}
    for name in ("AI Act Art. 5(1)(f)", "AI Act Art. 26(7)"):
        translated = named[name]["translations"].get(language, {}).get("provision", name)
        assert plain(translated) in page
    assert plain(Words(language)("look.unconfirmed", date=Words(language).date("2026-06-29"))) in page


def test_a_provision_that_names_no_kind_of_data_is_not_revealed_by_any(tmp_path: Path) -> None:
    """Articles 35(3)(c) and 88 and recital 38 name nothing that data can reveal: they concern them, said once."""
    result = office(tmp_path)
    verdicts = {row["provision"]: row["verdict"] for f in result.document()["findings"] for row in f["in_context"]}
    assert verdicts == {"GDPR Art. 35(3)(c)": "concerns", "GDPR Art. 88": "concerns"}
    for name in ("html", "markdown", "text"):
        text = seen(result, name)
        lines = [line for line in text.split("\n") if "reveal" in line and ("35(3)(c)" in line or "Art. 88" in line)]
        assert lines == []
    for message in (r["message"]["text"] for r in json.loads(seen(result, "sarif"))["runs"][0]["results"]):
        revealed = message.partition("It may reveal what these speak of: ")[2].partition(".")[0]
        assert "35(3)(c)" not in revealed
        assert "88" not in revealed


@pytest.mark.parametrize(
    ("transfer", "told"),
    [
        (CLAUSES, "US: standard contractual clauses (Article 46(2)(c) or (d))"),
        ("legal_basis: [46(2)(c)]", "US: standard contractual clauses (Article 46(2)(c))"),
        ("legal_basis: [46(2)(d)]", "US: standard contractual clauses of a supervisory authority (Article 46(2)(d))"),
    ],
)
def test_the_record_names_the_clauses_that_were_stated(tmp_path: Path, transfer: str, told: str) -> None:
    assert record_rows(office(tmp_path, transfer=transfer))["video of persons", "archive"]["transfer"] == told


def test_what_is_made_and_followed_is_not_said_to_be_unfollowed(tmp_path: Path) -> None:
    """The match with a watch list is made of video and gets to the archive: it was followed."""
    result = office(tmp_path, article9_level="conditional")
    assert {row["element"]["name"] for row in result.document()["carries"]} >= {"/guard", "/recorder", "archive"}
    for name in ("text", "html", "sarif"):
        assert "no data was followed" not in seen(result, name)
        assert "nothing-followed" not in seen(result, name)


def test_nothing_is_followed_where_no_source_and_no_maker_is(tmp_path: Path) -> None:
    result = office(tmp_path, categories=["TradeUnionMembership"])
    assert "no data was followed" in seen(result, "text")


def test_who_asks_for_sensitive_data_gets_convictions_too(tmp_path: Path) -> None:
    """Article 10."""
    (tmp_path / "p.xml").write_text(policy("wifi>/d<", "up><d"), "utf-8")
    (tmp_path / "l.yaml").write_text(
        "labels: 1\nnodes: {/wifi: {source: [CriminalConviction]}, /up: {leak: [CriminalConviction]}}\n", "utf-8"
    )
    for level in (None, "always"):
        result = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml", article9=True, article9_level=level)
        assert [finding.category for finding in result.findings] == ["CriminalConviction"]
        assert "Article 9(1) or 10 GDPR" in seen(result, "text")


def test_the_ai_act_and_national_law_are_pointed_at_and_not_assessed(tmp_path: Path) -> None:
    text = seen(office(tmp_path), "html")
    assert "are pointed at and not assessed" in text
    assert "national law and agreements with works councils are not looked at" not in text
    assert "such data may reveal it" not in seen(office(tmp_path), "article30")
