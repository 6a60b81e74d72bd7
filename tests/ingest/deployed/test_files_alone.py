"""Several permissions files and one governance for each domain, outside a keystore (rules S6, S11)."""

from __future__ import annotations

import json
from itertools import permutations
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.ingest.deployed.deployed_inputs import read_deployed
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Diagnostic
    from rosprivacy.ingest.deployed.deployed_inputs import Read
    from tests.helpers.command import Cli


LABELS = (
    "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
    "channels: {/video: sensitive, /other: sensitive}\n"
)
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/camera"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave></enclaves></policy>"""
OPEN = topic_rule("rt/video", reading="false")
TODAY = "2026-11-22"


def camera(domains: str = "<id>0</id>") -> str:
    return permissions(grant("/camera", rule("allow", publish=("rt/video",), domains=domains)))


def uplink(*topics: str, domains: str = "<id>0</id>") -> str:
    return permissions(grant("/uplink", rule("allow", subscribe=topics or ("rt/other",), domains=domains)))


def of(number: int, *topics: str) -> str:
    """A governance of a domain."""
    return governance(*topics, domains=f"<id>{number}</id>")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in "ab":
        (tmp_path / name).mkdir()
    (tmp_path / "a/permissions.xml").write_text(camera())
    (tmp_path / "b/permissions.xml").write_text(uplink())
    (tmp_path / "governance.xml").write_text(of(0))
    (tmp_path / "labels.yaml").write_text(LABELS)
    return tmp_path


def read(folder: Path, *texts: str, domain: int | None = None, view: str = "declared") -> Read:
    """Read texts as files that stand by themselves, the last first."""
    names = []
    for at, text in enumerate(texts):
        names.append(str(folder / f"f{at}.xml"))
        (folder / f"f{at}.xml").write_text(text)
    return read_deployed(reversed(names), domain, TODAY, allow_unsigned=True, view=view)


def told(said: tuple[Diagnostic, ...], folder: Path) -> list[str]:
    return [f"{one.place}: {one.message}".replace(f"{folder}/", "") for one in said]


def analysed(cli: Cli, folder: Path, *names: str, more: tuple[str, ...] = ()) -> tuple[int, dict[str, Any]]:
    done = cli("analyze", *names, "-l", "labels.yaml", "--allow-unsigned", "-f", "json", *more, cwd=folder)
    assert done.returncode in (0, 1, 4), done.stderr
    return done.returncode, json.loads(done.stdout)


FILES = ("a/permissions.xml", "b/permissions.xml", "governance.xml")


def test_files_are_told_apart_by_what_is_in_them_in_any_order(cli: Cli, folder: Path) -> None:
    answers = [analysed(cli, folder, *names) for names in permutations(FILES)]
    assert all(answer == answers[0] for answer in answers)
    code, document = answers[0]
    assert code == 0
    assert all(name in json.dumps(document["assumptions"]) for name in FILES)


def test_what_governance_leaves_open_counts_for_the_permissions_of_its_domain(cli: Cli, folder: Path) -> None:
    """Of signed files as of plain ones."""
    is_open = of(0, OPEN, topic_rule())
    (folder / "governance.xml").write_text(is_open)
    made = Keystore(folder / "k")
    made.sign(camera(), folder / "a/permissions.p7s")
    made.sign(is_open, folder / "g.p7s")
    for names in (FILES, ("g.p7s", "b/permissions.xml", "a/permissions.p7s")):
        code, document = analysed(cli, folder, *names)
        assert code == 4
        assert "permissions are not asked" in json.dumps(document["diagnostics"])
        code, document = analysed(cli, folder, *names, more=("--view", "enforced"))
        assert (code, [one["kind"] for one in document["findings"]]) == (1, ["disclosure"])


def test_permissions_without_any_governance_are_undetermined_at_best_in_a_saved_graph_too(
    cli: Cli, folder: Path
) -> None:
    code, document = analysed(cli, folder, *FILES[:2], more=("--save-graph", "graph.json"))
    assert (code, document["verdict"]) == (4, "undetermined")
    assert [one.get("code") for one in document["diagnostics"]].count(ACCESS_GAP) == 2
    again = cli("analyze", "--add", "graph.json", "-l", "labels.yaml", "-f", "json", cwd=folder)
    assert (again.returncode, json.loads(again.stdout)["verdict"]) == (4, "undetermined")


def test_a_domain_that_no_governance_names_is_told_and_a_gap(tmp_path: Path) -> None:
    _, said = read(tmp_path, camera("<id>0</id><id>7</id>"), uplink(domains="<id>0</id><id>7</id>"), of(0))
    gaps = [one for one in said if one.code == ACCESS_GAP]
    assert [line.split(",")[0] for line in told(tuple(gaps), tmp_path)] == [
        "f0.xml:3: domain 7: no governance that is named is surely about it",
        "f1.xml:3: domain 7: no governance that is named is surely about it",
    ]
    assert not [one for one in read(tmp_path, camera("<id>0</id><id>7</id>"), of(0), of(7))[1] if one.code]


def test_domains_that_ros_does_not_have_are_governed_too(tmp_path: Path) -> None:
    """A middleware does not start there, but what stands in the files is not less open."""
    outside = "<id>300</id>"
    given = governance(OPEN, topic_rule(), domains=outside)
    (policy,), said = read(tmp_path, camera(outside), given)
    assert [len(one.topics) for one in policy.protections] == [2]
    assert ACCESS_GAP in [one.code for one in said]
    assert [one.code for one in read(tmp_path, camera(outside))[1]] == [ACCESS_GAP]


def test_each_governance_governs_the_domains_of_its_rules(tmp_path: Path) -> None:
    wide, middle = ("<id_range><min>{}</min><max>{}</max></id_range>".format(*ends) for ends in ((0, 9), (1, 6)))
    texts = camera(wide), of(0), of(7, OPEN, topic_rule()), governance(domains=middle), of(8), of(9)
    for domain, is_open in ((None, True), (7, True), (8, False)):
        policies, said = read(tmp_path, *texts, domain=domain, view="enforced")
        assert any("rt/video: permissions are not asked" in one.message for one in said) == is_open
        [granted] = [policy for policy in policies if policy.file in dict(policy.sources)]
        assert any(name.endswith("f2.xml") for name, _ in granted.sources) == is_open
        assert any(grant.place.file.endswith("f2.xml") for policy in policies for grant in policy.grants) == is_open


def test_two_governances_of_one_domain_that_differ_are_told_and_what_either_leaves_open_counts(tmp_path: Path) -> None:
    strict, lax = of(0), of(0, OPEN, topic_rule())
    for texts in ((camera(), strict, lax), (camera(), lax, strict)):
        said = read(tmp_path, *texts)[1]
        [conflict] = [line for line in told(said, tmp_path) if "something else" in line]
        assert conflict.startswith("f1.xml:2: domain 0: f2.xml:2 says something else, and which of them holds is not")
        assert [one.code for one in said if "not asked" in one.message] == [ACCESS_GAP]
    assert read(tmp_path, camera(), strict, strict)[1] == ()


def test_a_governance_of_other_domains_is_not_used_and_told(tmp_path: Path) -> None:
    _, said = read(tmp_path, camera(), of(0), of(5, OPEN, topic_rule()))
    what = "f2.xml: governance of domains that no permissions named here are about: it is not used"
    assert told(said, tmp_path) == [f"{what}; name their permissions, or leave it out"]


def test_governance_without_permissions_is_an_error(cli: Cli, folder: Path) -> None:
    (folder / "p.xml").write_text(POLICY)
    for names in (("governance.xml",), ("governance.xml", "p.xml")):
        done = cli("analyze", *names, "--allow-unsigned", cwd=folder)
        assert done.returncode == 2
        assert "governance.xml: governance without permissions: it does not say who may do what;" in done.stderr
    done = cli("analyze", "governance.xml", cwd=folder)
    assert done.returncode == 2
    assert "governance by itself: nothing says who may sign it" in done.stderr


def test_permissions_of_domains_that_have_nothing_in_common_are_told(tmp_path: Path) -> None:
    texts = camera(), uplink(domains="<id>5</id>"), of(0), of(5)
    [line] = told(read(tmp_path, *texts)[1], tmp_path)
    assert "f1.xml:3: permissions for domain 5, and in " in line
    assert line.endswith("for domain 0: they are read as if they were in one domain; say which with --domain N")
    only = read(tmp_path, *texts, domain=5)
    assert [grant.enclave for policy in only[0] for grant in policy.grants] == ["/uplink"]


def test_the_library_a_fleet_and_check_take_them(cli: Cli, folder: Path) -> None:
    (folder / "b/permissions.xml").write_text(uplink("rt/video", "rt/other"))
    names = [str(folder / name) for name in FILES]
    assert rosprivacy.analyze(names, str(folder / "labels.yaml"), allow_unsigned=True).analysis.verdict == "leak"
    fleet = folder / "fleet.yaml"
    fleet.write_text(f"fleet: 1\nrobots: {{r1: {{policies: [{', '.join(FILES)}], labels: [labels.yaml]}}}}\n")
    assert rosprivacy.analyze_fleet(fleet, allow_unsigned=True).analysis.verdict == "leak"
    with pytest.raises(InputErrors, match="governance by itself"):
        rosprivacy.analyze_fleet(fleet)
    (folder / "p.xml").write_text(POLICY)
    done = cli("check", "p.xml", *FILES, "--allow-unsigned", "-f", "json", cwd=folder)
    assert done.returncode == 1
    assert [(one["enclave"], one["only_in"]) for one in json.loads(done.stdout)["differences"]] == [
        ("/uplink", "deployed"),
        ("/uplink", "deployed"),
    ]


@pytest.mark.parametrize(
    ("name", "what"), [("x.xml", "it is"), ("x.p7s", "1 file is (x.p7s)"), ("x.bak", "1 file is (x.bak)")]
)
def test_such_a_file_in_a_folder_of_policies_is_a_gap(cli: Cli, folder: Path, name: str, what: str) -> None:
    mixed = folder / "mixed"
    mixed.mkdir()
    (mixed / "p.xml").write_text(POLICY)
    (mixed / name).write_text(uplink())
    (folder / "camera.yaml").write_text(
        "labels: 1\nnodes: {/camera: {source: [Video], leak: none}}\nchannels: {/video: sensitive}\n"
    )
    done = cli("analyze", "mixed", "-l", "camera.yaml", "--save-graph", "g.json", cwd=folder)
    assert done.returncode == 4
    where = "mixed/x.xml:2" if name == "x.xml" else "mixed"
    said = f"{where}: not read: {what} permissions or governance, and what that grants is not known; name it"
    assert said in done.stdout
    (mixed / name).unlink()
    assert said in cli("analyze", "--add", "g.json", "-l", "camera.yaml", cwd=folder).stdout
    alone = cli("analyze", "mixed", "-l", "camera.yaml", cwd=folder)
    assert (alone.returncode, said in alone.stdout) == (0, False)


@pytest.mark.corpus
def test_files_of_others_are_told_apart_by_what_is_in_them(corpus: Path) -> None:
    folder = corpus / "dds/OpenDDS__OpenDDS/tests/DCPS/Messenger"
    names = [str(folder / name) for name in ("permissions_1.xml", "governance.xml")]
    policies, said = read_deployed(names, 4, TODAY, allow_unsigned=True)
    assert [policy.file for policy in policies] == [names[0]]
    assert not [one for one in said if "no governance" in one.message]
