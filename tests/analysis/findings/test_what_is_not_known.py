"""What is not known, restricted or has ended is said: as policies and labels are written, by the command (S7 to S12).

On random systems ``test_findings.py`` holds the same against brute force, and ``test_nothing_hides.py`` for every
output that it is named there.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.findings.findings import finding_id
from rosprivacy.analysis.model import Element
from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

ANALYZE = ("analyze", "p.xml", "-l", "l.yaml")


def profile(node: str, *groups: tuple[str, str, str]) -> str:
    """A profile of (role, kind, name); a role with ``!`` is denied."""
    rules = "".join(
        f'<{kind}s {role.strip("!")}="{"DENY" if "!" in role else "ALLOW"}"><{kind}>{name}</{kind}></{kind}s>'
        for role, kind, name in groups
    )
    return f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{rules}</profile></profiles></enclave>'


CAMERA = profile("camera", ("publish", "topic", "/video"))
UPLINK = profile("uplink", ("subscribe", "topic", "/video"))


def system(labels: str, *profiles: str) -> None:
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(profiles)}</enclaves></policy>', "utf-8")
    Path("l.yaml").write_text(f"labels: 1\n{labels}", "utf-8")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def analysis(cli: Cli, *more: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(cli(*ANALYZE, "--format", "json", *more).stdout)
    return document


class TestPlainBesidePseudonymised:
    """Rule S10: that data arrives pseudonymised does not hide that it arrives as it is."""

    @pytest.fixture(autouse=True)
    def _system(self, _folder: None) -> None:
        system(
            "nodes: {/cam: {source: [Video]}, /blur: {sanitizer: {Video: pseudonymise}}, /recorder: {leak: [Video]}, "
            "/cloud: {leak: [Video]}}\n",
            profile("cam", ("publish", "topic", "/video")),
            profile("blur", ("subscribe", "topic", "/video"), ("publish", "topic", "/blurred")),
            profile("recorder", ("subscribe", "topic", "/video"), ("publish", "topic", "/raw_clips")),
            profile("cloud", ("subscribe", "topic", "/blurred"), ("subscribe", "topic", "/raw_clips")),
        )

    def test_both_are_told_and_each_is_decided_about_by_itself(self, cli: Cli) -> None:
        before = analysis(cli)
        ends = Element("node", "/cam"), Element("node", "/cloud")
        hidden, plain, recorder = (finding["id"] for finding in before["findings"])
        assert hidden == finding_id("Video", *ends)
        assert plain == finding_id("Video", *ends, plain_also=True)
        plain_is = before["findings"][1]
        assert (plain_is["dismissed"], plain_is["pseudonymised"], plain_is["beside_pseudonymised"]) == (
            True,
            False,
            True,
        )
        Path("r.json").write_text(json.dumps(before), "utf-8")
        to_cloud = (False, False, False)  # past the recorder, once that is accepted: to decide anew
        for accepted, expected in (
            ([plain], [(True, False, False), (False, True, True), (False, False, False)]),
            ([hidden, recorder], [to_cloud, (False, False, True)]),
        ):
            Path("decisions.jsonl").unlink(missing_ok=True)
            why = ("--reason", "x", "--owner", "y", "--legal-basis", "6(1)(f)")
            assert cli("decide", "accept", *accepted, "--report", "r.json", *why).returncode == 0
            after = analysis(cli, "--decisions", "decisions.jsonl")
            keys = ("pseudonymised", "dismissed", "accepted")
            assert [tuple(finding[key] for key in keys) for finding in after["findings"]] == expected
            assert after["verdict"] == "leak"

    def test_on_a_fleet_it_is_a_pattern_of_its_own(self, cli: Cli) -> None:
        """Also where the first robot, which stands for the others, has the pseudonymised data only."""
        Path("q.xml").write_text(Path("p.xml").read_text("utf-8").replace("/raw_clips", "/kept_clips", 1), "utf-8")
        robots = (f"{name}: {{policies: [{policy}.xml], labels: [l.yaml]}}" for name, policy in ("aq", "bp", "cp"))
        Path("f.yaml").write_text(f"fleet: 1\nrobots: {{{', '.join(robots)}}}\n", "utf-8")
        document = json.loads(cli("analyze", "--fleet", "f.yaml", "--format", "json").stdout)
        patterns = [(p["findings"], p["dismissed"], p["pseudonymised"]) for p in document["fleet"]["patterns"]]
        assert patterns == [(3, 0, 3), (3, 0, 0), (2, 2, 0)]


class TestRestrictions:
    """Rules S7 and S11: what was emitted as a broader kind may be of the kind asked for."""

    @pytest.fixture(autouse=True)
    def _system(self, _folder: None) -> None:
        system(
            "nodes: {/camera: {source: [PersonalData]}, /uplink: {leak: [Biometric]}, /id: {source: [FaceTemplate]}, "
            "/store: conduit}\nchannels: {/video: sensitive, /ids: sensitive}\n",
            CAMERA,
            profile("id", ("publish", "topic", "/ids")),
            UPLINK,
            profile("store", ("subscribe", "topic", "/ids")),
        )

    def test_a_broader_kind_is_followed_and_marked_and_no_other(self, cli: Cli) -> None:
        document = analysis(cli, "-c", "Biometric")
        assert {finding["category"] for finding in document["findings"]} == {"PersonalData"}
        assert document["assumptions"]["may_be_asked"] == {"PersonalData": ["Biometric"]}
        lines = cli(*ANALYZE, "-c", "Biometric").stdout.splitlines()
        assert any(line.startswith("1. /uplink: PersonalData (may be Biometric), from /camera   [") for line in lines)
        document = analysis(cli, "-c", "Location")
        assert [category["name"] for category in document["categories"]] == ["PersonalData"]

    def test_the_verdict_names_the_restriction_also_when_it_is_all(self, cli: Cli) -> None:
        for filters, named in (
            (("-c", "Location", "-c", "Voice"), "Location, Voice"),
            (("--data-type", "image"), "data that is image"),
            (("--identity-factor", "physical"), "data with the identity factor physical"),
            (("--article9",), "what can fall under Article 9(1) or 10 GDPR"),
            (("-c", "Voice", "--article9"), "Voice and what can fall under Article 9(1) or 10 GDPR"),
        ):
            assert cli(*ANALYZE, "-q", *filters).stdout.rstrip().endswith(f"; only {named} was asked for")


class TestWhatHasEnded:
    """Rules S9, S10 and S12: what nobody states is told, and what has ended does not hold."""

    def accepted_until(self, day: str) -> None:
        labels = "nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"
        system(labels, CAMERA, UPLINK)
        entry = f"{{category: Video, decision: accept, reason: x, owner: y, legal_basis: [6(1)(f)], expires: {day}}}"
        Path("d.yaml").write_text(f"decisions: 1\nfindings: [{entry}]\n", "utf-8")

    def test_no_build_revives_an_acceptance(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        self.accepted_until("2025-01-01")
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
        done = cli(*ANALYZE, "--decisions", "d.yaml")
        assert done.returncode == 1
        assert "warning: SOURCE_DATE_EPOCH: by its day, 1970-01-01," in done.stdout
        assert "expired on 2025-01-01" in done.stdout

    def test_where_nothing_has_expired_the_fixed_day_stays(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        """Rule S14: the same bytes on every day."""
        self.accepted_until("9998-01-01")
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
        document = analysis(cli, "--decisions", "d.yaml")
        assert document["assumptions"]["decisions"]["today"] == "1970-01-01"
        assert document["verdict"] == "no-leak-found"
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "253370764800")  # 9999-01-01: the later day counts here, too
        assert cli(*ANALYZE, "--decisions", "d.yaml").returncode == 1

    def test_backups_that_nobody_states_and_adequacy_decisions(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        ended = "the adequacy decision ended on 2031-12-27"
        disk = [{"robot": "", "kind": "storage", "name": "disk"}]
        last, after = "1956139200", "1956268800"  # 2031-12-27, 2031-12-29
        for day, facts, code, backups, reason in (
            (last, "country: DE", 0, disk, ""),
            (last, "country: DE, backups: false", 0, [], ""),
            (last, "country: GB, backups: false", 0, [], ""),
            (
                after,
                "country: GB, backups: false",
                1,
                [],
                f"in GB, for which {ended}; no basis for the transfer is stated",
            ),
            (
                after,
                "country: GB, backups: false, transfer: adequacy",
                1,
                [],
                f"in GB; the basis stated is adequacy, and {ended}",
            ),
        ):
            monkeypatch.setenv("SOURCE_DATE_EPOCH", day)
            system(
                "nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/video: sensitive}\n"
                f"limits: {{Video: P1D}}\nelements: {{disk: {{kind: storage, retention: P1D, {facts}}}}}\n"
                "flows: [{from: /uplink, to: disk}]\n",
                CAMERA,
                UPLINK,
            )
            document = analysis(cli)
            assert document["assumptions"]["backups_taken_as_none"] == backups
            assert [finding["reason"] for finding in document["findings"]] == ([reason] if reason else [])
            assert cli(*ANALYZE).returncode == code


VIDEO = 'nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {"/v*": sensitive}\n'
OTHER = profile("uplink", ("subscribe", "topic", "/other"))
CLOUD = VIDEO + "elements: {cloud: {kind: external-system, country: US}}\n"
BADGE = (
    "nodes: {/uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"
    "elements: {badge: {kind: device, source: [Video]}}\nflows: [{from: badge, to: /camera}]\n"
)
UNKNOWN_ENDS = (
    (VIDEO, [CAMERA, OTHER], [("topic", "/video", None, "reader")]),
    (VIDEO, [profile("camera", ("publish", "topic", "/v*")), OTHER], [("topic", "/v*", None, "reader")]),
    *((VIDEO, [CAMERA, profile("uplink", ("subscribe", "topic", by))], []) for by in ("/v*", "/video", "/vide?")),
    (  # who is denied reads nothing
        VIDEO,
        [CAMERA, profile("uplink", ("subscribe", "topic", "/video"), ("!subscribe", "topic", "/video"))],
        [("topic", "/video", None, "reader")],
    ),
    (VIDEO.replace("sensitive", "mundane"), [CAMERA, OTHER], []),  # without data
    (
        "nodes: {/camera: {source: [Video]}}\nchannels: {/store: sensitive}\n",
        [profile("camera", ("request", "service", "/store"))],
        [("service", "/store", "request", "reader")],
    ),
    (
        "nodes: {/camera: {source: [Video]}}\nchannels: {/film: sensitive}\n",
        [profile("camera", ("execute", "action", "/film"))],
        [("action", "/film", "response", "reader")],
    ),
    (CLOUD, [CAMERA, UPLINK], [("external-system", "cloud", None, "flow")]),
    (CLOUD + "flows: [{from: cloud, to: /uplink}]\n", [CAMERA, UPLINK], [("external-system", "cloud", None, "flow")]),
    (BADGE, [CAMERA, UPLINK], []),  # where data begins, a flow out is enough
)


def test_unknown_ends(cli: Cli) -> None:
    """Rule S11."""
    for labels, profiles, expected in UNKNOWN_ENDS:
        system(labels, *profiles)
        ends = [
            (*(end["element"].get(key) for key in ("kind", "name", "leg")), end["unknown"])
            for end in analysis(cli)["unknown_ends"]
        ]
        assert ends == expected, (labels, profiles)


def test_the_sides_of_a_wildcard_are_one_element(cli: Cli) -> None:
    """Rules S4, S11: a step less, in open questions and in findings."""
    profiles = profile("s", ("publish", "topic", "/*")), profile("m", ("subscribe", "topic", "/*"))
    system("nodes: {/s: {source: [Video]}}\n", *profiles)
    (node,) = [q for q in analysis(cli)["open"] if q["element"]["kind"] == "node"]
    assert (node["element"]["name"], node["distance"]) == ("/m", 2)
    system("nodes: {/s: {source: [Video]}, /m: {leak: [Video]}}\n", *profiles)
    (finding,) = analysis(cli)["findings"]
    assert len(finding["steps"]) == 2
