"""Answers that hid what is not known: each by the command, with exit code and the words that the reader sees.

Source: the review of commit b86d901, cases 10, 11, 13 to 15, and its defects D2, D4 and D7.
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

CAM = (
    '<enclave path="/cam"><profiles><profile ns="/" node="camera">'
    '<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave>'
)
UP = (
    '<enclave path="/up"><profiles><profile ns="/" node="uplink">'
    '<topics subscribe="ALLOW"><topic>{topic}</topic></topics></profile></profiles></enclave>'
)


def policy(*enclaves: str) -> None:
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(enclaves)}</enclaves></policy>', "utf-8")


def labels(text: str) -> None:
    Path("l.yaml").write_text(f"labels: 1\n{text}", "utf-8")


def profile(node: str, *groups: tuple[str, str, str]) -> str:
    """A profile of (role, kind, name)."""
    rules = "".join(f'<{kind}s {role}="ALLOW"><{kind}>{name}</{kind}></{kind}s>' for role, kind, name in groups)
    return f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{rules}</profile></profiles></enclave>'


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def ends(cli: Cli, *more: str) -> list[dict[str, Any]]:
    """The unknown ends of the JSON document."""
    document = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "--format", "json", *more).stdout)
    found: list[dict[str, Any]] = document["unknown_ends"]
    return found


RECORDER = (
    profile("cam", ("publish", "topic", "/video")),
    profile("blur", ("subscribe", "topic", "/video"), ("publish", "topic", "/blurred")),
    profile("recorder", ("subscribe", "topic", "/video"), ("publish", "topic", "/raw_clips")),
    profile("cloud", ("subscribe", "topic", "/blurred"), ("subscribe", "topic", "/raw_clips")),
)
RECORDER_LABELS = (
    "nodes: {/cam: {source: [Video]}, /blur: {sanitizer: {Video: pseudonymise}}, /recorder: {leak: [Video]}, "
    "/cloud: {leak: [Video]}}\n"
)


def analysis(cli: Cli, *more: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "--format", "json", *more).stdout)
    return document


class TestPlainBesidePseudonymised:
    """Rule S10: that data arrives pseudonymised does not hide that it arrives as it is (defect D2)."""

    def test_both_are_told(self, cli: Cli) -> None:
        policy(*RECORDER)
        labels(RECORDER_LABELS)
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 1
        titles = [line.split("   [")[0] for line in done.stdout.splitlines() if line[:2] in ("1.", "2.", "3.")]
        assert titles == [
            "1. Video: /cam -> /recorder",
            "2. pseudonymised Video: /cam -> /cloud",
            "3. Video: /cam -> /cloud",
        ]
        only = "   only through /recorder, which has a finding of its own; past it, data gets there pseudonymised only"
        assert only in done.stdout.splitlines()

    def test_ids_are_those_of_before_and_one_more(self, cli: Cli) -> None:
        policy(*RECORDER)
        labels(RECORDER_LABELS)
        hidden, plain, recorder = analysis(cli)["findings"]
        ids = [finding_id("Video", Element("node", "/cam"), Element("node", name)) for name in ("/cloud", "/recorder")]
        assert [hidden["id"], recorder["id"]] == ids
        assert (plain["dismissed"], plain["pseudonymised"], plain["beside_pseudonymised"]) == (True, False, True)
        assert plain["id"] == finding_id("Video", Element("node", "/cam"), Element("node", "/cloud"), beside=True)
        assert plain["id"] not in ids

    def test_each_is_decided_about_by_itself(self, cli: Cli) -> None:
        policy(*RECORDER)
        labels(RECORDER_LABELS)
        Path("r.json").write_text(json.dumps(analysis(cli)), "utf-8")
        _, plain, _ = analysis(cli)["findings"]
        said = ("--reason", "x", "--owner", "y", "--legal-basis", "6(1)(f)")
        assert cli("decide", "accept", plain["id"], "--report", "r.json", *said).returncode == 0
        decided = analysis(cli, "--decisions", "decisions.yaml")
        assert [finding["accepted"] for finding in decided["findings"]] == [False, True, False]
        assert decided["verdict"] == "leak"

    def test_what_is_accepted_pseudonymised_is_not_accepted_as_it_is(self, cli: Cli) -> None:
        """Once the recorder is accepted, plain data gets to the cloud past no other leak: a finding to decide anew."""
        policy(*RECORDER)
        labels(RECORDER_LABELS)
        Path("r.json").write_text(json.dumps(analysis(cli)), "utf-8")
        hidden, _, recorder = analysis(cli)["findings"]
        said = ("--reason", "x", "--owner", "y", "--legal-basis", "6(1)(f)")
        assert cli("decide", "accept", hidden["id"], recorder["id"], "--report", "r.json", *said).returncode == 0
        decided = analysis(cli, "--decisions", "decisions.yaml")
        cloud, recorder = decided["findings"]
        assert (cloud["pseudonymised"], cloud["dismissed"], cloud["accepted"]) == (False, False, False)
        assert recorder["accepted"]

    def test_on_a_fleet_it_is_a_pattern_of_its_own(self, cli: Cli) -> None:
        policy(*RECORDER)
        labels(RECORDER_LABELS)
        robot = "{policies: [p.xml], labels: [l.yaml]}"
        Path("f.yaml").write_text(f"fleet: 1\nrobots: {{a: {robot}, b: {robot}}}\n", "utf-8")
        document = json.loads(cli("analyze", "--fleet", "f.yaml", "--format", "json").stdout)
        told = [(p["findings"], p["dismissed"], p["pseudonymised"]) for p in document["fleet"]["patterns"]]
        assert told == [(2, 0, 2), (2, 2, 0), (2, 0, 0)]


class TestFrontier:
    """Rule S11: what cuts the frontier is a leak of the category, and a wildcard is one element (D4, D7)."""

    def test_a_leak_of_another_kind_cuts_nothing(self, cli: Cli) -> None:
        policy(
            profile("cam", ("publish", "topic", "/a")),
            profile("d", ("subscribe", "topic", "/a"), ("publish", "topic", "/c")),
            profile("m", ("subscribe", "topic", "/c")),
        )
        labels(
            "nodes: {/cam: {source: [Video]}, /d: {leak: [Video], derives: [{from: Video, to: FaceTemplate}], "
            "sanitizer: {Video: drop}}}\n"
        )
        lines = cli("analyze", "p.xml", "-l", "l.yaml").stdout.splitlines()
        at = lines.index("Review next (nodes that data reaches first): 1")
        assert lines[at + 1] == "   /m  (node; 4 steps from a source; FaceTemplate through /c)"

    def test_the_sides_of_a_wildcard_are_one_element(self, cli: Cli) -> None:
        policy(profile("s", ("publish", "topic", "/*")), profile("m", ("subscribe", "topic", "/*")))
        labels("nodes: {/s: {source: [Video]}}\n")
        (node,) = [q for q in analysis(cli)["open"] if q["element"]["kind"] == "node"]
        assert (node["element"]["name"], node["distance"]) == ("/m", 2)
        labels("nodes: {/s: {source: [Video]}, /m: {leak: [Video]}}\n")
        (finding,) = analysis(cli)["findings"]
        assert len(finding["steps"]) == 2


class TestRestrictions:
    """Rules S7 and S11: what was emitted as a broader kind may be of the kind asked for (case 11)."""

    def system(self) -> None:
        policy(
            profile("camera", ("publish", "topic", "/video")),
            profile("id", ("publish", "topic", "/ids")),
            profile("uplink", ("subscribe", "topic", "/video")),
            profile("store", ("subscribe", "topic", "/ids")),
        )
        labels(
            "nodes: {/camera: {source: [PersonalData]}, /uplink: {leak: [Biometric]}, /id: {source: [FaceTemplate]}, "
            "/store: conduit}\nchannels: {/video: sensitive, /ids: sensitive}\n"
        )

    def test_a_broader_kind_is_followed_and_marked(self, cli: Cli) -> None:
        self.system()
        done = cli("analyze", "p.xml", "-l", "l.yaml", "-c", "Biometric")
        assert done.returncode == 1
        first, *lines = done.stdout.splitlines()
        assert first == "leak: data can reach a leak; only Biometric was asked for"
        assert any(line.startswith("1. PersonalData (may be Biometric): /camera -> /uplink   [") for line in lines)
        assert "   and PersonalData, since data of this kind may be Biometric" in lines
        assert analysis(cli, "-c", "Biometric")["assumptions"]["may_be_asked"] == {"PersonalData": ["Biometric"]}

    @pytest.mark.parametrize(
        ("filters", "named"),
        [
            (("-c", "Location", "-c", "Voice"), "Location, Voice"),
            (("--data-type", "image"), "data that is image"),
            (("--identity-factor", "physical"), "data with the identity factor physical"),
            (("--article9",), "what can fall under Article 9(1) or 10 GDPR"),
            (("-c", "Voice", "--article9"), "Voice and what can fall under Article 9(1) or 10 GDPR"),
        ],
    )
    def test_the_verdict_names_the_restriction_also_when_it_is_all(
        self, cli: Cli, filters: tuple[str, ...], named: str
    ) -> None:
        self.system()
        (line,) = cli("analyze", "p.xml", "-l", "l.yaml", "-q", *filters).stdout.splitlines()
        assert line.endswith(f"; only {named} was asked for")

    def test_a_kind_that_is_neither_narrower_nor_broader_is_left_out(self, cli: Cli) -> None:
        self.system()
        found = analysis(cli, "-c", "Location")
        assert {finding["category"] for finding in found["findings"]} <= {"PersonalData"}
        assert [category["name"] for category in found["categories"]] == ["PersonalData"]


STORED = (
    "nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/video: sensitive}\nlimits: {Video: P1D}\n"
    "elements: {disk: {kind: storage, country: %s, retention: P1D%s}}\nflows: [{from: /uplink, to: disk}]\n"
)


class TestWhatIsTaken:
    """Rules S9, S10 and S12: what nobody states is told, and what has ended does not hold (cases 13 to 15)."""

    def accepted_until(self, day: str) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels("nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n")
        entry = f"{{category: Video, decision: accept, reason: x, owner: y, legal_basis: [6(1)(f)], expires: {day}}}"
        Path("d.yaml").write_text(f"decisions: 1\nfindings: [{entry}]\n", "utf-8")

    def test_no_build_revives_an_acceptance(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        self.accepted_until("2025-01-01")
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
        done = cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml")
        assert done.returncode == 1
        said = "warning: SOURCE_DATE_EPOCH: by its day, 1970-01-01, fewer decisions have expired than today, "
        assert said in done.stdout
        assert "expired on 2025-01-01 and no longer counts; decide anew" in done.stdout

    def test_where_nothing_has_expired_the_fixed_day_stays(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        """Rule S14: the same bytes on every day."""
        self.accepted_until("9998-01-01")
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
        found = analysis(cli, "--decisions", "d.yaml")
        assert found["assumptions"]["decisions"]["today"] == "1970-01-01"
        assert found["verdict"] == "no-leak-found"
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "253370764800")  # 9999-01-01: the later day counts here, too
        assert cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml").returncode == 1

    def test_backups_that_nobody_states_are_told(self, cli: Cli) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(STORED % ("DE", ""))
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert "; backups of disk are not stated and taken as none" in done.stdout.splitlines()[0]
        disk = {"robot": "", "kind": "storage", "name": "disk"}
        assert analysis(cli)["assumptions"]["backups_taken_as_none"] == [disk]
        labels(STORED % ("DE", ", backups: false"))
        assert "backups of disk" not in cli("analyze", "p.xml", "-l", "l.yaml").stdout

    @pytest.mark.parametrize(
        ("more", "reason"),
        [
            ("", "in GB, for which the adequacy decision ended on 2031-12-27; no basis for the transfer is stated"),
            (
                ", transfer: adequacy",
                "in GB; the basis stated is adequacy, and the adequacy decision ended on 2031-12-27",
            ),
        ],
    )
    def test_an_adequacy_decision_ends(self, cli: Cli, monkeypatch: pytest.MonkeyPatch, more: str, reason: str) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(STORED % ("GB", f", backups: false{more}"))
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "1956268800")  # 2031-12-29
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 1
        assert f"   {reason}" in done.stdout.splitlines()

    def test_until_then_it_holds(self, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(STORED % ("GB", ", backups: false"))
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "1956139200")  # 2031-12-27
        assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 0


class TestUnknownEnds:
    """Rule S11: what is not known is said (case 10)."""

    def test_a_channel_that_nobody_known_reads(self, cli: Cli) -> None:
        policy(CAM, UP.format(topic="/other"))
        labels("nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        first, *_ = done.stdout.splitlines()
        assert first.startswith("no-leak-found: ")
        assert first.endswith("; /video ends at no known reader")
        assert "      /video (topic; Video), p.xml:" in done.stdout
        assert (
            cli("analyze", "p.xml", "-l", "l.yaml", "-q").stdout.rstrip().endswith("; /video ends at no known reader")
        )
        assert ends(cli) == [
            {
                "element": {"robot": "", "kind": "topic", "name": "/video"},
                "unknown": "reader",
                "categories": ["Video"],
            }
        ]

    def test_a_request_that_no_server_reads(self, cli: Cli) -> None:
        policy(profile("camera", ("request", "service", "/store")), UP.format(topic="/other"))
        labels("nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/store: sensitive}\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert "; /store ends at no known reader" in done.stdout
        assert "      /store (service request; Video), p.xml:" in done.stdout

    def test_a_reply_that_no_client_reads(self, cli: Cli) -> None:
        policy(profile("camera", ("execute", "action", "/film")))
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/film: sensitive}\n")
        assert [end["element"]["leg"] for end in ends(cli)] == ["response"]

    @pytest.mark.parametrize("reads", ["/v*", "/video", "/vide?"])
    def test_who_reads_through_a_wildcard_is_a_known_reader(self, cli: Cli, reads: str) -> None:
        policy(CAM, UP.format(topic=reads))
        labels("nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/v*: sensitive}\n")
        assert ends(cli) == []
        assert "no known reader" not in cli("analyze", "p.xml", "-l", "l.yaml").stdout

    def test_a_wildcard_that_nobody_known_reads(self, cli: Cli) -> None:
        policy(CAM.replace("/video", "/v*"), UP.format(topic="/other"))
        labels("nodes: {/camera: {source: [Video]}}\n")
        assert [end["element"]["name"] for end in ends(cli)] == ["/v*"]

    def test_who_is_denied_reads_nothing(self, cli: Cli) -> None:
        denied = UP.format(topic="/video").replace(
            "</profile>", '<topics subscribe="DENY"><topic>/video</topic></topics></profile>'
        )
        policy(CAM, denied)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        assert [end["element"]["name"] for end in ends(cli)] == ["/video"]

    def test_a_channel_without_data_is_none(self, cli: Cli) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: mundane}\n")
        assert ends(cli) == []

    @pytest.mark.parametrize("flows", ["", "flows: [{from: cloud, to: /uplink}]\n"])
    def test_an_element_outside_ros_that_no_flow_reaches(self, cli: Cli, flows: str) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(
            "nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/video: sensitive}\n"
            f"elements: {{cloud: {{kind: external-system, country: US}}}}\n{flows}"
        )
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert done.stdout.splitlines()[0].endswith("; no flow reaches cloud")
        assert "      cloud (external-system), l.yaml:4" in done.stdout

    def test_a_device_that_data_begins_at_is_none(self, cli: Cli) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(
            "nodes: {/uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"
            "elements: {badge: {kind: device, source: [Video]}}\nflows: [{from: badge, to: /camera}]\n"
        )
        assert ends(cli) == []

    @pytest.mark.parametrize("form", ["html", "markdown"])
    def test_in_the_report(self, cli: Cli, form: str) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        done = cli("report", "p.xml", "-l", "l.yaml", "--format", form)
        assert done.returncode == 0
        assert "In doubt: /video ends at no known reader." in done.stdout
        assert "Data that nobody known reads" in done.stdout

    def test_on_a_fleet_with_the_robot(self, cli: Cli) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video], leak: none}}\nchannels: {/video: sensitive}\n")
        fleet = (
            "fleet: 1\nrobots: {a: {policies: [p.xml], labels: [l.yaml]}, b: {policies: [p.xml], labels: [l.yaml]}}\n"
        )
        Path("f.yaml").write_text(fleet, "utf-8")
        done = cli("analyze", "--fleet", "f.yaml")
        assert done.returncode == 0
        assert done.stdout.splitlines()[0].endswith("; 2 channels end at no known reader (a:/video)")
        assert "      a:/video (topic; Video), p.xml:" in done.stdout
