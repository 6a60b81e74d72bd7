"""Each rule of ``lint``: what breaks it at which line, and what does not."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import TYPE_CHECKING

import jsonschema
import pytest

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.ingest.lint.enclave_rules import MOST, permissions_sizes
from rosprivacy.ingest.lint.rule_table import OF_LABELS, RULES
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.policies.linting import lint_policies
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


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (of(TALKS), []),
        (of(topics("/cam*")), [(6, "wildcard")]),
        (of(topics("*")), [(6, "wildcard-everything")]),
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
    ],
)  # fmt: skip
def test_a_rule_is_broken_at_its_line(tmp_path: Path, text: str, expected: list[tuple[int, str]]) -> None:
    assert broken(tmp_path, text) == expected


def test_an_include_that_brings_nothing(tmp_path: Path) -> None:
    (tmp_path / "f.xml").write_text("<profile/>")
    include = '<xi:include href="f.xml" xpointer="xpointer(/profile/topics)"/>'
    assert broken(tmp_path, of(f"{TALKS}{include}")) == [(6, "empty-include")]


def included(folder: Path, name: str, *bodies: str) -> str:
    """Write a fragment; return the include of all in it."""
    (folder / name).write_text(f"<profile {XI}>\n" + "\n".join(bodies) + "\n</profile>")
    return f'<xi:include href="{name}" xpointer="xpointer(/profile/*)"/>'


def test_an_include_that_brings_groups_that_grant_nothing(tmp_path: Path) -> None:
    include = included(tmp_path, "f.xml", "<topics><topic>/u</topic></topics>")
    found = broken(tmp_path, of(f"{TALKS}\n{include}"))
    assert found == [(2, "empty-group"), (7, "empty-include")]  # the group at its line of the fragment


def test_an_include_that_brings_metadata_only(tmp_path: Path) -> None:
    (tmp_path / "f.xml").write_text("<profile><metadata><note/></metadata></profile>")
    assert broken(tmp_path, of(f'{TALKS}<xi:include href="f.xml" xpointer="xpointer(/profile/*)"/>')) == []


def test_the_same_fragment_twice_in_a_profile(tmp_path: Path) -> None:
    include = included(tmp_path, "f.xml", topics("/u"))
    assert broken(tmp_path, of(f"{include}\n{TALKS}\n{include}")) == [(8, "repeated-include")]
    apart = policy(enclave(profile(include)), enclave(profile(include, node="b"), path="/f"))
    assert broken(tmp_path, apart) == []


def test_a_fragment_that_another_include_brings_already(tmp_path: Path) -> None:
    inner = included(tmp_path, "inner.xml", topics("/u"))
    outer = included(tmp_path, "outer.xml", inner, topics("/v"))
    assert broken(tmp_path, of(f"{outer}\n{inner}")) == [(7, "repeated-include")]
    assert broken(tmp_path, of(f"{inner}\n{outer}")) == [(6, "needless-include")]


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
    include = included(tmp_path, "f.xml", topics("/u"))
    found = [(line, rule) for line, rule in broken(tmp_path, of(f"{include}\n{beside}")) if "include" in rule]
    assert found == ([(6, "needless-include")] if needless else [])


def test_of_two_fragments_that_say_the_same_one_is_needless(tmp_path: Path) -> None:
    both = "\n".join(included(tmp_path, name, topics("/u")) for name in ("f.xml", "g.xml"))
    assert broken(tmp_path, of(both)) == [(7, "needless-include")]


def test_an_include_in_an_included_profile(tmp_path: Path) -> None:
    include = included(tmp_path, "f.xml", topics("/u"))
    (tmp_path / "all.xml").write_text(f"<profiles {XI}>\n" + profile(f"{include}\n{include}") + "\n</profiles>")
    text = policy('<enclave path="/e"><xi:include href="all.xml"/></enclave>')
    assert broken(tmp_path, text) == [(4, "repeated-include")]


def test_a_relative_name_of_a_fragment_that_goes_wrong_in_a_namespace(tmp_path: Path) -> None:
    include = included(tmp_path, "f.xml", topics("scan"))
    hears = topics("/scan", 'subscribe="ALLOW"')
    front, back = profile(include), profile(include, ns="/r")
    reader = profile(hears, node="c")
    found = broken(tmp_path, policy(enclave(front), enclave(back, path="/f"), enclave(reader, path="/g")))
    assert found == [(2, "relative-shared-name")]
    for other in ("/r/scan", "/r/*"):
        both = profile(topics("/scan", 'subscribe="ALLOW"') + topics(other, 'subscribe="ALLOW"'), node="c")
        fine = broken(tmp_path, policy(enclave(front), enclave(back, path="/f"), enclave(both, path="/g")))
        assert "relative-shared-name" not in {rule for _, rule in fine}
    private = included(tmp_path, "f.xml", topics("~/scan"))
    own = policy(enclave(profile(private)), enclave(profile(private, ns="/r"), path="/f"))
    assert broken(tmp_path, own) == []


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


def test_a_namespace_that_does_not_begin_with_a_slash(tmp_path: Path) -> None:
    assert broken(tmp_path, of(TALKS, "r")) == [(5, "odd-namespace")]


def test_lines_that_stand_for_many_names_are_told_once(tmp_path: Path) -> None:
    include = included(tmp_path, "f.xml", topics("rosout"))
    text = policy(*(enclave(profile(include, ns=f"/r{at}"), path=f"/e{at}") for at in range(5)))
    file = tmp_path / "p.policy.xml"
    file.write_text(text)
    [breach] = lint_policies((str(file),), (), Settings()).breaches
    assert breach.message == (
        "publish /r0/rosout, /r1/rosout, /r2/rosout, …: nodes use /rosout, whatever their namespace; write it so"
    )
    both = 'publish="ALLOW" subscribe="ALLOW"'
    assert broken(tmp_path, of(topics("*", both))) == [(6, "wildcard-everything")]


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


def test_an_enclave_that_a_policy_includes_from_another_is_one_statement(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(of(TALKS))
    whole = f'<policy version="0.2.0" {XI}><enclaves>'
    whole += '<xi:include href="a.xml" xpointer="xpointer(/policy/enclaves/*)"/></enclaves></policy>'
    (tmp_path / "b.xml").write_text(whole)
    assert lint_policies((str(tmp_path),), (), Settings()).breaches == ()


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


def test_a_fragment_that_nothing_includes(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(TALKS))
    (tmp_path / "f.xml").write_text(f"<profile>{TALKS}</profile>")
    found = lint_policies((str(tmp_path),), (), Settings()).breaches
    assert [(b.place.file.rpartition("/")[2], b.rule.name) for b in found] == [("f.xml", "unused-file")]


def test_an_enclave_that_two_files_state(tmp_path: Path) -> None:
    for name in "ab":
        (tmp_path / f"{name}.xml").write_text(of(TALKS))
    assert {b.rule.name for b in lint_policies((str(tmp_path),), (), Settings()).breaches} == {"shared-enclave"}


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


def test_permissions_that_do_not_fit_into_the_handshake(tmp_path: Path) -> None:
    many = "".join(f"<topic>/a_rather_long_name_of_a_topic_{i}</topic>" for i in range(1_000))
    found = broken(tmp_path, of(f'<topics publish="ALLOW">{many}</topics>'))
    assert [name for _, name in found] == ["large-permissions"]
    few = "".join(f"<topic>/a_rather_long_name_of_a_topic_{i}</topic>" for i in range(500))
    assert broken(tmp_path, of(f'<topics publish="ALLOW">{few}</topics>')) == []


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
    assert max(sizes.values()) < MOST


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


def test_a_mere_notice_ends_with_0(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy(enclave(profile(), profile(node="b"))))
    done = cli("lint", "p.xml", cwd=tmp_path)
    assert (done.returncode, "notice crowded-enclave" in done.stdout) == (0, True)


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
    assert all(f'"{name}"' in (ROOT / "tests/ingest/lint/test_lint.py").read_text("utf-8") for name in RULES)


def test_there_is_no_rule_of_another_name() -> None:
    with pytest.raises(InputError, match="no such rule"):
        lint_policies((), (), Settings(), select=("x",))
