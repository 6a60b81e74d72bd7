"""Real robots' policies, read from the corpus and never copied: what the paper and its tool's files say of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.names import is_pattern
from rosprivacy.ingest.policies.policy_xml import FRAGMENTS, NotAPolicyError, read_policy
from tests.helpers.turtlebot import COSTMAP, MEMORY, TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.corpus

PAPER = "JonasWoh__ROS2PrivacyGraph"


def analyze(corpus: Path, policy: str, labels: str, **options: Any) -> dict[str, Any]:
    files = [str(corpus / f"categorizations/{PAPER}/categorizations/categorization_{labels}.json")]
    return rosprivacy.analyze([str(corpus / policy)], files, **options).document()


def factory(corpus: Path, run: int, category: str = "PersonalData") -> dict[str, Any]:
    """The paper's factory (II-C): runs 1 to 3 on the prototype, 4 and 5 with the filter."""
    which = "initial" if run < 4 else "final"
    policy = f"policies/{PAPER}/policies/thesis_{which}/thesis_{which}_policy.xml"
    return analyze(corpus, policy, f"thesis_step_{run - 1}", category=category)


def ways(document: dict[str, Any], *, reviewed: bool = False) -> set[tuple[str, ...]]:
    """Witnesses by name; those of which nothing is open, if asked."""
    unreviewed = {q["element"]["name"] for q in document["open"]}
    found = {tuple(e["name"] for e in finding["witness"]) for finding in document["findings"]}
    return {way for way in found if not (reviewed and unreviewed & set(way))}


def to_review(document: dict[str, Any]) -> set[str]:
    """Leaks found and open nodes on the frontier."""
    leaks = {finding["leak"]["name"] for finding in document["findings"]}
    return leaks | {q["element"]["name"] for q in document["open"] if q["frontier"]}


class TestFactory:
    """'In total 5 runs of the tool … were necessary to reach a state … without vulnerable paths.'"""

    def test_run_1_shows_what_the_sources_reach_first(self, corpus: Path) -> None:
        document = factory(corpus, 1)
        assert document["verdict"] == "undetermined"
        assert to_review(document) == {"/archive_server", "/emergency_stop", "/navigator"}

    def test_run_2_leaves_one_reviewed_way(self, corpus: Path) -> None:
        document = factory(corpus, 2)
        assert to_review(document) == {"/archive_server", "/robot_arm_control"}
        assert ways(document, reviewed=True) == {("/safety_camera", "/safety_video", "/archive_server")}

    def test_run_3_frees_the_robot_camera(self, corpus: Path) -> None:
        document = factory(corpus, 3)
        assert ways(document) == {("/safety_camera", "/safety_video", "/archive_server")}

    def test_run_4_leaves_the_way_through_save_footage(self, corpus: Path) -> None:
        document = factory(corpus, 4)
        assert ways(document) == {
            ("/safety_camera", "/safety_video", "/emergency_stop", "/save_footage", "/archive_server")
        }

    def test_run_5_finds_no_leak(self, corpus: Path) -> None:
        document = factory(corpus, 5, "Video")  # what the paper's cameras bring in
        assert document["verdict"] == "no-leak-found"
        assert document["findings"] == document["open"] == []

    def test_of_data_that_may_be_words_the_log_is_open(self, corpus: Path) -> None:
        """Rule S13: where nobody says which personal data, it may stand in the log."""
        document = factory(corpus, 5)
        assert document["findings"] == []
        assert [question["element"]["name"] for question in document["open"]] == ["/rosout"]

    def test_a_filter_named_before_it_is_there_is_an_error(self, corpus: Path) -> None:
        """Rule S11; the paper's tool prints nothing of it."""
        policy = f"policies/{PAPER}/policies/thesis_initial/thesis_initial_policy.xml"
        with pytest.raises(InputErrors, match="'/filter' matches no node"):
            analyze(corpus, policy, "thesis_step_3")


class TestTurtleBot3:
    EXPECTED = frozenset(
        {
            "/lifecycle_manager_localization",
            "/lifecycle_manager_localization_service_client",
            "/lifecycle_manager_navigation",
            "/local_costmap/local_costmap_rclcpp_node",
            "/recoveries_server",
            "/root",  # its profile is '*'
        }
    )

    def test_leaks_and_frontier_after_the_papers_last_run(self, corpus: Path) -> None:
        assert to_review(analyze(corpus, TURTLEBOT3, "turtlebot3_step_5")) == self.EXPECTED

    def test_no_server_reaches_another_through_a_service(self, corpus: Path) -> None:
        """7 of the 8 paths that the paper's tool prints go through one '/~/change_state' of all nodes."""
        document = analyze(corpus, TURTLEBOT3, "turtlebot3_step_5", paths="all")
        assert all("~" not in c["element"]["name"] for c in document["carries"])
        for finding in document["findings"]:
            for path in [finding["witness"], *finding.get("paths", [])]:
                legs = [(e["name"], e.get("leg")) for e in path if e["kind"] == "service" and not e.get("pattern")]
                assert len(set(legs)) == len(legs)

    def test_the_leaks_of_the_first_label_file_that_names_some(self, corpus: Path) -> None:
        document = analyze(corpus, TURTLEBOT3, "turtlebot3_step_1")
        assert {f["leak"]["name"] for f in document["findings"]} == {"/local_costmap/local_costmap_rclcpp_node"}

    @pytest.mark.parametrize("stated", [True, False])
    def test_the_side_channel_between_the_mapping_nodes_is_stated_as_an_element(
        self,
        corpus: Path,
        tmp_path: Path,
        stated: bool,  # noqa: FBT001 - a column
    ) -> None:
        """'After 6 steps and the identification of a side channel between two mapping nodes …': the paper states it
        by calling the second node a source too. As an element the way of the laser's data shows it."""
        (tmp_path / "l.yaml").write_text(COSTMAP + (MEMORY if stated else ""), "utf-8")
        result = rosprivacy.analyze([str(corpus / TURTLEBOT3)], [str(tmp_path / "l.yaml")])
        assert [[e.name for e in finding.witness] for finding in result.analysis.findings] == stated * [
            [
                "/turtlebot3_laserscan",
                "/scan",
                "/local_costmap/local_costmap_rclcpp_node",
                "costmap in memory",
                "/local_costmap/local_costmap",
                "/local_costmap/costmap_raw",
                "/recoveries_server",
            ]
        ]

    def test_five_enclaves_64_profiles_1429_grants(self, corpus: Path) -> None:
        policy = read_policy(str(corpus / TURTLEBOT3))
        assert len({p.enclave for p in policy.profiles}) == 5
        assert len(policy.profiles) == 64
        assert len({p.node for p in policy.profiles}) == 38
        assert len(policy.grants) == 1429

    def test_grants_name_the_included_file(self, corpus: Path) -> None:
        policy = read_policy(str(corpus / TURTLEBOT3))
        scan = [g for g in policy.grants if g.name == "/scan" and g.role == "publish"]
        assert {(g.place.file.rpartition("/")[2], g.place.line) for g in scan} == {("turtlebot3.xml", 45)}

    @pytest.mark.slow
    def test_the_enforced_view_reaches_what_the_declared_one_does_and_more(self, corpus: Path) -> None:
        declared = analyze(corpus, TURTLEBOT3, "turtlebot3_step_5")
        enforced = analyze(corpus, TURTLEBOT3, "turtlebot3_step_5", view="enforced")

        def carrying(document: dict[str, Any]) -> set[tuple[str, str]]:
            return {(c["element"]["kind"], c["element"]["name"]) for c in document["carries"]}

        assert carrying(declared) < carrying(enforced)


def test_every_policy_is_read_or_refused_with_file_line_and_cure(corpus: Path) -> None:
    read, refused = [], []
    for file in sorted((corpus / "policies").rglob("*.xml")):
        try:
            read.append(read_policy(str(file)))
        except InputErrors as error:
            refused.append(file)
            for problem in error.errors:
                assert problem.file == str(file)
                assert problem.line > 0
                assert problem.problem
                assert problem.hint
    assert len(read) + len(refused) == 68
    assert {policy.file.rpartition("/")[2] for policy in read} >= {
        "tb3_gazebo_policy.xml", "slam_policy.xml", "office.policy.xml", "dashboard.xml", "sample_policy.xml",
    }  # fmt: skip
    assert len(read) == 24


def test_what_is_refused_is_a_fragment_another_format_or_broken(corpus: Path) -> None:
    others = set()
    for file in sorted((corpus / "policies").rglob("*.xml")):
        try:
            read_policy(str(file))
        except InputErrors as error:
            first = error.errors[0]
            if not (isinstance(first, NotAPolicyError) and any(f"<{tag}>" in first.problem for tag in FRAGMENTS)):
                others.add(file.name)
    assert others == {
        "invalid_policy_missing_topics_tag.xml",
        "permissions.xml",
        "test.nodl.xml",
        "test_invalid.nodl.xml",
    }


def test_a_whole_folder_of_policies_is_read_at_once(corpus: Path) -> None:
    result = rosprivacy.analyze([str(corpus / "policies" / "ros2__sros2")])
    graph = result.analysis.graph
    assert any(is_pattern(element.name) for element in graph.elements)  # its default policy
    assert result.analysis.verdict == "undetermined"
