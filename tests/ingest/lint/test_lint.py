"""Each rule of ``lint``: what breaks it at which line, and what does not."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import jsonschema
import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.lint.enclave_rules import MOST, permissions_sizes
from rosprivacy.ingest.lint.rule_table import RULES
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


def test_a_fragment_that_nothing_includes(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(of(TALKS))
    (tmp_path / "f.xml").write_text(f"<profile>{TALKS}</profile>")
    found = lint_policies((str(tmp_path),), (), Settings()).breaches
    assert [(b.place.file.rpartition("/")[2], b.rule.name) for b in found] == [("f.xml", "unused-file")]


def test_an_enclave_that_two_files_state(tmp_path: Path) -> None:
    for name in "ab":
        (tmp_path / f"{name}.xml").write_text(of(TALKS))
    assert {b.rule.name for b in lint_policies((str(tmp_path),), (), Settings()).breaches} == {"shared-enclave"}


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
    assert (none.returncode, none.stdout) == (0, "no rule is broken in 1 file\n")
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
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == list(RULES)
    [result] = run["results"]
    assert (result["ruleId"], result["level"]) == ("wildcard-everything", "error")
    assert result["locations"][0]["physicalLocation"]["region"] == {"startLine": 6}


def test_every_rule_is_broken_by_some_test() -> None:
    assert all(f'"{name}"' in (ROOT / "tests/ingest/lint/test_lint.py").read_text("utf-8") for name in RULES)


def test_there_is_no_rule_of_another_name() -> None:
    with pytest.raises(InputError, match="no such rule"):
        lint_policies((), (), Settings(), select=("x",))
