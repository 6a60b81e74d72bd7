"""Leaks that labels lost without a word: each by the command, with exit code and what the reader is told.

Source: rules S7, S8, S9 and S13.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import refused

if TYPE_CHECKING:
    from tests.helpers.command import Cli

OWN = """
@prefix : <urn:example:own:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:Caption a skos:Concept ; rp:label "Caption" ; skos:broader rp:Video ; rp:dataType "{}" ;
    skos:prefLabel "caption"@en ; skos:definition "What is seen on a video."@en .
"""
GROUPS = {
    ">": ("topic", "publish"),
    "<": ("topic", "subscribe"),
    "?": ("service", "request"),
    "!": ("service", "reply"),
}


@pytest.fixture(autouse=True)
def _camera_to_uplink(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    policy(camera=">video", uplink="<video")


def policy(**nodes: str) -> None:
    """Nodes with what they do: ``>topic`` publishes, ``<topic`` subscribes, ``?name`` requests, ``!name`` replies."""
    enclaves = ""
    for node, does in nodes.items():
        rules = ""
        for rule in does.split():
            kind, role = GROUPS[rule[0]]
            rules += f'<{kind}s {role}="ALLOW"><{kind}>/{rule[1:]}</{kind}></{kind}s>'
        enclaves += (
            f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{rules}</profile></profiles></enclave>'
        )
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{enclaves}</enclaves></policy>', "utf-8")


def labels(*texts: str) -> list[str]:
    """Write label files 1.yaml, 2.yaml, …; return the options that name them."""
    options = []
    for number, text in enumerate(texts, 1):
        Path(f"{number}.yaml").write_text(f"labels: 1\n{text}\n", "utf-8")
        options += ["-l", f"{number}.yaml"]
    return options


def code(cli: Cli, *texts: str, options: tuple[str, ...] = ()) -> int:
    return cli("analyze", "p.xml", *labels(*texts), *options).returncode


def problem(cli: Cli, *texts: str) -> str:
    (line,) = refused(cli("analyze", "p.xml", *labels(*texts)))
    return line


def document(cli: Cli, *options: str) -> dict[str, Any]:
    whole: dict[str, Any] = json.loads(cli("analyze", "p.xml", *options, "--format", "json1").stdout)
    return whole


LABELS = "nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}"
GLOB = "nodes:\n  /camera: {source: [Video]}\n  /up*: {leak: [Video]}\nchannels: {/video: sensitive}"
SOURCE = "nodes:\n  /cam*: {source: [Video]}\n  /uplink: {leak: [Video]}"
LIMITED = "nodes:\n  /camera: {source: {Video: [/video]}}\n  /uplink: {leak: [Video]}\n"


class TestTakingAwayIsNeverSilent:
    """Rule S7."""

    @pytest.mark.parametrize("conduit", ["conduit", "{conduit: [PersonalData]}", "{conduit: [Video]}"])
    @pytest.mark.parametrize("files", [1, 2])
    def test_a_conduit_takes_no_leak_away_whatever_the_ranks(self, cli: Cli, conduit: str, files: int) -> None:
        """One meaning of 'reviewed', bare, of all kinds or of this one; the message says what to write."""
        by_name = f"  /uplink: {conduit}"
        texts = [GLOB, f"nodes:\n{by_name}"] if files > 1 else [GLOB.replace("chan", f"{by_name}\nchan")]
        done = cli("analyze", "p.xml", *labels(*texts))
        assert done.returncode == 1
        (line,) = [line for line in done.stdout.splitlines() if "does not take away" in line]
        assert line.startswith(f"warning: {files}.yaml:{5 if files == 1 else 3}: /uplink: conduit ")
        assert line.endswith("the leak of Video at 1.yaml:4; if that is meant, write 'leak: none'")

    @pytest.mark.parametrize(
        ("texts", "expected", "words"),
        [
            ([LABELS], 1, ""),
            # `none` takes a leak away of all kinds or of some
            ([GLOB, "nodes: {/uplink: {leak: none, conduit: [Video]}}"], 0, "takes away the leak of Video at 1.yaml:4"),
            ([GLOB, "nodes: {/uplink: {leak: {none: [Video]}, conduit: [Video]}}"], 0, "leak: {none: [Video]} takes"),
            ([GLOB, "nodes: {/uplink: {leak: {none: [PersonalData, Voice]}, conduit: [Video]}}"], 0, "takes away"),
            # … of another kind, or of a broader one beside the leak, it does not
            ([GLOB, "nodes: {/uplink: {leak: {none: [Voice]}}}"], 1, ""),
            ([LABELS, "nodes: {/uplink: {leak: none}}"], 1, ""),
            # a conduit takes no source away, and a sanitizer none that ranks higher
            ([SOURCE, "nodes:\n  /camera: conduit"], 1, "if that is meant, write 'source: none'"),
            ([SOURCE, "nodes:\n  /camera: {source: none, sanitizer: {Video: drop}}"], 4, "source: none takes away the"),
            ([SOURCE.replace("*", "era") + "\n  /cam*: {sanitizer: {Video: drop}}"], 1, ""),
            # a leak of a narrower kind is not outdone by a name for a broader one
            ([GLOB.replace("[Video]", "[PersonalData]", 1), "nodes: {/uplink: {conduit: [PersonalData]}}"], 1, ""),
        ],
    )  # fmt: skip
    def test_which_label_wins(self, cli: Cli, texts: list[str], expected: int, words: str) -> None:
        done = cli("analyze", "p.xml", *labels(*texts))
        assert done.returncode == expected
        assert words in done.stdout

    def test_a_leak_that_still_holds_is_not_taken_away(self, cli: Cli) -> None:
        text = "nodes: {/camera: {source: [Video]}, '/u*': {leak: [Video]}, '/up*': conduit, /uplink: {leak: [Video]}}"
        done = cli("analyze", "p.xml", *labels(text))
        assert (done.returncode, "taken away" in done.stdout) == (1, False)

    @pytest.mark.parametrize(
        ("texts", "words"),
        [
            (["nodes: {/uplink: {leak: [Video], conduit: [Video]}}"], "/uplink is "),
            ([LABELS, "nodes: {/uplink: {leak: {none: [Video]}}}"], "/uplink is leak: {none: [Video]} for Video here"),
            (
                [SOURCE, "nodes:\n  /camera: {sanitizer: {Video: drop}}"],
                "2.yaml:3: /camera is sanitizer (drop) for Video here and source at 1.yaml:3",
            ),
            # S7: what a source names a channel for, in full, no full name takes away
            ([LIMITED + "channels:\n  /video: mundane"], "1.yaml:6: /video is mundane here, and the source"),
            ([LIMITED + "channels:\n  /video: {never: [Video]}"], "1.yaml:6: /video is never [Video] here"),
            ([LIMITED + "channels:\n  /video: {only: [Voice]}"], "1.yaml:6: /video is only [Voice] here"),
            (
                [LIMITED + "flows:\n  - {from: /camera, to: /video, never: [Video]}"],
                "1.yaml:6: /video is never [Video] here, and the source at 1.yaml:3 names it for Video",
            ),
            (["channels:\n  /video: {only: [Video], never: [Video]}"], "1.yaml:3: Video is under only and under never"),
        ],
    )  # fmt: skip
    def test_what_contradicts_itself_is_an_error_with_both_lines(self, cli: Cli, texts: list[str], words: str) -> None:
        assert words in problem(cli, *texts)

    def test_what_is_taken_away_by_name_is_counted(self, cli: Cli) -> None:
        options = labels(GLOB, "nodes:\n  /uplink: {leak: none, conduit: [Video]}")
        assert document(cli, *options)["assumptions"]["overruled"] == [
            {
                "role": "leak",
                "categories": ["Video"],
                "elements": ["/uplink"],
                "file": "1.yaml",
                "line": 4,
                "by": {"says": "leak: none", "file": "2.yaml", "line": 3},
            }
        ]

    def test_a_source_is_taken_away_of_some_kinds_or_channels(self, cli: Cli) -> None:
        policy(camera=">video >raw", uplink="<video <raw")
        text = "nodes:\n  /cam*: {source: [Video, Voice]}\n  /uplink: {leak: [PersonalData]}\n"
        none = "  /camera: {source: {none: [Video], Location: [/raw]}}"
        assert {f["category"] for f in document(cli, *labels(text + none))["findings"]} == {"Voice", "Location"}
        less = "nodes:\n  /cam*: {source: [Video]}\n  /camera: {source: {Video: [/video]}}"
        done = cli("analyze", "p.xml", *labels(less))
        assert "/camera: source through /video takes away the source of Video at 1.yaml:3" in done.stdout

    def test_a_robots_own_file_says_it_by_name_too(self, cli: Cli) -> None:
        fleet = (
            "fleet: 1\nmodels: {m: {policies: [p.xml], labels: [1.yaml]}}\nrobots: {a: {model: m, labels: [2.yaml]}}"
        )
        Path("f.yaml").write_text(fleet, "utf-8")
        for label, expected, words in (
            ("conduit", 1, "2.yaml:3: /uplink: conduit does not take away the leak of Video at 1.yaml:2; "),
            ("{leak: none, conduit: [Video]}", 0, "2.yaml:3: /uplink: leak: none takes away the leak of Video"),
        ):
            labels(LABELS, f"nodes:\n  /uplink: {label}")
            done = cli("analyze", "--fleet", "f.yaml")
            assert (done.returncode, words in done.stdout) == (expected, True)


class TestWhatASourceNamesAChannelFor:
    """Rule S7: no shipped statement and no glob takes it away."""

    @pytest.mark.parametrize("leg", ["!frame", "?frame"])
    def test_of_a_service_in_both_legs(self, cli: Cli, leg: str) -> None:
        """S2, S7: what goes back in the other leg is not taken away by a glob either."""
        policy(cam=leg, client=f"{'?' if leg[0] == '!' else '!'}frame", cloud=leg)
        text = "nodes: {/cam: {source: {Video: [/frame]}}, /client: conduit, /cloud: {leak: [Video]}}\n"
        for more in ("", 'channels: {"/*": mundane}', 'channels: {"/*": {never: [Video]}}'):
            findings = document(cli, *labels(text + more))["findings"]
            assert [(f["source"]["name"], f["leak"]["name"]) for f in findings] == [("/cam", "/cloud")]
        problem(cli, text + "channels: {/frame: mundane}")

    @pytest.mark.parametrize(
        ("camera", "uplink", "name"),
        [
            (">rosout", "<rosout", "/rosout"),  # a standard topic
            ("?x/set_parameters", "!x/set_parameters", "/x/set_parameters"),  # a standard service, in each leg
            ("!x/set_parameters", "?x/set_parameters", "/x/set_parameters"),
        ],
    )
    def test_a_standard_channel(self, cli: Cli, camera: str, uplink: str, name: str) -> None:
        policy(camera=camera, uplink=uplink)
        assert code(cli, f"nodes: {{/camera: {{source: {{Voice: [{name}]}}}}, /uplink: {{leak: [Voice]}}}}") == 1

    @pytest.mark.parametrize("through", ["/video", "/vi*"])
    @pytest.mark.parametrize("label", ["mundane", "{never: [PersonalData]}", "{only: [Voice]}"])
    def test_a_glob_of_the_users(self, cli: Cli, through: str, label: str) -> None:
        text = LIMITED.replace("[/video]", f"['{through}']")
        assert code(cli, f"{text}channels: {{'/v*': {label}}}") == 1

    def test_a_flow_with_a_glob(self, cli: Cli) -> None:
        assert code(cli, f"{LIMITED}flows:\n  - {{from: '/c*', to: /video, never: [Video]}}") == 1

    def test_a_wildcard_that_it_writes_and_the_channel_that_is_read(self, cli: Cli) -> None:
        policy(camera=">v*", uplink="<video")
        assert code(cli, LIMITED.replace("[/video]", "['/v*']") + "channels: {'/v*': mundane}") == 1

    @pytest.mark.parametrize(("kind", "expected"), [("Voice", 1), ("Location", 4)])
    def test_another_kind_is_still_kept_out(self, cli: Cli, kind: str, expected: int) -> None:
        text = f"nodes: {{/camera: {{source: {{Video: [/video], {kind}: [/video]}}}}, /uplink: {{leak: [Voice]}}}}"
        assert code(cli, f"{text}\nchannels: {{'/v*': {{never: [Location]}}}}") == expected

    def test_no_proposal_contradicts_it(self, cli: Cli) -> None:
        """A review of the channel would; a filter behind the source does not."""
        done = cli("mitigate", "p.xml", *labels(LIMITED), "--by", "review")
        assert "Traceback" not in done.stderr
        assert "review /video" not in done.stdout
        done = cli("mitigate", "p.xml", *labels(LIMITED), "--by", "filter")
        assert "filter" in done.stdout
        assert "no-leak-found" in done.stdout or "undetermined" in done.stdout


class TestStandardChannels:
    """Rule S13."""

    CLOCK = "nodes: {/camera: {source: [Voice]}, /uplink: {leak: [Voice]}}"

    def test_a_name_that_only_ends_like_one_is_told_and_so_is_a_glob_that_does_not_count(self, cli: Cli) -> None:
        policy(camera=">patient/clock", uplink="<patient/clock")
        assert code(cli, self.CLOCK) == 4  # the data of no source goes anywhere else
        options = labels(f"{self.CLOCK}\nchannels: {{'/patient/*': sensitive}}")
        done = cli("analyze", "p.xml", *options)
        assert done.returncode == 4
        assert "   data gets to 1 of them and stops there: /patient/clock (Voice)\n" in done.stdout
        assert "a glob says otherwise, which does not count: /patient/clock" in done.stdout
        channel = {"robot": "", "kind": "topic", "name": "/patient/clock"}
        assumed = document(cli, *options)["assumptions"]
        (reached,) = assumed["standard_channels_reached"]
        assert (reached["element"], reached["categories"]) == (channel, ["Voice"])
        assert reached["keeps_from"]["name"] == "/uplink"
        assert assumed["standard_channels_unchanged"] == [channel]

    @pytest.mark.parametrize("name", ["/patient/clock", "*/clock", "/p*/clock"])
    def test_a_full_name_or_a_glob_with_its_end_written_out_outranks_the_file(self, cli: Cli, name: str) -> None:
        policy(camera=">patient/clock", uplink="<patient/clock")
        assert code(cli, f"{self.CLOCK}\nchannels: {{'{name}': sensitive}}") == 1

    def test_the_infrastructure_file_yields_to_every_glob(self, cli: Cli) -> None:
        policy(camera=">tf_static", uplink="<tf_static")
        text = f"{self.CLOCK}\nchannels: {{'/*': sensitive}}"
        assert code(cli, text, options=("-l", "rosprivacy:infrastructure")) == 1

    @pytest.mark.parametrize("kind", ["SpeechTranscript", "PersonName", "PostalAddress", "Location", "PersonalData"])
    @pytest.mark.parametrize("topic", ["rosout", "ward/rosout"])
    def test_what_can_be_said_in_words_passes_the_log(self, cli: Cli, kind: str, topic: str) -> None:
        """``rosout`` ends a kind only if neither it nor a narrower one is text or an identifier."""
        policy(listener=f">words >{topic}", bridge=f"<{topic}")
        text = f"nodes: {{/listener: {{source: [{kind}]}}, /bridge: {{leak: [PersonalData]}}}}"
        assert code(cli, text) == 1
        assert code(cli, f"{text}\nchannels: {{/{topic}: mundane, /words: sensitive}}") == 0

    @pytest.mark.parametrize("kind", ["Video", "Voice", "FaceTemplate"])
    def test_a_picture_or_a_sound_does_not(self, cli: Cli, kind: str) -> None:
        policy(camera=">video >rosout", bridge="<rosout")
        text = f"nodes: {{/camera: {{source: [{kind}]}}, /bridge: {{leak: [PersonalData]}}}}\n"
        assert code(cli, f"{text}channels: {{/video: sensitive}}") == 0

    @pytest.mark.parametrize(("form", "expected"), [("text", 1), ("video", 0)])
    def test_a_kind_of_a_users_own_is_what_its_file_says(self, cli: Cli, form: str, expected: int) -> None:
        policy(camera=">video >rosout", bridge="<rosout")
        text = "nodes: {/camera: {source: [Caption]}, /bridge: {leak: [PersonalData]}}\nchannels: {/video: sensitive}"
        Path("own.ttl").write_text(OWN.format(form), "utf-8")
        assert code(cli, text, options=("--ontology", "own.ttl")) == expected


class TestAFileThatReplacesTheStandardOne:
    """Rule S13."""

    def test_it_says_that_channels_are_mundane_and_nothing_else(self, cli: Cli) -> None:
        Path("s.yaml").write_text(
            "labels: 1\nnodes:\n  /up*: {sanitizer: {Video: drop}}\nchannels:\n  '/*': mundane\n  /video: sensitive\n"
            "flows: [{from: /video, to: /uplink, never: [Video]}]\nlimits: {Video: P1D}\n",
            "utf-8",
        )
        lines = refused(cli("analyze", "p.xml", *labels(LABELS), "--standard-channels", "s.yaml"))
        assert [line.partition(" in a file of standard channels; ")[0] for line in lines] == [
            "s.yaml:2: nodes", "s.yaml:6: '/video' is sensitive", "s.yaml:7: flows", "s.yaml:8: limits",
        ]  # fmt: skip

    @pytest.mark.parametrize("name", ["/rosout", "*/rosout", "/ros*"])
    def test_of_the_log_it_is_of_no_more_avail(self, cli: Cli, name: str) -> None:
        policy(listener=">words >rosout", bridge="<rosout")
        text = "nodes: {/listener: {source: [SpeechTranscript]}, /bridge: {leak: [PersonalData]}}"
        Path("s.yaml").write_text(f'labels: 1\nchannels: {{"{name}": mundane}}\n', "utf-8")
        assert code(cli, text, options=("--standard-channels", "s.yaml")) == 1

    def test_it_is_named_with_its_hash_and_names_that_match_nothing_are_told(self, cli: Cli) -> None:
        Path("s.yaml").write_text("labels: 1\nchannels:\n  /vid?o: mundane\n  /vidoe: mundane\n", "utf-8")
        options = [*labels("nodes: {/camera: {source: [Video]}, /uplink: conduit}"), "--standard-channels", "s.yaml"]
        done = cli("analyze", "p.xml", *options, "-v")
        digest = document(cli, *options)["assumptions"]["standard_channels"]["sha256"]
        assert f"   1 standard ROS channel taken as mundane by s.yaml (sha256 {digest[:12]})\n" in done.stdout
        assert "rosprivacy labels --standard" not in done.stdout
        assert "notice: s.yaml:4: '/vidoe' matches no topic or service or action of the policies" in done.stdout
        assert "matches no" not in cli("analyze", "p.xml", *labels(LABELS), "-v").stdout  # the shipped file


class TestEndsOfStatedFlows:
    """Rule S9."""

    CLOUD = "elements: {cloud: {kind: external-system, country: DE}}\n"
    TEXT = f"nodes: {{/camera: {{source: [Video]}}, /map: conduit}}\n{CLOUD}flows:\n  - {{from: %s, to: cloud}}"

    @pytest.fixture(autouse=True)
    def _a_node_and_a_topic_of_one_name(self, _camera_to_uplink: None) -> None:
        policy(camera=">map", map=">grid", other="!scan ?scan")

    @pytest.mark.parametrize(
        ("end", "words"),
        [
            ("/map", "1.yaml:5: a flow names '/map', which is a node and a topic; write {node: /map} or {topic: /map}"),
            ("{service: /map}", "1.yaml:5: a flow names the service '/map', which is not there; "),
            ("{leg: /map}", "1.yaml:5: "),
            ("{topic: cloud}", "1.yaml:5: "),
            ("{}", "1.yaml:5: "),
            ("{topic: /map, node: /map}", "1.yaml:5: "),
        ],
    )
    def test_an_end_that_names_not_just_one_is_an_error(self, cli: Cli, end: str, words: str) -> None:
        assert refused(cli("analyze", "p.xml", *labels(self.TEXT % end)))[0].startswith(words)

    @pytest.mark.parametrize(("end", "expected"), [("{topic: /map}", 1), ("{node: /map}", 4), ("{topic: '/m*'}", 1)])
    def test_unless_it_says_which(self, cli: Cli, end: str, expected: int) -> None:
        assert code(cli, self.TEXT % end) == expected

    def test_between_too(self, cli: Cli) -> None:
        ring = "elements: {ring: {kind: shared-memory, between: [/camera, %s]}}\nnodes: {/camera: {source: [Video]}}"
        assert "names '/map', which is a node and a topic; write {node: /map}" in problem(cli, ring % "/map")
        carries = document(cli, *labels(ring % "{node: /map}"))["carries"]
        assert {"robot": "", "kind": "node", "name": "/map"} in [row["element"] for row in carries]

    def test_in_a_fleet_file(self, cli: Cli) -> None:
        labels("nodes: {/camera: {source: [Video]}, /map: conduit}")
        fleet = f"fleet: 1\nrobots: {{a: {{policies: [p.xml], labels: [1.yaml]}}}}\n{self.CLOUD}flows:\n"
        Path("f.yaml").write_text(f"{fleet}  - {{from: '*:/map', to: cloud}}\n", "utf-8")
        (line,) = refused(cli("analyze", "--fleet", "f.yaml"))
        assert line.startswith("f.yaml:5: a flow names '*:/map', which is a node and a topic; write {node: '*:/map'}")
        Path("f.yaml").write_text(f"{fleet}  - {{from: {{topic: '*:/map'}}, to: cloud}}\n", "utf-8")
        assert cli("analyze", "--fleet", "f.yaml").returncode == 1


class TestASourceLimitedToChannels:
    """Rule S8: that restricts channels of ROS, not flows that a person states."""

    CLOUD = "elements: {cloud: {kind: external-system, country: DE}}\n"

    @pytest.mark.parametrize(("limit", "expected"), [("", 1), (", never: [Video]", 4), (", only: [Voice]", 4)])
    def test_it_sends_all_along_a_stated_flow_unless_that_says_otherwise(
        self, cli: Cli, limit: str, expected: int
    ) -> None:
        text = LIMITED.replace("{leak: [Video]}", "conduit") + self.CLOUD
        assert code(cli, f"{text}flows: [{{from: /camera, to: cloud{limit}}}]") == expected

    def test_and_into_shared_memory(self, cli: Cli) -> None:
        policy(camera=">video", uplink="<other")
        assert code(cli, LIMITED + "elements: {ring: {kind: shared-memory, between: [/camera, /uplink]}}") == 1


class TestStatementsOfOneKind:
    """Rule S7."""

    TEXT = "nodes: {/rec: {source: [FaceTemplate]}, /cloud: {leak: [Biometric]}}\nchannels:\n"

    @pytest.mark.parametrize(
        ("channel", "glob", "expected"),
        [
            # what `only` names no statement of lower rank takes away
            *(("{only: [FaceTemplate]}", glob, 1)
              for glob in ("mundane", "{never: [PersonalData]}", "{never: [Biometric]}", "{only: [Voice]}")),
            ("{never: [Biometric]}", "{only: [FaceTemplate]}", 0),  # a higher rank does
        ],
    )  # fmt: skip
    def test_of_only_and_never_the_higher_rank_decides(self, cli: Cli, channel: str, glob: str, expected: int) -> None:
        policy(rec=">face/vector", cloud="<face/vector")
        assert code(cli, f"{self.TEXT}  /face/vector: {channel}\n  /face/*: {glob}") == expected

    def test_a_node_that_ends_a_kind_and_makes_it_of_itself_is_an_error(self, cli: Cli) -> None:
        policy(camera=">video", n="<video >out", uplink="<out")
        text = (
            "nodes:\n  /camera: {source: [Video]}\n  /n:\n    sanitizer: {Video: drop}\n"
            "    derives: [{from: PersonalData, to: Video}]\n  /uplink: {leak: [Video]}"
        )
        words = "1.yaml:6: /n is derives Video from PersonalData for Video here and sanitizer (drop) at 1.yaml:5; "
        assert problem(cli, text).startswith(words)
