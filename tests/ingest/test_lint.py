"""Each rule of ``lint``: what breaks it at which line, and what does not."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import TYPE_CHECKING

import jsonschema
import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.lint import BOUND, OF_LABELS, RULES, permissions_sizes
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.linting import lint_policies
from rosprivacy.settings import Settings
from tests.helpers.command import cli
from tests.helpers.keystores import Keystore, grant, permissions, rule
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

TALKS = '<topics publish="ALLOW"><topic>/t</topic></topics>'
XI = 'xmlns:xi="http://www.w3.org/2001/XInclude"'


def profile(body: str = TALKS, node: str = "a", ns: str = "/") -> str:
    return f'<profile ns="{ns}" node="{node}">\n{body}\n</profile>'


def enclave(*profiles: str, path: str = "/e") -> str:
    return f'<enclave path="{path}">\n<profiles>\n' + "\n".join(profiles) + "\n</profiles>\n</enclave>"


def policy(*enclaves: str) -> str:
    return f'<policy version="0.2.0" {XI}>\n<enclaves>\n' + "\n".join(enclaves) + "\n</enclaves>\n</policy>\n"


def of(body: str, ns: str = "/") -> str:
    return policy(enclave(profile(body, ns=ns)))


def broken(folder: Path, text: str, labels: str = "") -> list[tuple[int, str]]:
    """(line, rule) of each broken rule."""
    file = folder / "p.policy.xml"
    file.write_text(text, encoding="utf-8")
    stated: tuple[str, ...] = ()
    if labels:
        (folder / "l.yaml").write_text(labels, encoding="utf-8")
        stated = (str(folder / "l.yaml"),)
    return [(b.place.line, b.rule.name) for b in lint_policies((str(file),), stated, Settings()).breaches]


def topics(name: str, role: str = 'publish="ALLOW"') -> str:
    return f"<topics {role}><topic>{name}</topic></topics>"


DENIED = TALKS + "\n" + topics("/t", 'publish="DENY"')
SECOND = '<enclave path="/e"><profiles>' + profile(topics("/u", 'publish="DENY"')) + "</profiles></enclave>"


LONG = [f"<topic>/a_rather_long_name_of_a_topic_{i}</topic>" for i in range(1_000)]
BROKEN: list[tuple[str, list[tuple[int, str]]]] = [
    (of(TALKS), []),
    (of(TALKS, "r"), [(5, "odd-namespace")]),
    (of(topics("/cam*")), [(6, "wildcard")]),
    (of(topics("*")), [(6, "wildcard-everything")]),
    (of(topics("*", 'publish="ALLOW" subscribe="ALLOW"')), [(6, "wildcard-everything")]),
    (of(topics("/cam*", 'publish="DENY"')), []),
    (of(topics("~x")), [(6, "mistaken-tilde")]),
    (of(topics("~/x")), []),
    (of(topics("rosout"), "/r"), [(6, "relative-standard-name")]),
    (of(topics("/rosout"), "/r"), []),
    (of(topics("rosout")), []),
    (of(topics("/a b")), [(6, "refused-name")]),
    (of("<topics><topic>/t</topic></topics>"), [(6, "empty-group")]),
    (of(DENIED), [(6, "overridden-allow")]),
    (policy(enclave(profile()), SECOND), [(10, "duplicate-enclave"), (11, "dead-deny")]),
    (policy(enclave(profile()).replace("</enclave>", f"<profiles>{profile()}</profiles>\n</enclave>")),
     [(9, "several-profiles")]),
    (policy(enclave(profile(), profile(node="b"))), [(5, "crowded-enclave")]),
    (of(f'{TALKS}<xi:include href="no.xml"><xi:fallback>{TALKS}</xi:fallback></xi:include>'),
     [(6, "missing-include")]),
    (of(f'<topics publish="ALLOW">{"".join(LONG)}</topics>'), [(5, "large-permissions")]),
    (of(f'<topics publish="ALLOW">{"".join(LONG[:500])}</topics>'), []),
]  # fmt: skip


@pytest.mark.parametrize("number", range(len(BROKEN)))
def test_a_rule_is_broken_at_its_line(tmp_path: Path, number: int) -> None:
    text, expected = BROKEN[number]
    assert broken(tmp_path, text) == expected


def include(name: str) -> str:
    """The include of all in a fragment."""
    return f'<xi:include href="{name}" xpointer="xpointer(/profile/*)"/>'


def fragment(*bodies: str) -> str:
    return f"<profile {XI}>\n" + "\n".join(bodies) + "\n</profile>"


F, G, INNER, OUTER, ALL = map(include, ("f.xml", "g.xml", "inner.xml", "outer.xml", "all.xml"))
ONE_TOPIC = {"f.xml": fragment(topics("/u")), "g.xml": fragment(topics("/u"))}
NESTED = {"inner.xml": fragment(topics("/u")), "outer.xml": fragment(INNER, topics("/v"))}
INCLUDED: dict[str, tuple[dict[str, str], str, list[tuple[int, str]]]] = {
    "nothing": (
        {"f.xml": "<profile/>"},
        of(TALKS + F.replace("/*)", "/topics)")),
        [(6, "empty-include")],
    ),
    "groups that grant nothing": (  # the group at its line of the fragment
        {"f.xml": fragment("<topics><topic>/u</topic></topics>")},
        of(f"{TALKS}\n{F}"),
        [(2, "empty-group"), (7, "empty-include")],
    ),
    "metadata only": ({"f.xml": "<profile><metadata><note/></metadata></profile>"}, of(TALKS + F), []),
    "the same twice": (ONE_TOPIC, of(f"{F}\n{TALKS}\n{F}"), [(8, "repeated-include")]),
    "the same in two profiles": (ONE_TOPIC, policy(enclave(profile(F)), enclave(profile(F, node="b"), path="/f")), []),
    "what another include brings, before": (NESTED, of(f"{OUTER}\n{INNER}"), [(7, "repeated-include")]),
    "what another include brings, after": (NESTED, of(f"{INNER}\n{OUTER}"), [(6, "needless-include")]),
    "what another fragment says": (ONE_TOPIC, of(f"{F}\n{G}"), [(7, "needless-include")]),
    "in an included profile": (
        {**ONE_TOPIC, "all.xml": f"<profiles {XI}>\n" + profile(f"{F}\n{F}") + "\n</profiles>"},
        policy('<enclave path="/e"><xi:include href="all.xml"/></enclave>'),
        [(4, "repeated-include")],
    ),
}


@pytest.mark.parametrize("name", INCLUDED)
def test_an_include_that_brings(tmp_path: Path, name: str) -> None:
    files, text, expected = INCLUDED[name]
    for file, written in files.items():
        (tmp_path / file).write_text(written)
    assert broken(tmp_path, text) == expected


@pytest.mark.parametrize(
    ("beside", "needless"),
    [
        (topics("/u"), True),
        (topics("/u") + topics("/more"), True),
        (topics("u"), True),  # the same name in the namespace /
        (topics("/u", 'subscribe="ALLOW"'), False),
        (topics("/u", 'publish="DENY"'), False),
        (topics("/v"), False),
        (topics("/*"), False),
    ],
)
def test_an_include_of_which_every_line_is_there_already(tmp_path: Path, beside: str, *, needless: bool) -> None:
    (tmp_path / "f.xml").write_text(ONE_TOPIC["f.xml"])
    found = [(line, rule) for line, rule in broken(tmp_path, of(f"{F}\n{beside}")) if "include" in rule]
    assert found == ([(6, "needless-include")] if needless else [])


def test_a_relative_name_of_a_fragment_that_goes_wrong_in_a_namespace(tmp_path: Path) -> None:
    (tmp_path / "f.xml").write_text(fragment(topics("scan")))
    hears = topics("/scan", 'subscribe="ALLOW"')
    front, back = profile(F), profile(F, ns="/r")
    reader = profile(hears, node="c")
    found = broken(tmp_path, policy(enclave(front), enclave(back, path="/f"), enclave(reader, path="/g")))
    assert found == [(2, "relative-shared-name")]
    for other in ("/r/scan", "/r/*"):
        both = profile(topics("/scan", 'subscribe="ALLOW"') + topics(other, 'subscribe="ALLOW"'), node="c")
        fine = broken(tmp_path, policy(enclave(front), enclave(back, path="/f"), enclave(both, path="/g")))
        assert "relative-shared-name" not in {rule for _, rule in fine}
    (tmp_path / "f.xml").write_text(fragment(topics("~/scan")))
    assert broken(tmp_path, policy(enclave(front), enclave(back, path="/f"))) == []


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (of(TALKS).replace("<policy ", '<policy xmlns="http://ros2.org/sros2/policy" '), 1),
        ('<policy version="0.1.0">\n<profiles>' + profile() + "</profiles></policy>", 2),
        (policy(enclave(profile())).replace("enclaves>", "contexts>").replace("enclave", "context"), 2),
    ],
)
def test_a_form_that_sros2_refuses(tmp_path: Path, text: str, line: int) -> None:
    found = broken(tmp_path, text)
    assert (line, "refused-policy") in found
    assert {rule for _, rule in found} == {"refused-policy"}


def test_lines_that_stand_for_many_names_are_told_once(tmp_path: Path) -> None:
    (tmp_path / "f.xml").write_text(fragment(topics("rosout")))
    text = policy(*(enclave(profile(F, ns=f"/r{at}"), path=f"/e{at}") for at in range(5)))
    file = tmp_path / "p.policy.xml"
    file.write_text(text)
    [breach] = lint_policies((str(file),), (), Settings()).breaches
    assert breach.message == (
        "publish /r0/rosout, /r1/rosout, /r2/rosout, …: nodes use /rosout, whatever their namespace; write it so"
    )


def test_what_cannot_be_looked_at_without_labels_is_said(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(TALKS))
    said = "mixed-enclave was not looked at: it needs labels; name them with -l\n"
    assert cli("lint", "p.xml", cwd=tmp_path).stdout == f"no rule is broken in 1 file\n{said}"
    assert json.loads(cli("lint", "p.xml", "-f", "json", cwd=tmp_path).stdout)["not_looked_at"] == ["mixed-enclave"]
    assert said not in cli("lint", "p.xml", "--ignore", "mixed-enclave", cwd=tmp_path).stdout
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes: {/a: {source: [Video]}}\n")
    assert said not in cli("lint", "p.xml", "-l", "l.yaml", cwd=tmp_path).stdout
    chosen = cli("lint", "p.xml", "--select", "mixed-enclave", cwd=tmp_path)
    assert (chosen.returncode, chosen.stderr) == (
        2, "mixed-enclave: this rule needs labels; name a label file with -l\n"
    )  # fmt: skip


@pytest.mark.corpus
def test_real_policies_break_what_a_developer_would_mend(corpus: Path) -> None:
    """Fragments that are used as they are meant break no rule of includes (TurtleBot3, RMF, sros2)."""
    found: dict[str, set[str]] = {}
    for folder in sorted((corpus / "policies").iterdir()):
        for file in sorted(folder.rglob("*.xml")):
            with suppress(InputErrors):
                linted = lint_policies((str(file),), (), Settings(include_root=str(folder)))
                for breach in linted.breaches:
                    found.setdefault(breach.rule.name, set()).add(folder.name.partition("@")[0])
    assert not {rule for rule in found if "include" in rule}
    assert found["refused-policy"] == {"ADMAS-project__ADMAS-V1", "ros2__sros2"}
    assert found["relative-standard-name"] == found["large-permissions"] == {"ros-swg__turtlebot3_demo"}


@pytest.mark.parametrize(
    ("files", "found"),
    [
        ({"p.xml": of(TALKS), "f.xml": f"<profile>{TALKS}</profile>"}, {("f.xml", "unused-file")}),
        ({"a.xml": of(TALKS), "b.xml": of(TALKS)}, {("a.xml", "shared-enclave")}),
        (  # an enclave that a policy includes from another is one statement
            {
                "a.xml": of(TALKS),
                "b.xml": policy('<xi:include href="a.xml" xpointer="xpointer(/policy/enclaves/*)"/>'),
            },
            set(),
        ),
    ],
)
def test_files_of_a_folder(tmp_path: Path, files: dict[str, str], found: set[tuple[str, str]]) -> None:
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    breaches = lint_policies((str(tmp_path),), (), Settings()).breaches
    assert {(breach.place.file.rpartition("/")[2], breach.rule.name) for breach in breaches} == found


def test_a_second_grant_of_a_subject_in_permissions(tmp_path: Path) -> None:
    file = tmp_path / "permissions.xml"
    file.write_text(permissions(grant("/e", rule("allow", publish=("rt/a",))), grant("/e")))
    found = lint_policies((str(file),), (), Settings(allow_unsigned=True)).breaches
    line = 1 + next(n for n, text in reversed([*enumerate(file.read_text().splitlines())]) if "<grant" in text)
    assert [(b.place.line, b.rule.name) for b in found] == [(line, "several-profiles")]


def test_a_deny_of_permissions_that_comes_too_late(tmp_path: Path) -> None:
    """DDS-Security 1.1, 9.4.1.3.2.3: the first rule that matches decides."""
    allow, deny = rule("allow", publish=("rt/a/*",)), rule("deny", publish=("rt/a/b", "rt/c"), subscribe=("rt/a/b",))
    file = tmp_path / "permissions.xml"
    found = {}
    for order in ((allow, deny), (deny, allow)):
        file.write_text(permissions(grant("/e", *order)))
        said = lint_policies((str(file),), (), Settings(allow_unsigned=True)).breaches
        lines = file.read_text().splitlines()
        found[order] = [(lines[b.place.line - 1], b.rule.name) for b in said if b.rule.name == "dead-deny"]
    assert list(found.values()) == [[("<topic>rt/a/b</topic>", "dead-deny")], []]


def test_an_enclave_that_mixes_a_source_and_a_leak(tmp_path: Path) -> None:
    text = policy(enclave(profile(), profile(node="b")))
    labels = "labels: 1\nnodes: {/a: {source: [Video]}, /b: {leak: [Voice]}}\n"
    assert "mixed-enclave" in {name for _, name in broken(tmp_path, text, labels)}
    assert "mixed-enclave" not in {name for _, name in broken(tmp_path, text)}
    apart = policy(enclave(profile()), enclave(profile(node="b"), path="/f"))
    assert "mixed-enclave" not in {name for _, name in broken(tmp_path, apart, labels)}


@pytest.mark.corpus
@pytest.mark.parametrize("name", ["sample", "single_context", "minimal_action", "talker_listener", "add_two_ints"])
def test_the_size_of_permissions_is_that_of_the_files_of_sros2(corpus: Path, name: str, tmp_path: Path) -> None:
    folder = corpus / "policies/ros2__sros2/sros2/test/policies"
    sizes = permissions_sizes(read_policy(str(folder / f"{name}.policy.xml"), include_root=str(folder)).grants)
    written = corpus / "dds/ros2__sros2/sros2/test/policies/permissions" / name / "permissions.xml"
    keystore = Keystore(tmp_path / "k")
    keystore.sign(permissions(grant("/x", rule("allow", publish=("rt/x",)))), tmp_path / "s.p7s")
    signature = (tmp_path / "s.p7s").stat().st_size - (tmp_path / "s.xml").stat().st_size
    real = written.stat().st_size + len(sizes) * signature
    assert sum(sizes.values()) == pytest.approx(real, rel=0.03)
    assert max(sizes.values()) < BOUND


def test_select_and_ignore_choose_rules_by_name(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(topics("*") + topics("~x")))
    assert cli("lint", "p.xml", cwd=tmp_path).returncode == 1
    only = cli("lint", "p.xml", "--select", "mistaken-tilde", cwd=tmp_path)
    assert [line.split(": ")[1] for line in only.stdout.splitlines() if line.startswith("p.xml")] == [
        "warning mistaken-tilde"
    ]
    none = cli("lint", "p.xml", "--ignore", "mistaken-tilde", "--ignore", "wildcard-everything", cwd=tmp_path)
    assert (none.returncode, none.stdout.splitlines()[0]) == (0, "no rule is broken in 1 file")
    wrong = cli("lint", "p.xml", "--select", "wild", cwd=tmp_path)
    assert (wrong.returncode, wrong.stderr[:19]) == (2, "wild: no such rule;")
    (tmp_path / "p.xml").write_text(policy(enclave(profile(), profile(node="b"))))
    notice = cli("lint", "p.xml", cwd=tmp_path)
    assert (notice.returncode, "notice crowded-enclave" in notice.stdout) == (0, True)


def test_json_keeps_its_contract(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(topics("*")))
    document = json.loads(cli("lint", "p.xml", "--format", "json", cwd=tmp_path).stdout)
    jsonschema.validate(document, json.loads((ROOT / "docs/lint.schema.json").read_text("utf-8")))
    assert [(b["rule"], b["line"]) for b in document["breaches"]] == [("wildcard-everything", 6)]


def test_sarif_has_all_rules_and_each_breach_at_its_line(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(topics("*")))
    [run] = json.loads(cli("lint", "p.xml", "--format", "sarif", cwd=tmp_path).stdout)["runs"]
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == [r for r in RULES if r not in OF_LABELS]
    [result] = run["results"]
    assert (result["ruleId"], result["level"]) == ("wildcard-everything", "error")
    assert result["locations"][0]["physicalLocation"]["region"] == {"startLine": 6}


def test_every_rule_is_broken_by_some_test() -> None:
    assert all(f'"{name}"' in (ROOT / "tests/ingest/test_lint.py").read_text("utf-8") for name in RULES)
