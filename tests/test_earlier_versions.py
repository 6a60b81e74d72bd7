"""What an earlier version wrote is read today: decisions, saved analyses, saved graphs (DESIGN.md, Contracts).

The files are in ``cases/earlier/``, whose README says how they were made; they lack the keys that came later. What a
database of that version is answered with is in ``ingest/neo4j_graph/test_other_schemas.py``.
"""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.legal import Lack
from tests.helpers.command import Cli, refused
from tests.helpers.paths import ROOT, TESTS

if TYPE_CHECKING:
    from pathlib import Path

EARLIER = TESTS / "cases" / "earlier"
HOME, FACTORY, FLEET = EARLIER / "care-home", EARLIER / "factory", EARLIER / "fleet"
EXAMPLES = ROOT / "examples"
CARE_HOME = ("care-home.policy.xml", "-l", "care-home.labels.yaml")
FACE, VIDEO, VOICE = "59dc667b0ca44e0f", "9f25c40ce487d74c", "329ba2898df8864e"
OWN_PARAMETERS = {
    f"service /camera/{name} response"
    for name in (
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
    )
}  # fmt: skip - a glob made them sensitive; since then it leaves standard channels as they are (rule S13)


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """The care home as it is today, to be changed."""
    return shutil.copytree(EXAMPLES / "care-home", tmp_path / "care-home")


@pytest.fixture
def another_leak(home: Path) -> Path:
    labels = home / "care-home.labels.yaml"
    text = labels.read_text("utf-8")
    assert "  /navigator: conduit\n" in text
    labels.write_text(text.replace("  /navigator: conduit\n", "  /navigator: {leak: [PersonTrack]}\n"))
    return home


def written(cli: Cli, code: int, *arguments: str | Path, cwd: Path) -> Any:
    """The JSON that a command prints, which ends with the code."""
    done = cli(*arguments, "-f", "json", cwd=cwd)
    assert (done.returncode, done.stderr) == (code, "")
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    ("file", "key"),
    [
        (HOME / "analysis.json", "taken_away"),
        (FLEET / "analysis.json", "taken_away"),
        (HOME / "graph.json", "absolute"),
        (FACTORY / "before.graph.json", "dead"),
    ],
    ids=lambda value: value.name if hasattr(value, "name") else value,
)
def test_the_files_are_of_that_version(file: Path, key: str) -> None:
    """Made again by a later version, they would show nothing."""
    assert f'"{key}"' not in file.read_text("utf-8")


# A home map is no kind of location any more, and the example states who operates a bucket, a screen and a review.
THE_LAW_IN_A_FLEET = {
    "asked otherwise: law_as_of: 2026-04-30 before, 2026-11-21 now",
    "elements: 7 changed",
    "  ~ node cleaner:/navigator",
    "      carries: + Location",
    "      labels: - conduit of HomeMap",
}


class TestDecisions:
    def test_each_holds_for_what_it_was_made_for(self, cli: Cli) -> None:
        given = ("analyze", *CARE_HOME, "--decisions", HOME / "decisions.yaml")
        document = written(cli, 1, *given, cwd=EXAMPLES / "care-home")
        found = {
            f["id"]: (f["accepted"], f["decision"]["choice"], f["decision"]["state"]) for f in document["findings"]
        }
        assert found == {
            FACE: (False, "mitigate", "valid"),
            VIDEO: (True, "accept", "valid"),
            VOICE: (True, "accept", "valid"),
        }
        said = [told["message"] for told in document["diagnostics"] if told["file"].endswith("decisions.yaml")]
        reveals = "states no ground under Article 9(2), and {} may reveal what is named in GDPR Art. 9(1)"
        assert sorted(said) == sorted(
            [
                f"the decision to accept {VIDEO} states no legal basis under Article 6(1)",
                f"the decision to accept {VIDEO} {reveals.format('Video')}",
                f"the decision to accept {VOICE} {reveals.format('Voice')}",
                f"the decision to accept {VIDEO} {Lack.NO_END}",
            ]
        )

    def test_what_was_accepted_does_not_fail(self, cli: Cli) -> None:
        given = ("analyze", *CARE_HOME, "-c", "Voice", "-q")
        assert cli(*given, cwd=EXAMPLES / "care-home").returncode == 1
        done = cli(*given, "--decisions", HOME / "decisions.yaml", cwd=EXAMPLES / "care-home")
        assert done.returncode == 0

    def test_patterns_of_a_fleet_keep_their_ids_and_what_changed_is_told(self, cli: Cli) -> None:
        """``robot`` alone no longer accepts what goes from one robot to another: a finding again, with a warning."""
        given = ("analyze", "--fleet", "fleet.yaml", "--decisions", FLEET / "decisions.yaml")
        document = written(cli, 1, *given, cwd=EXAMPLES / "fleet")
        earlier = json.loads((FLEET / "analysis.json").read_text("utf-8"))
        patterns = {p["id"]: p for p in document["fleet"]["patterns"]}
        assert list(patterns) == [p["id"] for p in earlier["fleet"]["patterns"]]
        counts = {one: (len(p["robots"]), p["findings"], p.get("accepted", 0)) for one, p in patterns.items()}
        assert counts == {
            "f2d835e951b0cc4c": (40, 468, 0),  # from one robot to another; an earlier version took all 468 as accepted
            "489237e56570a173": (40, 40, 40),
            "c58e57ea17af860d": (40, 40, 40),
            "391ce95541a5314a": (12, 12, 12),
            "42274e88e18e8727": (24, 24, 1),  # of the lent robot only
            "54727d664c0c3084": (24, 24, 0),
        }
        (lost,) = [said for said in document["diagnostics"] if "names no from_robot" in said["message"]]
        assert lost["line"] == 21
        assert lost["message"].endswith("from one robot to another, accepted before, no longer; add it")

    def test_mitigate_leaves_what_was_accepted(self, cli: Cli) -> None:
        given = ("mitigate", *CARE_HOME, "--decisions", HOME / "decisions.yaml")
        document = written(cli, 0, *given, cwd=EXAMPLES / "care-home")
        assert [proposal["removes"] for proposal in document["proposals"]] == [[FACE]]

    def test_a_decision_is_added_by_the_report_of_then(self, cli: Cli, tmp_path: Path) -> None:
        """By the beginning of an id; with all three decided, nothing is left."""
        mine = shutil.copy(HOME / "decisions.yaml", tmp_path)
        more = ("--reason", "r", "--owner", "o", "--legal-basis", "9(2)(h)", "--legal-basis", "6(1)(d)")
        done = cli("decide", "accept", FACE[:4], "--report", HOME / "analysis.json", "--decisions", mine, *more)
        assert (done.returncode, done.stdout) == (0, f"{mine}: accept id {FACE}\n")
        assert f"- id: {FACE}  # FaceTemplate: /camera -> /uplink\n" in (tmp_path / "decisions.yaml").read_text("utf-8")
        done = cli("analyze", *CARE_HOME, "-q", "--decisions", mine, cwd=EXAMPLES / "care-home")
        assert done.returncode == 0

    def test_a_pattern_is_decided_by_the_report_of_then(self, cli: Cli, tmp_path: Path) -> None:
        mine = tmp_path / "decisions.yaml"
        done = cli("decide", "mitigate", "5472", "--report", FLEET / "analysis.json", "--decisions", mine)
        assert (done.returncode, done.stdout) == (0, f"{mine}: mitigate id 54727d664c0c3084\n")


class TestSavedAnalysis:
    def test_the_same_system_differs_in_what_the_changelog_names_only(self, cli: Cli) -> None:
        given = ("diff", HOME / "analysis.json", *CARE_HOME)
        document = written(cli, 0, *given, cwd=EXAMPLES / "care-home")
        assert document["findings"] == {"new": [], "gone": [], "changed": []}
        assert {told(row) for row in document["elements"]["gone"]} == OWN_PARAMETERS
        assert document["elements"]["new"] == document["elements"]["changed"] == []
        assert cli(*given, "--fail-on", "any", cwd=EXAMPLES / "care-home").returncode == 1

    def test_a_new_leak_is_worse(self, cli: Cli, another_leak: Path) -> None:
        document = written(cli, 1, "diff", HOME / "analysis.json", *CARE_HOME, cwd=another_leak)
        assert {row["leak"] for row in document["findings"]["new"]} == {"node /navigator"}

    def test_decisions_of_then_count(self, cli: Cli) -> None:
        given = ("diff", HOME / "analysis.json", *CARE_HOME, "--decisions", HOME / "decisions.yaml")
        document = written(cli, 0, *given, cwd=EXAMPLES / "care-home")
        changed = document["findings"]["changed"]
        assert [row["leak"] for row in changed] == ["node /recorder", "node /uplink"]
        assert all(row["before"] | {"accepted": True} == row["after"] != row["before"] for row in changed)

    def test_a_fleet(self, cli: Cli) -> None:
        done = cli("diff", FLEET / "analysis.json", "fleet.yaml", "--fail-on", "any", cwd=EXAMPLES / "fleet")
        assert done.returncode == 1
        assert set(done.stdout.splitlines()) >= THE_LAW_IN_A_FLEET
        assert "findings: 1 changed" in done.stdout

    @pytest.mark.parametrize("form", ["markdown", "html"])
    def test_a_report_says_that_only_the_law_changed(self, cli: Cli, form: str) -> None:
        given = ("report", *CARE_HOME, "--since", HOME / "analysis.json", "-f", form)
        done = cli(*given, cwd=EXAMPLES / "care-home")
        assert done.returncode == 0
        assert "date of the law: 2026-04-30, now 2026-11-21" in done.stdout
        assert done.stdout.count("another statement on Article 9, other provisions") == 2  # video, voice
        assert "New paths" not in done.stdout
        assert "Paths that are gone" not in done.stdout

    def test_a_report_names_what_is_new(self, cli: Cli, another_leak: Path) -> None:
        given = ("report", *CARE_HOME, "--since", HOME / "analysis.json", "-f", "markdown")
        done = cli(*given, cwd=another_leak)
        assert done.returncode == 0
        assert "Nothing changed in what was found." not in done.stdout
        since = done.stdout.partition("What changed since the earlier report")[2].partition("\n## ")[0]
        assert "navigator" in since

    def test_a_report_on_a_fleet(self, cli: Cli) -> None:
        given = ("report", "--fleet", "fleet.yaml", "--since", FLEET / "analysis.json", "-f", "markdown")
        done = cli(*given, cwd=EXAMPLES / "fleet")
        assert done.returncode == 0
        assert "date of the law: 2026-04-30, now 2026-11-21" in done.stdout
        assert "New paths" not in done.stdout
        assert "Paths that are gone" not in done.stdout


def told(row: dict[str, Any]) -> str:
    return f"{row['kind']} {row['name']} {row.get('leg', '')}".strip()


class TestSavedGraph:
    @pytest.mark.parametrize(
        ("graph", "labels", "policy", "code"),
        [
            (HOME / "graph.json", "care-home/care-home.labels.yaml", "care-home/care-home.policy.xml", 1),
            (FACTORY / "before.graph.json", "factory/run1.labels.yaml", "factory/before.policy.xml", 4),
            (FACTORY / "before.graph.json", "factory/run3.labels.yaml", "factory/before.policy.xml", 1),
        ],
        ids=["care-home", "factory-run1", "factory-run3"],
    )
    def test_it_gives_the_answer_of_its_policy_and_says_what_it_lacks(
        self, cli: Cli, graph: Path, labels: str, policy: str, code: int
    ) -> None:
        folder = (EXAMPLES / policy).parent
        given = ("-l", EXAMPLES / labels)
        document = written(cli, code, "analyze", "--add", graph, *given, cwd=folder)
        (said, *more) = sorted(document["diagnostics"], key=lambda told: "saved by" not in told["message"])
        assert said["message"].startswith("saved by an earlier version, which did not keep which names")
        now = written(cli, code, "analyze", (EXAMPLES / policy).name, *given, cwd=folder)
        assert document | {"diagnostics": more} == now

    def test_a_policy_is_added_to_it(self, cli: Cli) -> None:
        """The factory's camera is added to the care home: two policies, as if both had been read now."""
        given = ("-l", "../care-home/care-home.labels.yaml")
        document = written(
            cli, 1, "analyze", "--add", HOME / "graph.json", "after.policy.xml", *given, cwd=EXAMPLES / "factory"
        )
        names = {row["file"] for row in document["assumptions"]["policies"]}
        assert names == {"after.policy.xml", "care-home.policy.xml", "node.xml"}
        assert {f["id"] for f in document["findings"]} == {FACE, VIDEO, VOICE}

    def test_it_is_the_state_before(self, cli: Cli) -> None:
        given = ("diff", HOME / "graph.json", *CARE_HOME, "--fail-on", "any")
        done = cli(*given, cwd=EXAMPLES / "care-home")
        assert (done.returncode, done.stdout.splitlines()[::3]) == (0, ["verdict: leak", "nothing differs"])

    def test_what_the_factory_changed_since(self, cli: Cli) -> None:
        given = ("diff", FACTORY / "before.graph.json", "after.policy.xml", "-l", "run3.labels.yaml")
        document = written(cli, 0, *given, cwd=EXAMPLES / "factory")
        now = ("diff", "before.policy.xml", "after.policy.xml", "-l", "run3.labels.yaml")
        assert document == written(cli, 0, *now, cwd=EXAMPLES / "factory")


def test_a_graph_of_a_format_that_nobody_wrote_is_refused(cli: Cli, tmp_path: Path) -> None:
    text = (HOME / "graph.json").read_text("utf-8").replace("rosprivacy.graph/1", "rosprivacy.graph/0")
    (tmp_path / "old.json").write_text(text)
    (line,) = refused(cli("analyze", "--add", "old.json", cwd=tmp_path))
    assert "not a saved graph (rosprivacy.graph/1)" in line
