"""What lies outside ROS (rules S9, S10): how label files state it, what it means, what is refused."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.labels.countries import countries

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding

# /camera -> /image -> /recorder and /viewer, /microphone -> /sound -> /viewer; /trainer alone
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>image</topic></topics></profile>
<profile ns="/" node="recorder"><topics subscribe="ALLOW"><topic>image</topic></topics></profile>
<profile ns="/" node="viewer"><topics subscribe="ALLOW"><topic>image</topic><topic>sound</topic></topics></profile>
<profile ns="/" node="microphone"><topics publish="ALLOW"><topic>sound</topic></topics></profile>
<profile ns="/" node="trainer"><topics publish="ALLOW"><topic>/model</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
LABELS = """labels: 1
nodes:
  /camera: {source: [Video]}
  /microphone: {source: [Voice]}
  /recorder: conduit
  /viewer: conduit
  /trainer: conduit
channels: {'*': sensitive}
"""
BUCKET = "elements: {bucket: {kind: storage, country: DE, %s}}\nflows: [{from: /recorder, to: bucket}]\n"
CLOUD = "elements: {cloud: {kind: external-system, %s}}\nflows: [{from: /recorder, to: cloud}]\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "p.xml").write_text(POLICY, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def analysed(more: str) -> Any:
    Path("l.yaml").write_text(LABELS + more, "utf-8")
    return rosprivacy.analyze(["p.xml"], ["l.yaml"])


def found(more: str) -> list[str]:
    return [told(finding) for finding in analysed(more).analysis.findings]


def told(finding: Finding) -> str:
    return f"{finding.kind} {finding.category} {' '.join(element.name for element in finding.witness)}"


def reasons(more: str) -> list[str]:
    return [f"{f.category}: {f.reason}" for f in analysed(more).analysis.findings if f.reason]


def refused(more: str) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        analysed(more)
    lines = str(caught.value).splitlines()
    assert all(re.fullmatch(r"l\.yaml:\d+: .+; .+", line) for line in lines)
    return [line.removeprefix("l.yaml:") for line in lines]


SCREEN = "elements: {screen: {kind: display}}\n"


class TestTakingPart:
    @pytest.mark.parametrize(
        ("more", "expected"),
        [
            (  # what goes into a storage comes out of it
                (
                    "elements:\n  bucket: {kind: storage, country: DE, retention: P1D}\n"
                    "  cloud: {kind: external-system, country: FR}\n"
                    "flows: [{from: /recorder, to: bucket}, {from: bucket, to: /trainer}, "
                    "{from: /trainer, to: cloud}]\n"
                ),
                ["disclosure Video /camera /image /recorder bucket /trainer cloud"],
            ),
            (  # a label outranks what is taken by kind
                (
                    "elements: {screen: {kind: display, conduit: [Video]}}\n"
                    "flows: [{from: /viewer, to: screen}, {from: /recorder, to: screen}]\n"
                ),
                ["disclosure Voice /microphone /sound /viewer screen"],
            ),
            (  # a device is a source by itself
                (
                    "elements: {badge reader: {kind: device, source: [Location]}, screen: {kind: display}}\n"
                    "flows: [{from: badge reader, to: /trainer}, {from: /trainer, to: screen}]\n"
                ),
                ["disclosure Location badge reader /trainer screen"],
            ),
            (  # a side channel joins nodes in both directions
                (
                    "elements:\n  ring: {kind: shared-memory, between: [/recorder, /trainer]}\n"
                    "  screen: {kind: display}\nflows: [{from: /trainer, to: screen}]\n"
                ),
                ["disclosure Video /camera /image /recorder ring /trainer screen"],
            ),
            (  # only some kinds go along a flow
                f"{SCREEN}flows: [{{from: /viewer, to: screen, only: [Voice]}}]\n",
                ["disclosure Voice /microphone /sound /viewer screen"],
            ),
            (  # a glob names nodes
                f"{SCREEN}flows: [{{from: '/*er', to: screen, only: [Video]}}]\n",
                ["disclosure Video /camera /image /recorder screen"],
            ),
            (  # and where there are none, channels
                f"{SCREEN}flows: [{{from: '/imag?', to: screen}}]\n",
                ["disclosure Video /camera /image screen"],
            ),
        ],
    )
    def test_what_gets_where(self, more: str, expected: list[str]) -> None:
        assert found(more) == expected

    def test_a_step_keeps_the_line_that_states_it(self) -> None:
        finding = analysed(CLOUD % "country: DE").analysis.findings[0]
        assert [str(grant.place) for grant in finding.steps[-1].grants] == ["l.yaml:10"]
        assert finding.steps[-1].role == "flow"

    @pytest.mark.parametrize(
        ("kind", "leaks"),
        [
            ("external-system", True), ("display", True), ("person", True),
            ("storage", False), ("shared-memory", False), ("side-channel", False),
        ],
    )  # fmt: skip
    def test_what_is_taken_by_kind(self, kind: str, *, leaks: bool) -> None:
        more = "elements: {it: {kind: %s, country: DE}}\nflows: [{from: /recorder, to: it}]\n" % kind  # noqa: UP031 - braces
        result = analysed(more)
        assert [f.leak.name for f in result.analysis.findings if f.kind == "disclosure"] == ["it"] * leaks
        assert result.document()["assumptions"]["taken_by_kind"] == {kind: "leak" if leaks else "conduit"}
        assert not result.analysis.open

    def test_the_same_element_in_two_files_is_one(self, folder: Path) -> None:
        (folder / "a.yaml").write_text(LABELS + CLOUD % "country: DE", "utf-8")
        (folder / "b.yaml").write_text("labels: 1\n" + CLOUD % "country: DE", "utf-8")
        result = rosprivacy.analyze(["p.xml"], ["a.yaml", "b.yaml"])
        assert [told(f) for f in result.analysis.findings] == ["disclosure Video /camera /image /recorder cloud"]
        lines = [str(grant.place) for grant in result.analysis.findings[0].steps[-1].grants]
        assert lines == ["a.yaml:10", "b.yaml:3"]


class TestStorageLimitation:
    """Rule S10; GDPR Article 5(1)(e)."""

    @pytest.mark.parametrize(
        ("facts", "limits", "reason"),
        [
            ("", "", "no retention is stated"),
            ("retention: P30D", "", None),
            ("retention: P30D", "{Video: P30D}", None),
            ("retention: P31D", "{Video: P30D}", "kept for P31D, which can be longer than the P30D that Video"),
            ("retention: P1M", "{Video: P30D}", "kept for P1M, which can be longer"),
            ("retention: P1Y", "{Voice: P1D}", None),
            ("retention: P31D", "{PersonalData: P30D}", "longer than the P30D that Video may be kept"),
            ("retention: P31D", "{PersonalData: P30D, Video: P60D}", None),  # the nearest limit counts
            ("retention: {Video: P1D}", "{Video: P30D}", None),
            ("retention: {Voice: P1D}", "", "no retention is stated for Video"),
            ("retention: {PersonalData: P1Y, Video: P1D}", "{Video: P30D}", None),
            ("retention: {PersonalData: P1D, Video: P1Y}", "{Video: P30D}", "kept for P1Y"),
            ("retention: P30D, backups: true", "", "it has backups, and nothing says for how long"),
            ("retention: P30D, backups: false", "{Video: P30D}", None),
            ("retention: P20D, backups: P10D", "{Video: P30D}", None),
            ("retention: P20D, backups: P11D", "{Video: P30D}", "kept for P20D and in backups P11D more, which can"),
        ],
    )
    def test_how_long_it_is_kept(self, facts: str, limits: str, reason: str | None) -> None:
        why = reasons(BUCKET % facts + f"limits: {limits}\n")
        assert len(why) == (reason is not None)
        assert not why or str(reason) in why[0]

    def test_what_may_be_a_narrower_kind_is_held_against_its_limit(self) -> None:
        more = BUCKET % "retention: P1Y" + "limits: {FaceTemplate: P1D}\n"
        assert reasons(more) == []  # of Video, no face template is made
        more = more.replace("elements: {", "elements: {reader: {kind: device, source: [Biometric]}, ")
        more = more.replace("flows: [", "flows: [{from: reader, to: bucket}, ")
        assert reasons(more) == [
            "Biometric: kept for P1Y, which can be longer than the P1D that FaceTemplate may be kept"
        ]

    def test_pseudonymised_data_counts(self) -> None:
        result = analysed((BUCKET % "").replace("elements:", "elements:", 1))
        assert [f.pseudonymised for f in result.analysis.findings] == [False]
        text = Path("l.yaml").read_text("utf-8").replace("/recorder: conduit", "/recorder: {sanitizer: [Video]}")
        Path("l.yaml").write_text(text, "utf-8")
        result = rosprivacy.analyze(["p.xml"], ["l.yaml"])
        assert [(f.kind, f.pseudonymised) for f in result.analysis.findings] == [("storage-limitation", True)]

    def test_what_is_not_held_against_a_limit_is_said(self) -> None:
        (row,) = analysed(BUCKET % "retention: P30D").document()["outside"]
        assert row["without_limit"] == ["Video"]

    def test_it_is_found_behind_a_leak_too(self) -> None:
        """A leak on the way cures no retention, so the finding is not dismissed."""
        more = (
            "elements: {cloud: {kind: external-system, country: DE}, bucket: {kind: storage, country: DE}}\n"
            "flows: [{from: /recorder, to: cloud}, {from: cloud, to: bucket}]\n"
        )
        findings = analysed(more).analysis.findings
        assert [(f.kind, f.leak.name, f.dismissed) for f in findings] == [
            ("disclosure", "cloud", False),
            ("storage-limitation", "bucket", False),
        ]

    def test_only_a_storage_keeps(self) -> None:
        (line,) = refused(CLOUD % "retention: P30D")
        assert line.startswith("9: unknown key 'retention'")


class TestThirdCountries:
    """Rule S10; GDPR Articles 44 to 49."""

    @pytest.mark.parametrize(
        ("facts", "reason"),
        [
            ("country: DE", None),
            ("country: NO", None),  # which YAML takes for 'no'
            ("country: 'NO'", None),
            ("country: GP", None),  # a part of France
            ("country: KR", None),
            ("country: BR", None),  # adopted on 26 January 2026
            ("country: JP", "in JP, whose adequacy decision covers businesses under the Act on the Protection of"),
            ("country: JP, transfer: adequacy", None),
            ("country: CN", "in CN, for which no adequacy decision is known; no basis for the transfer is stated"),
            ("country: US", "in US, whose adequacy decision covers participants of the EU-US Data Privacy Framework"),
            ("country: CN, transfer: standard-clauses", None),
            ("country: CN, transfer: none", "no basis for the transfer is stated"),
            ("country: CN, transfer: adequacy", "the basis stated is adequacy, and no such decision is known"),
            ("country: US, transfer: adequacy", None),
        ],
    )
    def test_where_it_lies(self, facts: str, reason: str | None) -> None:
        why = reasons(CLOUD % facts)
        assert len(why) == (reason is not None)
        assert not why or str(reason) in why[0]

    @pytest.mark.parametrize("text", [CLOUD, BUCKET.replace(", country: DE", "")])
    def test_where_nobody_says_it_is_open(self, text: str) -> None:
        assert [q.missing for q in analysed(text % "operator: x").analysis.open] == [("country",)]
        assert not analysed(text % "transfer: standard-clauses").analysis.open

    @pytest.mark.parametrize("place", ["", "country: US, ", "country: CN, "])
    @pytest.mark.parametrize("stated", ["transfer: derogation", "legal_basis: [49(1)(b)]"])
    def test_a_derogation_is_no_basis_for_what_goes_on(self, place: str, stated: str) -> None:
        """Rule S11; Article 49 is for specific situations, recital 111: no finding, but a question."""
        analysis = analysed(CLOUD % f"conduit: [PersonalData], {place}{stated}").analysis
        assert not analysis.findings
        assert [(q.element.name, q.missing) for q in analysis.open] == [("cloud", ("occasional",))]
        assert analysis.verdict == "undetermined"

    @pytest.mark.parametrize(
        "stated",
        [
            "country: CN, transfer: occasional-derogation",
            "country: CN, transfer: occasional-derogation, legal_basis: [49(1)(b)]",
            "country: CN, transfer: standard-clauses",
            "country: DE, transfer: derogation",  # nothing leaves the EEA
            "country: KR, transfer: derogation",  # an adequacy decision covers it
        ],
    )
    def test_a_person_answers_whether_it_is_occasional(self, stated: str) -> None:
        analysis = analysed(CLOUD % f"conduit: [PersonalData], {stated}").analysis
        assert (analysis.findings, analysis.open, analysis.verdict) == ((), (), "no-leak-found")

    def test_the_question_is_in_the_document(self) -> None:
        document = analysed(CLOUD % "conduit: [PersonalData], country: CN, transfer: derogation").document()
        (row,) = document["outside"]
        assert (row["missing"], row["file"], row["line"]) == (["occasional"], "l.yaml", 9)
        assert [question.get("missing") for question in document["open"]] == [["occasional"]]

    def test_that_there_is_no_basis_is_a_statement(self) -> None:
        """A finding all the same, and told as stated."""
        said, silent = (analysed(CLOUD % f"country: CN{more}") for more in (", transfer: none", ""))
        assert [f.kind for f in said.analysis.findings] == [f.kind for f in silent.analysis.findings]
        assert [result.document()["outside"][0].get("transfer") for result in (said, silent)] == ["none", None]
        for form in ("article30", "cnil-pia"):
            assert "CN: no basis, as stated" in said.to(form)
            assert "CN: no basis is stated" in silent.to(form)

    def test_without_a_finding_the_verdict_is_undetermined(self) -> None:
        text = (BUCKET % "retention: P1D").replace("country: DE, ", "")
        assert analysed(text).analysis.verdict == "undetermined"

    def test_the_date_of_the_list_is_assumed(self) -> None:
        assumed = analysed(CLOUD % "country: US").document()["assumptions"]
        assert assumed["countries_as_of"] == countries().as_of
        assert "countries_as_of" not in analysed(CLOUD % "operator: x").document()["assumptions"]

    def test_the_list_has_every_code_once(self) -> None:
        areas = countries().areas
        assert len(areas) == 249
        assert sum(area == "eea" for area in areas.values()) == 30 + 7  # the EEA, and parts of its members
        assert not set(countries().partly) - set(areas)

    @pytest.mark.skipif(not Path("/usr/share/zoneinfo/iso3166.tab").exists(), reason="no list to compare with")
    def test_the_codes_are_those_of_the_time_zone_database(self) -> None:
        lines = Path("/usr/share/zoneinfo/iso3166.tab").read_text("utf-8").splitlines()
        assert set(countries().areas) == {line.split("\t")[0] for line in lines if not line.startswith("#")}


class TestRefusals:
    @pytest.mark.parametrize(
        ("elements", "problem"),
        [
            ("ring: {kind: shared-memory, between: [/recorder, /nobody]}", "9: a flow names '/nobody', which is not"),
            ("bucket: {kind: storage, source: [Video], conduit: [Video]}", "9: bucket is source for Video here and"),
        ],
    )
    def test_an_element(self, elements: str, problem: str) -> None:
        (line,) = refused(f"elements: {{{elements}}}\n")
        assert line.startswith(problem)

    @pytest.mark.parametrize(
        ("flow", "problem"),
        [
            ("{from: /recorder, to: buket}", "10: a flow names 'buket', which is not there; did you mean bucket?"),
            ("{from: /recordr, to: bucket}", "10: a flow names '/recordr', which is not there; did you mean /rec"),
            ("{from: '/x*', to: bucket}", "10: a flow names '/x*', which is not there; see the names with"),
            ("{from: bucket}", "10: a flow needs from and to"),
            ("{from: /recorder, to: /trainer}", "10: a flow between nodes and channels needs only or never"),
            ("{from: /recorder, to: bucket, only: [Vide]}", "10: unknown category 'Vide'"),
            ("{from: 3, to: bucket}", "10: '3' is not an absolute name; begin it with /"),
        ],
    )
    def test_a_flow(self, flow: str, problem: str) -> None:
        lines = refused(f"elements: {{bucket: {{kind: storage}}}}\nflows: [{flow}]\n")
        assert [line[: len(problem)] for line in lines] == [problem]

    def test_the_same_name_with_other_facts(self, folder: Path) -> None:
        (folder / "a.yaml").write_text("labels: 1\nelements: {b: {kind: storage}}\n", "utf-8")
        (folder / "l.yaml").write_text(LABELS + "elements: {b: {kind: display}}\n", "utf-8")
        with pytest.raises(InputErrors, match=r"l\.yaml:9: element 'b' again, with other facts than at a\.yaml:2"):
            rosprivacy.analyze(["p.xml"], ["a.yaml", "l.yaml"])

    def test_all_problems_are_told_at_once(self) -> None:
        lines = refused("elements:\n  b: {kind: storage, country: XX, retention: x}\nlimits: {Video: x}\n")
        assert [line.split(":")[0] for line in lines] == ["10", "10", "11"]
