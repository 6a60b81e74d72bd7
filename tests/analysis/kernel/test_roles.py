"""Labels on small systems (rules S7, S8, S10, S11, S13): a policy and a label file in, elements out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result

#   camera -> image -> a -> mid -> b -> out -> c
CHAIN = ("camera>image", "a<image", "a>mid", "b<mid", "b>out", "c<out")
POLICY = '<policy version="0.2.0"><enclaves><enclave path="/"><profiles>{}</profiles></enclave></enclaves></policy>'


def system(folder: Path, labels: str, flows: tuple[str, ...] = CHAIN, **options: Any) -> Result:
    """``node>topic`` publishes, ``node<topic`` subscribes."""
    nodes: dict[str, list[str]] = {}
    for flow in flows:
        node, _, topic = flow.partition(">" if ">" in flow else "<")
        role = "publish" if ">" in flow else "subscribe"
        nodes.setdefault(node, []).append(f'<topics {role}="ALLOW"><topic>/{topic}</topic></topics>')
    profiles = "".join(f'<profile ns="/" node="{node}">{"".join(rows)}</profile>' for node, rows in nodes.items())
    (folder / "p.xml").write_text(POLICY.format(profiles))
    (folder / "l.yaml").write_text("labels: 1\n" + labels)
    return rosprivacy.analyze([str(folder / "p.xml")], [str(folder / "l.yaml")], **options)


def carries(result: Result) -> dict[str, set[str]]:
    return {
        c.element.name.removeprefix("/"): {*c.categories, *(f"~{name}" for name in c.pseudonymised)}
        for c in result.analysis.carried
    }


def findings(result: Result) -> set[tuple[str, str, str]]:
    names = ((f.category, f.source.name, f.leak.name) for f in result.analysis.findings if not f.dismissed)
    return {(category, source.removeprefix("/"), leak.removeprefix("/")) for category, source, leak in names}


SOURCE = "nodes:\n  /camera: {source: [FaceTemplate]}\n"


@pytest.mark.parametrize(
    ("label", "reached"),
    [
        # May: a leak applies if it names the same, a broader or a narrower category.
        ("{leak: [FaceTemplate]}", True),
        ("{leak: [Biometric]}", True),
        ("{leak: [PersonalData]}", True),
        ("{leak: [Voice]}", False),
        ("{leak: [VoicePrint]}", False),
    ],
)
def test_a_leak_may_name_the_same_or_a_broader_category(tmp_path: Path, label: str, *, reached: bool) -> None:
    result = system(tmp_path, SOURCE + f"  /c: {label}\n")
    assert (findings(result) == {("FaceTemplate", "camera", "c")}) is reached


def test_a_leak_may_name_a_narrower_category_since_what_is_emitted_may_be_that(tmp_path: Path) -> None:
    result = system(tmp_path, "nodes:\n  /camera: {source: [Biometric]}\n  /c: {leak: [FaceTemplate]}\n")
    assert findings(result) == {("Biometric", "camera", "c")}


@pytest.mark.parametrize(
    ("label", "after"),
    [
        # Must: a sanitizer applies if it names the same or a broader category.
        ("{sanitizer: {FaceTemplate: anonymise}}", set()),
        ("{sanitizer: {Biometric: aggregate}}", set()),
        ("{sanitizer: {PersonalData: drop}}", set()),
        ("{sanitizer: {Voice: drop}}", {"FaceTemplate"}),
        # Pseudonymised data is personal data (recital 26): it goes on, in a plane of its own.
        ("{sanitizer: {Biometric: pseudonymise}}", {"~FaceTemplate"}),
        # A method that is not stated counts as pseudonymise.
        ("{sanitizer: [Biometric]}", {"~FaceTemplate"}),
        ("{sanitizer: {Biometric: }}", {"~FaceTemplate"}),
    ],
)
def test_a_sanitizer(tmp_path: Path, label: str, after: set[str]) -> None:
    result = system(tmp_path, SOURCE + f"  /a: {label}\n")
    assert "FaceTemplate" in carries(result)["a"]  # it arrives there, whatever happens then
    assert carries(result).get("mid", set()) == after


def test_what_is_pseudonymised_twice_is_still_personal_data(tmp_path: Path) -> None:
    """Rule S8, recital 26: it must not vanish at the second pseudonymiser."""
    twice = "  /a: {sanitizer: {Biometric: pseudonymise}}\n  /b: {sanitizer: {Biometric: pseudonymise}}\n"
    result = system(tmp_path, SOURCE + twice + "  /c: {leak: [Biometric]}\n")
    assert carries(result)["out"] == {"~FaceTemplate"}
    assert findings(result) == {("FaceTemplate", "camera", "c")}
    assert result.analysis.findings[0].pseudonymised


def test_a_sanitizer_of_a_narrower_category_does_not_clean_a_broader_one(tmp_path: Path) -> None:
    result = system(tmp_path, "nodes:\n  /camera: {source: [Biometric]}\n  /a: {sanitizer: {FaceTemplate: drop}}\n")
    assert carries(result)["mid"] == {"Biometric"}


def test_the_report_says_which_sanitizer_states_no_method(tmp_path: Path) -> None:
    result = system(tmp_path, SOURCE + "  /a: {sanitizer: [Biometric]}\n")
    taken = result.document()["assumptions"]["sanitizers_without_method"]
    assert [(t["element"]["name"], t["category"], t["taken_as"]) for t in taken] == [
        ("/a", "FaceTemplate", "pseudonymise")
    ]


def test_of_several_statements_the_nearest_in_the_hierarchy_wins(tmp_path: Path) -> None:
    labels = "  /a: {sanitizer: {PersonalData: drop}, conduit: [Biometric]}\n"
    assert carries(system(tmp_path, SOURCE + labels))["mid"] == {"FaceTemplate"}
    labels = "  /a: {sanitizer: {FaceTemplate: drop}, conduit: [Biometric]}\n"
    assert "mid" not in carries(system(tmp_path, SOURCE + labels))


def test_a_conduit_for_a_broader_category_does_not_hide_a_leak_of_a_narrower_one(tmp_path: Path) -> None:
    labels = "nodes:\n  /camera: {source: [Biometric]}\n  /c: {conduit: [Biometric], leak: [FaceTemplate]}\n"
    assert findings(system(tmp_path, labels)) == {("Biometric", "camera", "c")}


class TestChannels:
    @pytest.mark.parametrize(
        ("label", "after"),
        [
            ("mundane", set()),
            ("sensitive", {"FaceTemplate"}),
            ("{only: [Biometric]}", {"FaceTemplate"}),  # may: the same, broader or narrower
            ("{only: [FaceTemplate]}", {"FaceTemplate"}),
            ("{only: [Voice]}", set()),
            ("{never: [Biometric]}", set()),  # must: the same or broader
            ("{never: [VoicePrint]}", {"FaceTemplate"}),
        ],
    )
    def test_what_a_channel_carries(self, tmp_path: Path, label: str, after: set[str]) -> None:
        result = system(tmp_path, SOURCE + f"channels:\n  /mid: {label}\n")
        assert carries(result).get("mid", set()) == after
        assert carries(result).get("b", set()) == after

    def test_only_lets_pass_what_may_be_a_narrower_kind(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: [Biometric]}\nchannels:\n  /mid: {only: [FaceTemplate]}\n"
        assert carries(system(tmp_path, labels))["b"] == {"Biometric"}

    def test_a_single_flow_is_restricted(self, tmp_path: Path) -> None:
        flows = (*CHAIN, "d<mid")
        labels = SOURCE + "flows:\n  - {from: /mid, to: /b, never: [Biometric]}\n"
        found = carries(system(tmp_path, labels, flows))
        assert "b" not in found
        assert found["d"] == {"FaceTemplate"}
        labels = SOURCE + "flows:\n  - {from: /mid, to: /b, only: [Voice]}\n"
        assert "b" not in carries(system(tmp_path, labels, flows))


class TestSources:
    FLOWS = ("camera>raw", "camera>status", "a<raw", "b<status", "camera<loop", "a>loop")

    def test_all_outputs_carry_what_a_source_names(self, tmp_path: Path) -> None:
        found = carries(system(tmp_path, "nodes:\n  /camera: {source: [Video]}\n", self.FLOWS))
        assert set(found) == {"camera", "raw", "status", "a", "b", "loop"}

    def test_or_only_the_channels_that_it_names(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: {Video: [/raw]}}\nchannels:\n  /loop: mundane\n"
        found = carries(system(tmp_path, labels, self.FLOWS))
        assert set(found) == {"camera", "raw", "a"}

    def test_what_comes_back_to_it_passes_it_like_any_node(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: {Video: [/raw]}}\n  /b: {leak: [Video]}\n"
        result = system(tmp_path, labels, self.FLOWS)
        (finding,) = result.analysis.findings
        way = [element.name for element in finding.witness]
        assert way == ["/camera", "/raw", "/a", "/loop", "/camera", "/status", "/b"]

    def test_a_witness_begins_on_a_channel_that_it_names(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: {Video: [/ra?]}}\n  /a: {leak: [Video]}\nchannels: {/loop: mundane}\n"
        result = system(tmp_path, labels, self.FLOWS)
        (finding,) = result.analysis.findings
        assert [element.name for element in finding.witness] == ["/camera", "/raw", "/a"]
        assert finding.disjoint_paths == 1

    def test_a_source_that_leaks_is_a_finding_of_one_element(self, tmp_path: Path) -> None:
        """Rule S10."""
        result = system(tmp_path, "nodes:\n  /camera: {source: [Video], leak: [PersonalData]}\n")
        (finding,) = result.analysis.findings
        assert [element.name for element in finding.witness] == ["/camera"]
        assert result.analysis.verdict == "leak"

    def test_a_recogniser_in_the_camera_makes_its_own_data_into_another_kind(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: [Video], derives: [{from: Video, to: FaceTemplate}]}\n"
        assert carries(system(tmp_path, labels))["image"] == {"Video", "FaceTemplate"}


class TestDerivations:
    LABELS = (
        "nodes:\n  /camera: {source: [Video]}\n  /c: {leak: [Biometric]}\n"
        "  /a: {derives: [{from: Video, to: FaceTemplate}], sanitizer: {Video: drop}}\n  /b: conduit\n"
    )

    def test_one_kind_becomes_another_on_the_way(self, tmp_path: Path) -> None:
        result = system(tmp_path, self.LABELS)
        assert carries(result)["mid"] == {"FaceTemplate"}
        assert findings(result) == {("FaceTemplate", "camera", "c")}
        (finding,) = result.analysis.findings
        assert [step.category for step in finding.steps] == ["Video", "Video", *["FaceTemplate"] * 4]

    def test_a_node_that_makes_it_and_lets_it_out_is_a_leak(self, tmp_path: Path) -> None:
        labels = self.LABELS.replace("  /a: {", "  /a: {leak: [Biometric], ")
        assert findings(system(tmp_path, labels)) == {("FaceTemplate", "camera", "a")}

    def test_pseudonymised_in_is_pseudonymised_out(self, tmp_path: Path) -> None:
        labels = (
            "nodes:\n  /camera: {source: [Video]}\n  /a: {sanitizer: {Video: pseudonymise}}\n"
            "  /b: {derives: [{from: Video, to: FaceTemplate}]}\n"
        )
        assert carries(system(tmp_path, labels))["out"] == {"~Video", "~FaceTemplate"}

    def test_what_is_made_is_made_into_a_third_kind_in_the_same_node(self, tmp_path: Path) -> None:
        chain = "{from: Video, to: FaceImage}, {from: FaceImage, to: FaceTemplate}"
        labels = f"nodes:\n  /camera: {{source: [Video]}}\n  /a: {{derives: [{chain}]}}\n"
        assert carries(system(tmp_path, labels))["mid"] == {"Video", "FaceImage", "FaceTemplate"}


class TestDismissal:
    """Rule S10."""

    def test_a_path_through_another_leak_is_dismissed_and_says_which(self, tmp_path: Path) -> None:
        labels = SOURCE + "  /b: {leak: [Biometric]}\n  /c: {leak: [Biometric]}\n"
        result = system(tmp_path, labels)
        assert findings(result) == {("FaceTemplate", "camera", "b")}
        (dismissed,) = [f for f in result.analysis.findings if f.dismissed]
        assert [element.name for element in dismissed.through] == ["/b"]

    def test_a_leak_that_has_a_path_of_its_own_keeps_its_finding(self, tmp_path: Path) -> None:
        labels = SOURCE + "  /b: {leak: [Biometric]}\n  /c: {leak: [Biometric]}\n"
        result = system(tmp_path, labels, (*CHAIN, "c<mid"))
        assert len(findings(result)) == 2

    def test_a_leak_of_another_kind_dismisses_nothing(self, tmp_path: Path) -> None:
        """Joern's issue 5053: a sink that is a source of something else must not swallow the flow."""
        labels = SOURCE + "  /b: {leak: [Voice], source: [Location]}\n  /c: {leak: [Biometric, Location]}\n"
        assert findings(system(tmp_path, labels)) == {("FaceTemplate", "camera", "c"), ("Location", "b", "c")}

    def test_the_same_node_cleans_one_kind_and_leaks_another(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: [Video, Voice]}\n  /c: {leak: [Voice], sanitizer: {Video: drop}}\n"
        assert findings(system(tmp_path, labels)) == {("Voice", "camera", "c")}

    def test_a_leak_that_is_a_sanitizer_of_the_same_kind_is_still_one(self, tmp_path: Path) -> None:
        labels = SOURCE + "  /c: {leak: [Biometric], sanitizer: {Biometric: drop}}\n"
        assert findings(system(tmp_path, labels)) == {("FaceTemplate", "camera", "c")}


class TestVerdict:
    """Rule S12."""

    REVIEWED = SOURCE + "  /*: conduit\n  /b: {leak: none}\nchannels:\n  /*: sensitive\n"

    def test_everything_reviewed_and_no_leak(self, tmp_path: Path) -> None:
        assert system(tmp_path, self.REVIEWED).analysis.verdict == "no-leak-found"

    @pytest.mark.parametrize("name", ["/a", "/mid"])
    def test_one_element_open_is_undetermined(self, tmp_path: Path, name: str) -> None:
        """A node or a channel; here reviewed for another kind of data only."""
        kind = "nodes" if name == "/a" else "channels"
        other = "{conduit: [Voice]}" if name == "/a" else "{never: [Voice]}"
        text = self.REVIEWED.replace("  /*: conduit", "  /[!a]*: conduit").replace("  /*: sens", "  /[!m]*: sens")
        named = text.replace(f"{kind}:\n", f"{kind}:\n  {name}: {other}\n", 1)
        other_one = "  /mid: sensitive\n" if name == "/a" else ""
        named = named.replace("channels:\n", "channels:\n" + other_one)
        if name == "/mid":
            named = named.replace("nodes:\n", "nodes:\n  /a: conduit\n")
        result = system(tmp_path, named)
        assert result.analysis.verdict == "undetermined"
        assert [q.element.name for q in result.analysis.open] == [name]

    def test_without_a_source_nothing_can_be_said(self, tmp_path: Path) -> None:
        result = system(tmp_path, "nodes:\n  /c: {leak: [Video]}\n")
        assert result.analysis.verdict == "undetermined"
        assert "no label names a source" in result.document()["diagnostics"][0]["message"]

    def test_categories_that_no_source_emits_give_no_all_clear(self, tmp_path: Path) -> None:
        result = system(tmp_path, self.REVIEWED, categories=("Voice",))
        assert result.analysis.verdict == "undetermined"

    def test_the_answer_is_about_the_categories_asked_and_narrower_ones(self, tmp_path: Path) -> None:
        labels = "nodes:\n  /camera: {source: [FaceTemplate, Voice]}\n  /c: {leak: [PersonalData]}\n"
        assert len(findings(system(tmp_path, labels))) == 2
        assert findings(system(tmp_path, labels, categories=("biometrics",))) == {("FaceTemplate", "camera", "c")}


class TestStandardChannels:
    """Rule S13."""

    FLOWS = ("camera>rosout", "a<rosout", "camera>robot/rosout", "camera>xrosout", "camera>tf")
    LABELS = "nodes:\n  /camera: {source: [Video]}\n"

    def test_they_carry_nothing_and_are_counted(self, tmp_path: Path) -> None:
        result = system(tmp_path, self.LABELS, self.FLOWS)
        assert set(carries(result)) == {"camera", "xrosout", "tf"}
        assert result.document()["standard_channels"] == 2

    def test_they_can_be_switched_off(self, tmp_path: Path) -> None:
        result = system(tmp_path, self.LABELS, self.FLOWS, standard_channels=None)
        assert {"rosout", "a"} <= set(carries(result))
        assert result.document()["standard_channels"] == 0

    def test_a_persons_own_word_outranks_them(self, tmp_path: Path) -> None:
        result = system(tmp_path, self.LABELS + "channels:\n  /rosout: sensitive\n", self.FLOWS)
        assert {"rosout", "a"} <= set(carries(result))
        assert result.document()["standard_channels"] == 1

    def test_more_are_proposed_and_taken_only_when_named(self, tmp_path: Path) -> None:
        flows = ("camera>a/transition_event",)
        assert "a/transition_event" in carries(system(tmp_path, self.LABELS, flows))
        policy, labels = str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")
        result = rosprivacy.analyze([policy], [labels, "rosprivacy:infrastructure"])
        assert "a/transition_event" not in carries(result)


@pytest.mark.parametrize(
    "labels",
    [
        "nodes:\n  /a: {source: [Video], sanitizer: {Video: drop}}\n",  # rule S10
        "nodes:\n  /a: {source: [Video], conduit: [Video]}\n",
        "nodes:\n  /a: {leak: [Video], conduit: [Video]}\n",
        "nodes:\n  /a: {sanitizer: {Video: drop}, conduit: [Video]}\n",
        "nodes:\n  /a*: {sanitizer: {Video: drop}}\n  '*/a': {sanitizer: {Video: aggregate}}\n",
    ],
)
def test_contradictions_are_errors_that_name_both_lines(tmp_path: Path, labels: str) -> None:
    with pytest.raises(InputErrors) as caught:
        system(tmp_path, labels)
    assert "l.yaml:" in str(caught.value)
    assert str(caught.value).count("l.yaml:") >= 2


class TestWhatDecided:
    """Rule S7: the facts keep the statements that close the way, and those of sources and leaks that do not hold."""

    @staticmethod
    def told(result: Result, name: str, category: str = "FaceTemplate") -> tuple[list[str], list[tuple[str, str]]]:
        elements = result.analysis.graph.elements
        (vertex,) = [v for v, element in enumerate(elements) if element.name == f"/{name}"]
        fact = result.analysis.spread.facts[vertex][category]
        return [s.role for s in fact.closers], [(lost.role, by.role) for lost, by in fact.outdone]

    @pytest.mark.parametrize(
        ("name", "label", "closers"),
        [
            ("a", "{sanitizer: {Biometric: drop}}", ["sanitizer"]),
            ("a", "{sanitizer: {Biometric: pseudonymise}}", ["sanitizer"]),  # it ends the plain form
            ("a", "{sanitizer: {Voice: drop}}", []),
            ("mid", "mundane", ["mundane"]),
            ("mid", "{only: [Voice], never: [Biometric]}", ["never", "only"]),
            ("mid", "{only: [FaceTemplate]}", []),
            ("mid", "sensitive", []),
        ],
    )
    def test_of_elements(self, tmp_path: Path, name: str, label: str, closers: list[str]) -> None:
        section = "" if name == "a" else "channels:\n"
        result = system(tmp_path, f"{SOURCE}{section}  /{name}: {label}\n")
        assert self.told(result, name) == (closers, [])

    def test_of_flows(self, tmp_path: Path) -> None:
        result = system(tmp_path, SOURCE + "flows:\n  - {from: /mid, to: /b, never: [Biometric]}\n")
        ((fact, *_),) = [[f[c] for c in ["FaceTemplate"]] for f in result.analysis.spread.flow_facts.values()]
        assert [(s.role, s.categories) for s in fact.closers] == [("never", ("Biometric",))]

    def test_what_is_outdone_is_kept_with_what_outdid_it(self, tmp_path: Path) -> None:
        result = system(tmp_path, SOURCE + "  /c*: {leak: [Biometric]}\n  /c: {leak: none}\n")
        assert self.told(result, "c") == ([], [("leak", "no-leak")])
