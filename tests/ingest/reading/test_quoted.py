"""No message repeats what stands in a file that is not ours: a fleet file can name anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import Cli, cli
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["cli"]

FACTORY = ROOT / "examples" / "factory"
POLICY, LABELS = str(FACTORY / "before.policy.xml"), str(FACTORY / "run2.labels.yaml")
KEPT = {
    "shadow": "root:$6$SECRETabc:19000:0:99999:7:::\ndaemon:$6$SECRETdef:19000:0:::\n",
    "one line of shadow": "root:$6$SECRETabc:19000:0:99999:7:::\n",
    "a word": "SECRETkey0123456789\n",
    "a pair": "password: SECRETvalue\n",
    "pairs": "- user: SECRETuser\n  password: 'SECRETvalue\n",
    "JSON": '{"password": "SECRETjson", "SECRETkey": [1]}',
    "broken JSON": '{"password": "SECRETjson", "x": SECRETbad',
    "a list": "[SECRETone, SECRETtwo]\n",
    "a private key": "-----BEGIN OPENSSH PRIVATE KEY-----\nSECRETb3BlbnNzaC1rZXk=\n-----END OPENSSH PRIVATE KEY-----\n",
    "XML": '<config><entry password="SECRETattribute">SECRETtext</entry></config>',
    "broken XML": '<config><entry password="SECRETattribute">SECRETtext</config>',
    "no UTF-8": "password: SECRET\udcff\n",
    "a query": "RETURN 'SECRETtext\n",
}
READERS = {
    "policy": ["analyze", "kept", "-l", LABELS],
    "labels": ["analyze", POLICY, "-l", "kept"],
    "fleet": ["analyze", "--fleet", "kept"],
    "include of a fleet": ["analyze", "--fleet", "include.yaml"],
    "labels of a fleet": ["analyze", "--fleet", "labels.yaml"],
    "policies of a fleet": ["analyze", "--fleet", "policies.yaml"],
    "decisions": ["analyze", POLICY, "-l", LABELS, "--decisions", "kept"],
    "limits": ["mitigate", POLICY, "-l", LABELS, "--limits", "kept"],
    "standard channels": ["analyze", POLICY, "-l", LABELS, "--standard-channels", "kept"],
    "ontology": ["categories", "--ontology", "kept"],
    "graph": ["graph", "--add", "kept", POLICY],
    "state": ["diff", "kept", POLICY],
    "analysis": ["report", POLICY, "-l", LABELS, "--since", "kept"],
}
FLEETS = {
    "include.yaml": "fleet: 1\ninclude: [kept]\n",
    "labels.yaml": "fleet: 1\nrobots:\n  a: {policies: policy.xml, labels: kept}\n",
    "policies.yaml": "fleet: 1\nrobots:\n  a: {policies: kept}\n",
}


@pytest.mark.parametrize("reader", READERS)
def test_no_message_repeats_what_stands_in_a_file_that_is_not_ours(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reader: str
) -> None:
    if reader == "ontology":
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "policy.xml").write_bytes((FACTORY / "before.policy.xml").read_bytes())
    for name, text in FLEETS.items():
        (tmp_path / name).write_text(text, "utf-8")
    for kept, text in KEPT.items():
        (tmp_path / "kept").write_text(text, "utf-8", errors="surrogateescape")
        done = cli(*READERS[reader], cwd=tmp_path)
        assert (done.returncode, done.stdout, bool(done.stderr)) == (2, "", True), kept
        assert "Traceback" not in done.stderr, kept
        assert "SECRET" not in done.stderr, kept
