"""``rosprivacy mitigate`` as people call it: the paper's factory, limits, patches, what it says where nothing helps."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.analysis.mitigation.limits import Weights
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.command import XI, Cli, refused
from tests.helpers.factory import BEFORE, FACTORY, RUN3
from tests.helpers.fleet_files import policy as short_policy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

SCHEMA = json.loads((ROOT / "docs" / "mitigation.schema.json").read_text("utf-8"))
Draft202012Validator.check_schema(SCHEMA)


def proposals(cli: Cli, *arguments: str | Path, cwd: Path | None = None) -> Any:
    document = json.loads(cli("mitigate", *arguments, "--format", "json", cwd=cwd).stdout)
    Draft202012Validator(SCHEMA).validate(document)
    return document


def step_of(step: dict[str, Any]) -> tuple[Any, ...]:
    if step["kind"] == "review":
        return ("review", step["channel"]["kind"], step["channel"]["name"])
    if step["kind"] == "filter":
        return ("filter", *((one["from"]["name"], one["to"]["name"]) for one in step["between"]))
    return ("deny", *((line["role"], line["name"], line["line"]) for line in step["policy"]))


def test_the_factory_gets_the_papers_two_changes(cli: Cli) -> None:
    """The paper, II-C: a filter behind safety video, for the archive only, and a review of save footage."""
    report = proposals(cli, BEFORE, "-l", RUN3)
    (proposal,) = report["proposals"]
    assert [step_of(step) for step in proposal["steps"]] == [
        ("review", "service", "/save_footage"),
        ("filter", ("/safety_video", "/archive_server")),
    ]
    review, filter_ = proposal["steps"]
    assert review["categories"] == filter_["categories"] == ["Video"]
    assert [line["line"] for line in filter_["policy"]] == [14]
    assert [one["name"] for one in filter_["reaches"]] == ["/archive_server"]
    assert [one["name"] for one in filter_["spares"]] == ["/emergency_stop"]
    assert proposal["proven"]
    assert proposal["cheapest"]
    assert proposal["verdict_then"] == "no-leak-found"
    assert [less["element"]["name"] for less in proposal["affected"]] == ["/archive_server"]


def test_storages_and_transfers_can_be_cut_off_or_stated(cli: Cli, tmp_path: Path) -> None:
    """Rule S10: their ways go on from leaks, so the filter before the leak alone does not do."""
    labels = tmp_path / "l.yaml"
    labels.write_text(
        "labels: 1\nnodes: {/safety_camera: {source: [Video]}, /archive_server: {leak: [Video]}}\n"
        "elements:\n  tapes: {kind: storage, country: US, retention: P2Y}\nlimits: {Video: P30D}\n"
        "flows: [{from: /archive_server, to: tapes}]\n",
        "utf-8",
    )
    (proposal,) = proposals(cli, BEFORE, "-l", labels)["proposals"]
    assert proposal["proven"]
    assert len(proposal["removes"]) == 3
    assert [(s["kind"], s["element"]["name"]) for s in proposal["statements"]] == [
        ("storage-limitation", "tapes"),
        ("third-country-transfer", "tapes"),
    ]


def test_what_weighs_most_is_proposed_first_and_a_proof_tells_what_stays(cli: Cli, tmp_path: Path) -> None:
    """In the order of findings; that findings of other kinds stay is no failure of the proof."""
    labels = tmp_path / "l.yaml"
    labels.write_text(
        "labels: 1\nnodes:\n  /safety_camera: {source: [Video, HomeMap, Voice]}\n"
        "  /archive_server: {leak: [PersonalData]}\n",
        "utf-8",
    )
    found = proposals(cli, BEFORE, "-l", labels)["proposals"]
    assert [proposal["categories"] for proposal in found] == [
        ["Video"], ["Voice"], ["HomeMap"], ["HomeMap", "Video", "Voice"],
    ]  # fmt: skip
    assert [proposal["verdict_then"] for proposal in found][:3] == ["leak"] * 3
    text = cli("mitigate", BEFORE, "-l", labels).stdout
    assert text.count("findings of other kinds stay") == 3
    assert "verdict is then leak" not in text


def test_the_proof_knows_of_storages(cli: Cli, tmp_path: Path) -> None:
    """The proposal for one kind of data says what the verdict is while another is kept too long."""
    labels = tmp_path / "l.yaml"
    labels.write_text(
        "labels: 1\nnodes: {/safety_camera: {source: [Video]}, /archive_server: {leak: [Video], source: [Voice]}}\n"
        "elements:\n  tapes: {kind: storage, country: DE}\n"
        "flows: [{from: /archive_server, to: tapes, never: [Video]}]\n",
        "utf-8",
    )
    found = proposals(cli, BEFORE, "-l", labels)["proposals"]
    assert {proposal["categories"][0]: proposal["verdict_then"] for proposal in found[:2]}["Video"] == "leak"
    assert found[-1]["verdict_then"] != "leak"


def test_the_label_that_is_printed_closes_the_way(cli: Cli, tmp_path: Path) -> None:
    report = proposals(cli, BEFORE, "-l", RUN3)
    review, _ = report["proposals"][0]["steps"]
    answer = tmp_path / "answer.yaml"
    answer.write_text(yaml.safe_dump({"labels": 1, **review["label"]}))
    (proposal,) = proposals(cli, BEFORE, "-l", RUN3, "-l", answer)["proposals"]
    assert [step_of(step) for step in proposal["steps"]] == [("filter", ("/safety_video", "/archive_server"))]


REVIEW_OR_FILTER = ("--by", "review", "--by", "filter")
AT_THE_CAMERA = [("filter", ("/safety_camera", "/safety_video"))]


def limits(folder: Path, text: str) -> Path:
    file = folder / "limits.yaml"
    file.write_text(text)
    return file


def test_a_time_critical_node_is_named_and_spared(cli: Cli, tmp_path: Path) -> None:
    file = limits(tmp_path, "limits: 1\ntime_critical: [/emergency_stop]\n")
    (proposal,) = proposals(cli, BEFORE, "-l", RUN3, "--limits", file, "--by", "filter")["proposals"]
    assert ("filter", ("/save_footage", "/archive_server")) in [step_of(step) for step in proposal["steps"]]
    assert {element["name"] for step in proposal["steps"] for element in step["reaches"]} == {"/archive_server"}
    done = cli("mitigate", BEFORE, "-l", RUN3, "--limits", file, "--by", "filter")
    assert "/emergency_stop (time-critical)" in done.stdout


@pytest.mark.parametrize(
    "text",
    [
        "weights: {review: 100, filter: 2, node: 1}",  # a review that is dear, a node that is not
        "places: [{at: /save_footage, never: all}]",
        "places: [{at: /save_footage, factor: 50}]",
    ],
)
def test_limits_decide_what_is_proposed(cli: Cli, tmp_path: Path, text: str) -> None:
    file = limits(tmp_path, f"limits: 1\n{text}\n")
    (proposal,) = proposals(cli, BEFORE, "-l", RUN3, "--limits", file, *REVIEW_OR_FILTER)["proposals"]
    assert [step_of(step) for step in proposal["steps"]] == AT_THE_CAMERA
    assert proposal["proven"]


@pytest.mark.parametrize(
    "text",
    [
        "places: [{from: /safety_video, to: /archive_server, never: [filter]}]\ntime_critical: [/emergency_stop]",
        "places: [{at: /archive_server, never: all}, {at: /safety_video, never: filter}]",
    ],
)
def test_where_nothing_may_be_changed_on_a_way_that_is_named(cli: Cli, tmp_path: Path, text: str) -> None:
    file = limits(tmp_path, f"limits: 1\n{text}\n")
    done = cli("mitigate", BEFORE, "-l", RUN3, "--limits", file, *REVIEW_OR_FILTER, "-f", "json")
    (proposal,) = json.loads(done.stdout)["proposals"]
    assert (done.returncode, proposal["steps"]) == (1, [])
    (way,) = proposal["keeps"]
    assert (way["reason"], way["way"][0]["name"], way["way"][-1]["name"]) == (
        "not-allowed", "/safety_camera", "/archive_server",
    )  # fmt: skip


def test_limits_of_two_kinds_of_change_are_held_together(cli: Cli, tmp_path: Path) -> None:
    text = "places: [{at: '/save*', never: [review]}, {at: /safety_camera, never: [filter]}]\nweights: {deny: 1000}"
    file = limits(tmp_path, f"limits: 1\n{text}\n")
    (proposal,) = proposals(cli, BEFORE, "-l", RUN3, "--limits", file, *REVIEW_OR_FILTER)["proposals"]
    assert (len(proposal["steps"]), proposal["proven"]) == (2, True)


@pytest.mark.parametrize(
    ("text", "problems"),
    [
        ("limits: 2", ["1: limits format '2'"]),
        ("time_critical: []", ["1: no 'limits: 1'"]),
        ("[]", ["1: a limits file is a map, not a list"]),
        ("limits: 1\ntime_critical: [/safety_video]", ["2: '/safety_video' is a topic"]),
        ("limits: 1\ntime_critical: [3]", ["2: a number where an element is named"]),
        ("limits: 1\nweights: {filter: 0}", ["2: filter is '0'"]),
        ("limits: 1\nweights: {filter: yes}", ["2: filter is 'yes'"]),
        ("limits: 1\nweights: {node: 99999999999999999999}", ["2: node is '99999999999999999999'"]),
        ("limits: 1\nweights: {fliter: 3}", ["2: unknown key 'fliter'; did you mean 'filter'?"]),
        ("limits: 1\nplaces: [{at: /a, from: /b, never: all}]", ["2: a place needs at, or from and to"]),
        ("limits: 1\nplaces: [{at: /new_pose, never: [cut]}]", ["2: 'cut' is not a kind of change"]),
        ("limits: 1\nplaces: [{at: /new_pose}]", ["2: a place without never or factor says nothing"]),
        (
            "limits: 1\nplaces: [{from: /new_pose, to: /safety_camera, never: all}]",
            ["2: no flow goes from"],
        ),
        ("limits: 1\nplaces: [/a]", ["2: a place is a map, not a text"]),
        ("limits: 1\nplaces: /a", ["2: places takes a list, not a text"]),
        (
            "limits: 2\nfoo: 1\ntime_critical: [/emergency_stp]\nplaces: [{at: /y, never: all}]",
            ["1: limits format", "2: unknown key", "3: '/emergency_stp' matches no element", "4: '/y' matches"],
        ),
    ],
)
def test_bad_limits_are_refused_with_all_their_lines(cli: Cli, tmp_path: Path, text: str, problems: list[str]) -> None:
    file = limits(tmp_path, text)
    lines = refused(cli("mitigate", BEFORE, "-l", RUN3, "--limits", file))
    assert len(lines) == len(problems)
    assert all(line.startswith(f"{file}:{problem}") for line, problem in zip(lines, problems, strict=True)), lines


# ---------------------------------------------------------------- DENY and patches


PATCH = shutil.which("patch")


def patched(folder: Path, diff: Path) -> None:
    """Apply a unified diff as people do."""
    if PATCH is None:
        pytest.skip("NO patch PROGRAM: whether patches apply was not tested")
    command = [PATCH, "-p1", "--batch", "--binary"]
    applied = subprocess.run(command, cwd=folder, input=diff.read_bytes(), capture_output=True, check=False)
    assert applied.returncode == 0, (applied.stdout, applied.stderr, diff.read_text("utf-8"))


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_a_patch_applies_and_removes_the_finding(cli: Cli, tmp_path: Path, view: str) -> None:
    for file in FACTORY.iterdir():
        shutil.copy(file, tmp_path / file.name)
    arguments = ("before.policy.xml", "-l", "run3.labels.yaml", "--view", view)
    assert cli("analyze", *arguments, cwd=tmp_path).returncode == 1
    done = cli("mitigate", *arguments, "--by", "deny", "--patch", "fix.diff", cwd=tmp_path)
    assert done.returncode == 0
    patched(tmp_path, tmp_path / "fix.diff")
    left = {"declared": 0, "enforced": 4}  # there more is open
    assert cli("analyze", *arguments, cwd=tmp_path).returncode == left[view]


def test_who_can_no_longer_read_in_the_enclave_is_named(cli: Cli, tmp_path: Path) -> None:
    """Rule S5: a DENY for the archive is one for the emergency stop, which stands in the same enclave."""
    file = limits(tmp_path, "limits: 1\nplaces: [{at: /safety_camera, never: all}]\n")
    (proposal,) = proposals(cli, BEFORE, "-l", RUN3, "--by", "deny", "--limits", file)["proposals"]
    assert ("deny", ("subscribe", "/safety_video", 14)) in [step_of(step) for step in proposal["steps"]]
    cut_off = {
        less["element"]["name"] for less in proposal["affected"] if {"name": "/safety_video"}.items() & less.items() or
        any(one["name"] == "/safety_video" for one in less["unread"])
    }  # fmt: skip
    assert cut_off == {"/archive_server", "/emergency_stop"}


def policy(profiles: str, *, enclave: str = "/e") -> str:
    body = f"<enclave path='{enclave}'><profiles>\n{profiles}\n</profiles></enclave>"
    return f"<policy version='0.2.0' {XI}><enclaves>{body}</enclaves></policy>"


CAMERA = "<profile ns='/' node='camera'>\n<topics publish='ALLOW'><topic>video</topic></topics>\n</profile>"


CLOUD = "<profile ns='/' node='cloud'>{}</profile>"
NAMES = "<topics subscribe='ALLOW'>{}<topic>video</topic>{}</topics>"
SHAPES = {
    "one name to a group": CLOUD.format(NAMES.format("", "")),
    "all on one line": CLOUD.format(NAMES.format("<topic>pose</topic>", "")),
    "lines of their own": CLOUD.format(NAMES.format("\n  <topic>pose</topic>\n  ", "\n")),
    "two roles in a group": CLOUD.format(NAMES.format("", "").replace("<topics", "<topics publish='ALLOW'")),
    "a comment between": CLOUD.format(
        "<!-- > <topic>video</topic> -->\n" + NAMES.format("\n<!-- why -->", "<!-- here -->\n<topic>pose</topic>")
    ),
    "names with characters that XML escapes": CLOUD.format(NAMES.format("<topic>pose&amp;&lt;</topic>", "")),
    "a line that is included": "\n".join(
        f"<profile ns='/' node='{node}'>\n<xi:include href='inner.xml' xpointer='xpointer(/profile/*)'/>\n</profile>"
        for node in ("cloud", "other")
    ),
    "a profile that is included": "<xi:include href='inner.xml' xpointer='xpointer(/profiles/*)'/>",
    "Windows line ends": CLOUD.format(NAMES.format("\r\n  <topic>pose</topic>\r\n  ", "\r\n")),
}
INNER = {
    "a line that is included": "<profile>\n<topics subscribe='ALLOW'>\n<topic>/video</topic>\n<topic>/pose</topic>\n"
    "</topics>\n</profile>",
    "a profile that is included": f"<profiles>\n{CLOUD.format(NAMES.format('', ''))}\n</profiles>",
}
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /cloud: {leak: [Video]}}\n"


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_a_patch_fits_the_way_a_policy_is_written(cli: Cli, tmp_path: Path, shape: str) -> None:
    file, diff = tmp_path / "p.xml", tmp_path / "fix.diff"
    (tmp_path / "inner.xml").write_text(INNER.get(shape, "<profile/>"))
    file.write_bytes(policy(f"{CAMERA}\n{SHAPES[shape]}").encode())
    (tmp_path / "l.yaml").write_text(LABELS)
    limited = limits(tmp_path, "limits: 1\nplaces: [{at: /camera, never: all}]\n")
    done = cli("mitigate", "p.xml", "-l", "l.yaml", "--by", "deny", "--patch", diff, "--limits", limited, cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    assert "no patch:" not in done.stdout, done.stdout
    before = set(read_policy(str(file)).grants)
    patched(tmp_path, diff)
    after = read_policy(str(file)).grants
    denied = {(grant.role, grant.name, grant.node) for grant in after if not grant.allow}
    assert denied == {("subscribe", "/video", "/cloud")}
    allowed = {(g.role, g.name, g.node) for g in after if g.allow}
    assert allowed | denied == {(g.role, g.name, g.node) for g in before}
    assert cli("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path).returncode == 4  # no leak, /video unreviewed


def test_where_no_patch_can_be_made_it_says_so(cli: Cli, tmp_path: Path) -> None:
    """A file that is not UTF-8; the proposal stands."""
    text = policy(f"{CAMERA}\n<!-- é -->\n{SHAPES['one name to a group']}")
    (tmp_path / "p.xml").write_bytes(f"<?xml version='1.0' encoding='iso-8859-1'?>{text}".encode("iso-8859-1"))
    (tmp_path / "l.yaml").write_text(LABELS)
    report = proposals(cli, "p.xml", "-l", "l.yaml", "--by", "deny", cwd=tmp_path)
    assert report["patch"] == ""
    assert report["why_no_patch"].startswith("p.xml: ")
    assert report["proposals"][0]["proven"]


def test_a_saved_graph_opens_no_file_that_it_names(cli: Cli, tmp_path: Path) -> None:
    """In an earlier version what a stranger's graph calls its policy is opened, and lines of it stand in the patch."""
    arguments = ("-l", RUN3, "--by", "deny", "-f", "json")
    done = cli("analyze", BEFORE, "--save-graph", "g.json", "-q", "--fail-on", "never", cwd=tmp_path)
    assert done.returncode == 0
    assert json.loads(cli("mitigate", BEFORE, *arguments, cwd=tmp_path).stdout)["patch"]
    report = json.loads(cli("mitigate", "--add", "g.json", *arguments, cwd=tmp_path).stdout)
    assert report["patch"] == ""
    assert report["why_no_patch"].endswith(": read from a saved graph; name the policies for a patch")


def test_labels_that_a_patch_leaves_without_an_element_are_named(cli: Cli, tmp_path: Path) -> None:
    wildcard = "<profile ns='/' node='cloud'><topics subscribe='ALLOW'><topic>vid*</topic></topics></profile>"
    (tmp_path / "p.xml").write_text(policy(f"{CAMERA}\n{wildcard}"))
    (tmp_path / "l.yaml").write_text(f"{LABELS}flows: [{{from: '/vid*', to: /cloud, never: [Voice]}}]\n")
    limited = limits(tmp_path, "limits: 1\nplaces: [{at: /camera, never: all}]\n")
    report = proposals(cli, "p.xml", "-l", "l.yaml", "--by", "deny", "--limits", limited, cwd=tmp_path)
    (line,) = report["labels_without_element"]
    assert line.startswith("l.yaml:3: no flow goes from '/vid*'")


# ---------------------------------------------------------------- where nothing helps, and hostile input


def test_a_source_that_is_a_leak_itself_needs_another_role(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy(CAMERA))
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video], leak: [Video]}}\n")
    done = cli("mitigate", "p.xml", "-l", "l.yaml", cwd=tmp_path)
    assert done.returncode == 1
    assert "Stays: Video at /camera: it is source and leak, so there is no way to cut; only another role helps" in (
        done.stdout
    )


def test_a_filter_is_not_proposed_where_a_wildcard_reads_past_it(cli: Cli, tmp_path: Path) -> None:
    """A leak that may read everything would read what a filter before the topic reads; only at the leak it helps."""
    logger = "<profile ns='/' node='logger'><topics subscribe='ALLOW'><topic>/*</topic></topics></profile>"
    (tmp_path / "p.xml").write_text(policy(f"{CAMERA}\n{logger}"))
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video]}, /logger: {leak: [Video]}}\n")
    arguments = ("p.xml", "-l", "l.yaml", "--by", "filter")
    (proposal,) = proposals(cli, *arguments, cwd=tmp_path)["proposals"]
    assert [step_of(step) for step in proposal["steps"]] == [("filter", ("/*", "/logger"))]
    limited = limits(tmp_path, "limits: 1\nplaces: [{at: /logger, never: all}]\n")
    done = cli("mitigate", *arguments, "--limits", limited, cwd=tmp_path)
    assert done.returncode == 1
    assert "no proposal for 1 finding: none could be proven by a new analysis" in done.stdout


def test_a_hostile_name_is_quoted_in_the_label_and_harmless_in_the_text(cli: Cli, tmp_path: Path) -> None:
    name = "vi: {x}\u202e#"
    text = policy(CAMERA.replace("video", name) + SHAPES["one name to a group"].replace("video", name))
    (tmp_path / "p.xml").write_text(text, "utf-8")
    (tmp_path / "l.yaml").write_text(LABELS)
    done = cli("mitigate", "p.xml", "-l", "l.yaml", cwd=tmp_path)
    assert "\u202e" not in done.stdout
    (line,) = [line for line in done.stdout.splitlines() if "never: [" in line]
    assert yaml.safe_load(line) == {f"/{name}": {"never": ["Video"]}}


def test_the_readme_of_mitigation_shows_what_is_printed(cli: Cli) -> None:
    page = (ROOT / "docs" / "mitigation.md").read_text("utf-8")
    shown, _ = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    (text,) = re.findall(r"```yaml\n(limits:.*?)```", page, re.DOTALL)
    printed = cli("mitigate", BEFORE.relative_to(ROOT), "-l", RUN3.relative_to(ROOT), cwd=ROOT).stdout.splitlines()
    assert all(line in printed for line in shown.splitlines())
    assert yaml.safe_load(text)["weights"] == asdict(Weights())


def test_several_kinds_get_a_proposal_each_and_one_together(cli: Cli) -> None:
    care = ROOT / "examples" / "care-home"
    report = proposals(cli, care / "care-home.policy.xml", "-l", care / "care-home.labels.yaml")
    *single, together = report["proposals"]
    found = rosprivacy.analyze([str(care / "care-home.policy.xml")], [str(care / "care-home.labels.yaml")]).analysis
    names = sorted({finding.category for finding in found.findings if not finding.dismissed})
    assert [proposal["categories"] for proposal in single] == [[name] for name in names]
    assert together["categories"] == names
    assert together["verdict_then"] != "leak"
    assert all(proposal["proven"] for proposal in report["proposals"])


def test_without_v_nothing_is_told_twice_and_what_is_left_out_is_counted(cli: Cli) -> None:
    care = ROOT / "examples" / "care-home"
    system = ("mitigate", care / "care-home.policy.xml", "-l", care / "care-home.labels.yaml")
    short, whole = (cli(*system, *more).stdout for more in ((), ("-v",)))
    steps = {line for line in whole.splitlines() if line.startswith(("   Or put", "   Do not record"))}
    assert len(steps) == 4
    assert {short.count(line) for line in steps} == {1}
    assert {whole.count(line) for line in steps} == {2}
    assert "   1 setting, as above\n   3 changes, as above\n" in short
    assert "as above" not in whole
    assert "(-v)" in short
    assert "(-v)" not in whole
    assert cli(*system, "-f", "json").stdout == cli(*system, "-f", "json", "-v").stdout


def test_a_flow_that_a_person_states_is_named_by_its_line(cli: Cli, tmp_path: Path) -> None:
    """S9: it has no profile and no enclave."""
    (tmp_path / "l.yaml").write_text(
        "labels: 1\nnodes: {/safety_camera: {source: [Video]}}\nelements: {disk: {kind: storage, leak: [Video]}}\n"
        "flows:\n  - {from: /safety_camera, to: disk}\ntopics: {/safety_video: mundane}\n"
    )
    text = cli("mitigate", BEFORE, "-l", "l.yaml", "--by", "filter", cwd=tmp_path).stdout
    assert "l.yaml:5  stated flow\n" in text


def test_a_sanitizer_that_reads_a_wildcard_which_a_source_names(cli: Cli, tmp_path: Path) -> None:
    """S7: a source names channels. That a wildcard gets past a filter to a node makes that node none of them."""
    (tmp_path / "p.xml").write_text(short_policy("/cam>/*", "/clean>/out</*", "/up</*"))
    (tmp_path / "l.yaml").write_text(
        'labels: 1\nnodes:\n  /cam: {source: {Video: ["=/*"]}}\n  /up: {leak: [Video]}\n'
        "  /clean: {sanitizer: {Video: drop}, leak: [Video]}\n"
    )
    done = cli("mitigate", "p.xml", "-l", "l.yaml", "--by", "filter", cwd=tmp_path)
    assert done.stderr == ""
    assert "3 changes remove 2 findings" in done.stdout
    assert "Put a filter between /* (topic wildcard) and /clean (node)" in done.stdout
    assert "Proven: analysed anew with the 3 filters, no open finding of Video is left" in done.stdout
