"""Leaks that labels lost without a word: each by the command, with exit code and the words that the reader sees.

Source: rules S7, S9 and S13.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import cli, refused

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

OWN = """
@prefix : <urn:example:own:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:Caption a skos:Concept ; rp:label "Caption" ; skos:broader rp:Video ; rp:dataType "{}" ;
    skos:prefLabel "caption"@en ; skos:definition "What is seen on a video."@en .
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def policy(**nodes: str) -> None:
    """Nodes with what they do: ``>topic`` publishes, ``<topic`` subscribes, ``?name`` requests, ``!name`` replies."""
    forms = {">": ("topic", "publish"), "<": ("topic", "subscribe"), "?": ("service", "request"),
             "!": ("service", "reply")}  # fmt: skip
    profiles = []
    for node, does in nodes.items():
        rules = [
            f'<{forms[rule[0]][0]}s {forms[rule[0]][1]}="ALLOW"><{forms[rule[0]][0]}>/{rule[1:]}</{forms[rule[0]][0]}>'
            f"</{forms[rule[0]][0]}s>"
            for rule in does.split()
        ]
        profiles.append(
            f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{"".join(rules)}</profile></profiles>'
            "</enclave>"
        )
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(profiles)}</enclaves></policy>', "utf-8")


def video() -> None:
    """The system of the review: camera -> /video -> uplink."""
    policy(camera=">video", uplink="<video")


def labels(*texts: str) -> list[str]:
    """Write label files 1.yaml, 2.yaml, …; return the options that name them."""
    options = []
    for number, text in enumerate(texts, 1):
        Path(f"{number}.yaml").write_text(f"labels: 1\n{text}\n", "utf-8")
        options += ["-l", f"{number}.yaml"]
    return options


def document(cli: Cli, *options: str) -> dict[str, Any]:
    made: dict[str, Any] = json.loads(cli("analyze", "p.xml", *options, "--format", "json1").stdout)
    return made


L = "nodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}"


def test_the_control_is_a_leak(cli: Cli) -> None:
    video()
    assert cli("analyze", "p.xml", *labels(L)).returncode == 1


class TestTakingAwayIsNeverSilent:
    """Rule S7."""

    GLOB = "nodes:\n  /camera: {source: [Video]}\n  /up*: {leak: [Video]}\nchannels: {/video: sensitive}"

    @pytest.mark.parametrize("conduit", ["conduit", "{conduit: [PersonalData]}", "{conduit: [Video]}"])
    @pytest.mark.parametrize("files", [1, 2])
    def test_a_conduit_takes_no_leak_away_whatever_the_ranks(self, cli: Cli, conduit: str, files: int) -> None:
        """One meaning of 'reviewed', bare, of all kinds or of this one; the message says what to write."""
        video()
        by_name = f"  /uplink: {conduit}"
        texts = [self.GLOB, f"nodes:\n{by_name}"] if files > 1 else [self.GLOB.replace("chan", f"{by_name}\nchan")]
        done = cli("analyze", "p.xml", *labels(*texts))
        assert done.returncode == 1
        (line,) = [line for line in done.stdout.splitlines() if "does not take away" in line]
        assert line.startswith(f"warning: {files}.yaml:{5 if files == 1 else 3}: /uplink: conduit ")
        assert line.endswith("the leak of Video at 1.yaml:4; if that is meant, write 'leak: none'")

    def test_beside_a_leak_of_one_kind_it_is_an_error(self, cli: Cli) -> None:
        video()
        refused(cli("analyze", "p.xml", *labels("nodes: {/uplink: {leak: [Video], conduit: [Video]}}")))

    @pytest.mark.parametrize("none", ["none", "{none: [Video]}", "{none: [PersonalData, Voice]}"])
    def test_none_takes_it_away_of_all_kinds_or_of_some(self, cli: Cli, none: str) -> None:
        video()
        done = cli("analyze", "p.xml", *labels(self.GLOB, f"nodes:\n  /uplink: {{leak: {none}, conduit: [Video]}}"))
        assert done.returncode == 0

    def test_of_another_kind_it_does_not_and_neither_at_one_rank(self, cli: Cli) -> None:
        video()
        other = labels(self.GLOB, "nodes: {/uplink: {leak: {none: [Voice]}}}")
        assert cli("analyze", "p.xml", *other).returncode == 1
        both = labels(L, "nodes: {/uplink: {leak: {none: [Video]}}}")
        assert "/uplink is leak: {none: [Video]} for Video here" in refused(cli("analyze", "p.xml", *both))[0]
        broader = labels(L, "nodes: {/uplink: {leak: none}}")
        assert cli("analyze", "p.xml", *broader).returncode == 1  # the leak is nearer

    def test_unless_it_says_so_by_name_and_then_it_is_a_warning_and_is_counted(self, cli: Cli) -> None:
        video()
        options = labels(self.GLOB, "nodes:\n  /uplink: {leak: none, conduit: [Video]}")
        done = cli("analyze", "p.xml", *options)
        assert done.returncode == 0
        assert "warning: 2.yaml:3: /uplink: leak: none takes away the leak of Video at 1.yaml:4" in done.stdout
        assert "   1 label of a source or leak is taken away by another label (see the warnings)" in done.stdout
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

    SOURCE = "nodes:\n  /cam*: {source: [Video]}\n  /uplink: {leak: [Video]}"

    def test_a_conduit_takes_no_source_away(self, cli: Cli) -> None:
        video()
        done = cli("analyze", "p.xml", *labels(self.SOURCE, "nodes:\n  /camera: conduit"))
        assert done.returncode == 1
        assert "; if that is meant, write 'source: none'" in done.stdout

    def test_a_sanitizer_of_what_the_node_brings_in_is_an_error_unless_the_source_ranks_higher(self, cli: Cli) -> None:
        video()
        (line,) = refused(
            cli("analyze", "p.xml", *labels(self.SOURCE, "nodes:\n  /camera: {sanitizer: {Video: drop}}"))
        )
        assert line == (
            "2.yaml:3: /camera is sanitizer (drop) for Video here and source at 1.yaml:3; "
            "keep one of them; 'source: none' takes a source back"
        )
        taken = "nodes:\n  /camera: {source: none, sanitizer: {Video: drop}}"
        done = cli("analyze", "p.xml", *labels(self.SOURCE, taken))
        assert "warning: 2.yaml:3: /camera: source: none takes away the source of Video at 1.yaml:3" in done.stdout
        higher = self.SOURCE.replace("/cam*", "/camera") + "\n  /cam*: {sanitizer: {Video: drop}}"
        assert cli("analyze", "p.xml", *labels(higher)).returncode == 1

    def test_a_source_is_taken_away_of_some_kinds(self, cli: Cli) -> None:
        policy(camera=">video >raw", uplink="<video <raw")
        text = "nodes:\n  /cam*: {source: [Video, Voice]}\n  /uplink: {leak: [PersonalData]}\n"
        none = "  /camera: {source: {none: [Video], Location: [/raw]}}"
        assert {f["category"] for f in document(cli, *labels(text + none))["findings"]} == {"Voice", "Location"}

    def test_a_source_that_is_named_for_less_than_a_glob_says_is_a_warning(self, cli: Cli) -> None:
        policy(camera=">video >raw", uplink="<raw")
        text = "nodes:\n  /cam*: {source: [Video]}\n  /camera: {source: {Video: [/video]}}"
        done = cli("analyze", "p.xml", *labels(text))
        assert "/camera: source through /video takes away the source of Video at 1.yaml:3" in done.stdout

    def test_a_leak_of_a_narrower_kind_is_not_outdone_by_a_name_for_a_broader_one(self, cli: Cli) -> None:
        video()
        text = 'nodes: {/camera: {source: [PersonalData]}, "/up*": {leak: [Video]}, /uplink: {conduit: [PersonalData]}}'
        done = cli("analyze", "p.xml", *labels(text))
        assert done.returncode == 1
        assert done.stdout.startswith("leak: ")

    def test_a_leak_that_still_holds_is_not_taken_away(self, cli: Cli) -> None:
        video()
        text = "nodes: {/camera: {source: [Video]}, '/u*': {leak: [Video]}, '/up*': conduit, /uplink: {leak: [Video]}}"
        done = cli("analyze", "p.xml", *labels(text))
        assert done.returncode == 1
        assert "taken away" not in done.stdout

    def test_a_robots_own_file_says_it_by_name_too(self, cli: Cli) -> None:
        video()
        labels(L, "nodes:\n  /uplink: conduit")
        fleet = (
            "fleet: 1\nmodels: {m: {policies: [p.xml], labels: [1.yaml]}}\nrobots: {a: {model: m, labels: [2.yaml]}}"
        )
        Path("f.yaml").write_text(fleet, "utf-8")
        done = cli("analyze", "--fleet", "f.yaml")
        assert done.returncode == 1
        assert "2.yaml:3: /uplink: conduit does not take away the leak of Video at 1.yaml:2; " in done.stdout
        labels(L, "nodes:\n  /uplink: {leak: none, conduit: [Video]}")
        done = cli("analyze", "--fleet", "f.yaml")
        assert done.returncode == 0
        assert "warning: 2.yaml:3: /uplink: leak: none takes away the leak of Video at 1.yaml:2" in done.stdout


class TestWhatASourceNamesAChannelFor:
    """Rule S7: no shipped statement and no glob takes it away, and a user's full name is an error."""

    @pytest.mark.parametrize("leg", ["!frame", "?frame"])
    def test_of_a_service_in_both_legs(self, cli: Cli, leg: str) -> None:
        """S2, S7: what goes back in the other leg is not taken away by a glob either."""
        other = "?" if leg[0] == "!" else "!"
        policy(cam=leg, client=f"{other}frame", cloud=leg)
        text = "nodes: {/cam: {source: {Video: [/frame]}}, /client: conduit, /cloud: {leak: [Video]}}\n"
        for more in ("", 'channels: {"/*": mundane}', 'channels: {"/*": {never: [Video]}}'):
            found = document(cli, *labels(text + more))
            assert [(f["source"]["name"], f["leak"]["name"]) for f in found["findings"]] == [("/cam", "/cloud")]
        refused(cli("analyze", "p.xml", *labels(text + "channels: {/frame: mundane}")))

    def test_a_standard_topic(self, cli: Cli) -> None:
        policy(camera=">rosout", uplink="<rosout")
        text = "nodes: {/camera: {source: {Voice: [/rosout]}}, /uplink: {leak: [Voice]}}"
        done = cli("analyze", "p.xml", *labels(text))
        assert done.returncode == 1
        assert "Voice: /camera -> /uplink" in done.stdout

    def test_a_standard_service_with_the_leg_that_the_source_writes(self, cli: Cli) -> None:
        policy(camera="?store/set_parameters", uplink="!store/set_parameters")
        text = "nodes: {{{}: {{source: {{Voice: [/store/set_parameters]}}}}, {}: {{leak: [Voice]}}}}"
        for source, leak in (("/camera", "/uplink"), ("/uplink", "/camera")):
            done = cli("analyze", "p.xml", *labels(text.format(source, leak)))
            assert done.returncode == 1
            assert f"Voice: {source} -> {leak}" in done.stdout

    @pytest.mark.parametrize("through", ["/video", "/vi*"])
    @pytest.mark.parametrize("label", ["mundane", "{never: [PersonalData]}", "{only: [Voice]}"])
    def test_a_glob_of_the_users(self, cli: Cli, through: str, label: str) -> None:
        video()
        text = f"nodes: {{/camera: {{source: {{Video: ['{through}']}}}}, /uplink: {{leak: [Video]}}}}"
        done = cli("analyze", "p.xml", *labels(f"{text}\nchannels: {{'/v*': {label}}}"))
        assert done.returncode == 1
        assert "Video: /camera -> /uplink" in done.stdout

    @pytest.mark.parametrize(
        ("label", "says"),
        [("mundane", "mundane"), ("{never: [Video]}", "never [Video]"), ("{only: [Voice]}", "only [Voice]")],
    )
    def test_a_full_name_of_the_users_is_an_error_with_both_lines(self, cli: Cli, label: str, says: str) -> None:
        video()
        text = "nodes:\n  /camera: {source: {Video: [/video]}}\n  /uplink: {leak: [Video]}\nchannels:\n"
        (line,) = refused(cli("analyze", "p.xml", *labels(f"{text}  /video: {label}")))
        assert line == (
            f"1.yaml:6: /video is {says} here, and the source at 1.yaml:3 names it for Video; keep one of them"
        )

    def test_a_flow_to_it_is_as_the_channel(self, cli: Cli) -> None:
        video()
        text = "nodes:\n  /camera: {source: {Video: [/video]}}\n  /uplink: {leak: [Video]}\nflows:\n"
        done = cli("analyze", "p.xml", *labels(f"{text}  - {{from: '/c*', to: /video, never: [Video]}}"))
        assert done.returncode == 1
        (line,) = refused(cli("analyze", "p.xml", *labels(f"{text}  - {{from: /camera, to: /video, never: [Video]}}")))
        assert line.startswith(
            "1.yaml:6: /video is never [Video] here, and the source at 1.yaml:3 names it for Video; "
        )

    def test_no_proposal_contradicts_it(self, cli: Cli) -> None:
        """A review of the channel would; a filter behind the source does not."""
        video()
        options = labels("nodes: {/camera: {source: {Video: [/video]}}, /uplink: {leak: [Video]}}")
        done = cli("mitigate", "p.xml", *options, "--by", "review")
        assert "Traceback" not in done.stderr
        assert "review /video" not in done.stdout
        done = cli("mitigate", "p.xml", *options, "--by", "filter")
        assert "filter" in done.stdout
        assert "no-leak-found" in done.stdout or "undetermined" in done.stdout

    def test_a_wildcard_that_it_writes_and_the_channel_that_is_read(self, cli: Cli) -> None:
        policy(camera=">v*", uplink="<video")
        text = "nodes: {/camera: {source: {Video: ['/v*']}}, /uplink: {leak: [Video]}}\nchannels: {'/v*': mundane}"
        assert cli("analyze", "p.xml", *labels(text)).returncode == 1

    def test_another_kind_is_still_kept_out(self, cli: Cli) -> None:
        video()
        text = "nodes: {/camera: {source: {Video: [/video], Voice: [/video]}}, /uplink: {leak: [Voice]}}"
        channels = "channels: {'/v*': {never: [Location]}}"
        assert cli("analyze", "p.xml", *labels(f"{text}\n{channels}")).returncode == 1
        other = text.replace("Voice: [/video]", "Location: [/video]").replace("leak: [Voice]", "leak: [Health]")
        assert cli("analyze", "p.xml", *labels(f"{other}\n{channels}")).returncode == 4

    def test_a_name_that_only_ends_like_a_standard_channel(self, cli: Cli) -> None:
        """It is told by name, and so is a glob that does not count."""
        policy(camera=">patient/clock", uplink="<patient/clock")
        text = "nodes: {/camera: {source: [Voice]}, /uplink: {leak: [Voice]}}"
        done = cli("analyze", "p.xml", *labels(text))
        assert done.returncode == 4  # the data of no source goes anywhere else
        assert "   data gets to 1 of them and stops there: /patient/clock (Voice)\n" in done.stdout
        options = labels(f"{text}\nchannels: {{'/patient/*': sensitive}}")
        done = cli("analyze", "p.xml", *options)
        assert done.returncode == 4
        assert "   of 1 of them a glob says otherwise, which does not count: /patient/clock; name them" in done.stdout
        channel = {"robot": "", "kind": "topic", "name": "/patient/clock"}
        assumed = document(cli, *options)["assumptions"]
        (reached,) = assumed["standard_channels_reached"]
        assert (reached["element"], reached["categories"]) == (channel, ["Voice"])
        assert reached["keeps_from"]["name"] == "/uplink"
        assert assumed["standard_channels_unchanged"] == [channel]

    @pytest.mark.parametrize("name", ["/patient/clock", "*/clock", "/p*/clock"])
    def test_a_full_name_or_a_glob_with_its_end_written_out_outranks_the_standard_file(
        self, cli: Cli, name: str
    ) -> None:
        policy(camera=">patient/clock", uplink="<patient/clock")
        text = "nodes: {/camera: {source: [Voice]}, /uplink: {leak: [Voice]}}"
        assert cli("analyze", "p.xml", *labels(f"{text}\nchannels: {{'{name}': sensitive}}")).returncode == 1

    def test_the_infrastructure_file_yields_to_every_glob(self, cli: Cli) -> None:
        policy(camera=">tf_static", uplink="<tf_static")
        text = "nodes: {/camera: {source: [Voice]}, /uplink: {leak: [Voice]}}\nchannels: {'/*': sensitive}"
        assert cli("analyze", "p.xml", *labels(text), "-l", "rosprivacy:infrastructure").returncode == 1


class TestTheLogIsText:
    """Rule S13: ``rosout`` ends a kind only if neither it nor a narrower one is text or an identifier."""

    @pytest.mark.parametrize("kind", ["SpeechTranscript", "PersonName", "PostalAddress", "Location", "PersonalData"])
    @pytest.mark.parametrize("topic", ["rosout", "ward/rosout"])
    def test_what_can_be_said_in_words_passes(self, cli: Cli, kind: str, topic: str) -> None:
        policy(listener=f">words >{topic}", bridge=f"<{topic}")
        text = f"nodes: {{/listener: {{source: [{kind}]}}, /bridge: {{leak: [PersonalData]}}}}"
        assert cli("analyze", "p.xml", *labels(text)).returncode == 1
        own = f"{text}\nchannels: {{/{topic}: mundane, /words: sensitive}}"
        assert cli("analyze", "p.xml", *labels(own)).returncode == 0

    @pytest.mark.parametrize("kind", ["Video", "Voice", "FaceTemplate"])
    def test_a_picture_or_a_sound_does_not(self, cli: Cli, kind: str) -> None:
        policy(camera=">video >rosout", bridge="<rosout")
        text = f"nodes: {{/camera: {{source: [{kind}]}}, /bridge: {{leak: [PersonalData]}}}}\n"
        assert document(cli, *labels(f"{text}channels: {{/video: sensitive}}"))["findings"] == []

    def test_a_kind_of_a_users_own_is_what_its_file_says(self, cli: Cli) -> None:
        policy(camera=">video >rosout", bridge="<rosout")
        text = "nodes: {/camera: {source: [Caption]}, /bridge: {leak: [PersonalData]}}\nchannels: {/video: sensitive}"
        for form, code in (("text", 1), ("video", 0)):
            Path("own.ttl").write_text(OWN.format(form), "utf-8")
            assert cli("analyze", "p.xml", *labels(text), "--ontology", "own.ttl").returncode == code

    def test_a_file_that_replaces_the_standard_one_is_of_no_more_avail(self, cli: Cli) -> None:
        policy(listener=">words >rosout", bridge="<rosout")
        text = "nodes: {/listener: {source: [SpeechTranscript]}, /bridge: {leak: [PersonalData]}}"
        for name in ("/rosout", "*/rosout", "/ros*"):
            Path("s.yaml").write_text(f'labels: 1\nchannels: {{"{name}": mundane}}\n', "utf-8")
            assert cli("analyze", "p.xml", *labels(text), "--standard-channels", "s.yaml").returncode == 1


class TestAFileThatReplacesTheStandardOne:
    """Rule S13."""

    def test_it_says_that_channels_are_mundane_and_nothing_else(self, cli: Cli) -> None:
        video()
        Path("s.yaml").write_text(
            "labels: 1\nnodes:\n  /up*: {sanitizer: {Video: drop}}\nchannels:\n  '/*': mundane\n  /video: sensitive\n"
            "flows: [{from: /video, to: /uplink, never: [Video]}]\nlimits: {Video: P1D}\n",
            "utf-8",
        )
        lines = refused(cli("analyze", "p.xml", *labels(L), "--standard-channels", "s.yaml"))
        hint = "; write channels: {/name: mundane} only; other labels go into a file for --labels"
        assert lines == [
            f"s.yaml:2: nodes in a file of standard channels{hint}",
            f"s.yaml:6: '/video' is sensitive in a file of standard channels{hint}",
            f"s.yaml:7: flows in a file of standard channels{hint}",
            f"s.yaml:8: limits in a file of standard channels{hint}",
        ]

    def test_it_is_named_with_its_hash_and_names_that_match_nothing_are_told(self, cli: Cli) -> None:
        video()
        Path("s.yaml").write_text("labels: 1\nchannels:\n  /vid?o: mundane\n  /vidoe: mundane\n", "utf-8")
        options = [*labels("nodes: {/camera: {source: [Video]}, /uplink: conduit}"), "--standard-channels", "s.yaml"]
        done = cli("analyze", "p.xml", *options, "-v")
        digest = document(cli, *options)["assumptions"]["standard_channels"]["sha256"]
        assert f"   1 standard ROS channel taken as mundane by s.yaml (sha256 {digest[:12]})\n" in done.stdout
        assert "rosprivacy labels --standard" not in done.stdout
        assert "   data gets to 1 of them and stops there: /video (Video)\n" in done.stdout
        assert "notice: s.yaml:4: '/vidoe' matches no topic or service or action of the policies" in done.stdout

    def test_the_shipped_file_names_what_is_not_there_without_a_word(self, cli: Cli) -> None:
        video()
        assert "matches no" not in cli("analyze", "p.xml", *labels(L), "-v").stdout


class TestEndsOfStatedFlows:
    """Case 8, rule S9."""

    CLOUD = "elements: {cloud: {kind: external-system, country: DE}}\n"
    LABELS = f"nodes: {{/camera: {{source: [Video]}}, /map: conduit}}\n{CLOUD}flows:\n  - {{from: %s, to: cloud}}"

    @pytest.fixture(autouse=True)
    def _maps(self, _folder: None) -> None:
        policy(camera=">map", map=">grid", other="!scan ?scan")

    def test_an_end_that_names_a_node_and_a_channel_is_an_error(self, cli: Cli) -> None:
        (line,) = refused(cli("analyze", "p.xml", *labels(self.LABELS % "/map")))
        assert line == (
            "1.yaml:5: a flow names '/map', which is a node and a topic; write {node: /map} or {topic: /map}"
        )

    @pytest.mark.parametrize(("end", "code"), [("{topic: /map}", 1), ("{node: /map}", 4), ("{topic: '/m*'}", 1)])
    def test_unless_it_says_which(self, cli: Cli, end: str, code: int) -> None:
        done = cli("analyze", "p.xml", *labels(self.LABELS % end))
        assert done.returncode == code, done.stdout

    def test_what_is_named_so_must_be_there(self, cli: Cli) -> None:
        (line,) = refused(cli("analyze", "p.xml", *labels(self.LABELS % "{service: /map}")))
        assert line.startswith("1.yaml:5: a flow names the service '/map', which is not there; ")

    @pytest.mark.parametrize("end", ["{leg: /map}", "{topic: cloud}", "{}", "{topic: /map, node: /map}"])
    def test_other_words_are_errors(self, cli: Cli, end: str) -> None:
        lines = refused(cli("analyze", "p.xml", *labels(self.LABELS % end)))
        assert lines[0].startswith("1.yaml:5: ")

    def test_between_too(self, cli: Cli) -> None:
        ring = "elements: {ring: {kind: shared-memory, between: [/camera, %s]}}\nnodes: {/camera: {source: [Video]}}"
        (line,) = refused(cli("analyze", "p.xml", *labels(ring % "/map")))
        assert "names '/map', which is a node and a topic; write {node: /map} or {topic: /map}" in line
        document = cli("analyze", "p.xml", *labels(ring % "{node: /map}"), "--format", "json1").stdout
        assert {"robot": "", "kind": "node", "name": "/map"} in [
            row["element"] for row in json.loads(document)["carries"]
        ]

    def test_in_a_fleet_file(self, cli: Cli) -> None:
        labels("nodes: {/camera: {source: [Video]}, /map: conduit}")
        fleet = (
            "fleet: 1\nrobots: {a: {policies: [p.xml], labels: [1.yaml]}}\n"
            "elements: {cloud: {kind: external-system, country: DE}}\nflows:\n  - {from: %s, to: cloud}\n"
        )
        Path("f.yaml").write_text(fleet % "'*:/map'", "utf-8")
        (line,) = refused(cli("analyze", "--fleet", "f.yaml"))
        assert line == (
            "f.yaml:5: a flow names '*:/map', which is a node and a topic; write {node: '*:/map'} or {topic: '*:/map'}"
        )
        Path("f.yaml").write_text(fleet % "{topic: '*:/map'}", "utf-8")
        assert cli("analyze", "--fleet", "f.yaml").returncode == 1


class TestASourceLimitedToChannels:
    """Case 9, rule S8: that restricts channels of ROS, not flows that a person states."""

    SOURCE = "nodes: {/camera: {source: {Video: [/video]}}, /uplink: conduit}\n"
    CLOUD = "elements: {cloud: {kind: external-system, country: DE}}\n"

    def test_it_sends_all_along_a_stated_flow(self, cli: Cli) -> None:
        video()
        text = f"{self.SOURCE}{self.CLOUD}flows: [{{from: /camera, to: cloud}}]"
        done = cli("analyze", "p.xml", *labels(text))
        assert done.returncode == 1
        assert "Video: /camera -> cloud" in done.stdout

    @pytest.mark.parametrize("limit", ["never: [Video]", "only: [Voice]"])
    def test_unless_that_flow_says_otherwise(self, cli: Cli, limit: str) -> None:
        video()
        text = f"{self.SOURCE}{self.CLOUD}flows: [{{from: /camera, to: cloud, {limit}}}]"
        assert cli("analyze", "p.xml", *labels(text)).returncode == 4

    def test_and_into_shared_memory(self, cli: Cli) -> None:
        policy(camera=">video", uplink="<other")
        text = (
            "nodes: {/camera: {source: {Video: [/video]}}, /uplink: {leak: [Video]}}\n"
            "elements: {ring: {kind: shared-memory, between: [/camera, /uplink]}}"
        )
        assert cli("analyze", "p.xml", *labels(text)).returncode == 1


class TestStatementsOfOneKind:
    """D3 and D6, rule S7."""

    TEXT = "nodes: {/rec: {source: [FaceTemplate]}, /cloud: {leak: [Biometric]}}\nchannels:\n"

    @pytest.mark.parametrize("glob", ["mundane", "{never: [PersonalData]}", "{never: [Biometric]}", "{only: [Voice]}"])
    def test_what_only_names_no_statement_of_lower_rank_takes_away(self, cli: Cli, glob: str) -> None:
        policy(rec=">face/vector", cloud="<face/vector")
        text = f"{self.TEXT}  /face/vector: {{only: [FaceTemplate]}}\n  /face/*: {glob}"
        assert cli("analyze", "p.xml", *labels(text)).returncode == 1

    def test_a_higher_rank_takes_away_what_only_names(self, cli: Cli) -> None:
        policy(rec=">face/vector", cloud="<face/vector")
        text = f"{self.TEXT}  /face/*: {{only: [FaceTemplate]}}\n  /face/vector: {{never: [Biometric]}}"
        assert cli("analyze", "p.xml", *labels(text)).returncode == 0

    def test_only_and_never_of_one_kind_in_one_entry_are_an_error(self, cli: Cli) -> None:
        video()
        text = "channels:\n  /video: {only: [Video], never: [Video]}"
        assert refused(cli("analyze", "p.xml", *labels(text))) == [
            "1.yaml:3: Video is under only and under never; name it under one of them"
        ]

    def test_a_node_that_ends_a_kind_and_makes_it_of_itself_is_an_error(self, cli: Cli) -> None:
        policy(camera=">video", n="<video >out", uplink="<out")
        text = (
            "nodes:\n  /camera: {source: [Video]}\n  /n:\n    sanitizer: {Video: drop}\n"
            "    derives: [{from: PersonalData, to: Video}]\n  /uplink: {leak: [Video]}"
        )
        (line,) = refused(cli("analyze", "p.xml", *labels(text)))
        assert line == (
            "1.yaml:6: /n is derives Video from PersonalData for Video here and sanitizer (drop) at 1.yaml:5; "
            "keep one of them, or make one more specific"
        )
