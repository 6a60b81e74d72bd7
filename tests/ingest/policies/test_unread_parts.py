"""What of a folder was not read, in whole or in part, is never forgotten (rule S11): cases of the second hunt."""

from __future__ import annotations

import bz2
import gzip
import json
import lzma
import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

CAMERA = """<policy version="0.2.0"><enclaves><enclave path="/camera"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave></enclaves></policy>
"""
READS = '<topics subscribe="ALLOW"><topic>/video</topic></topics>'
FRAGMENT = f"<profile>{READS}</profile>"
HALF = f'<profile>{READS}<services reply="ALLOW"><service>/s</service></services></profile>'
PART = """<policy version="0.2.0" xmlns:xi="http://www.w3.org/2001/XInclude"><enclaves><enclave path="/x"><profiles>
<profile ns="/" node="x"><xi:include href="f.xml" xpointer="xpointer(/profile/services)"/>
<topics publish="ALLOW"><topic>/q</topic></topics></profile></profiles></enclave></enclaves></policy>
"""
WHOLE = PART.replace("/profile/services", "/profile/*")


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d").mkdir()
    Path("d/p.xml").write_text(CAMERA, "utf-8")
    labels = 'labels: 1\nnodes: {/camera: {source: [Video], leak: none}, "/x*": conduit}\nchannels: {"/*": sensitive}\n'
    Path("l.yaml").write_text(labels.replace(', "/x*": conduit', ""), "utf-8")
    Path("x.yaml").write_text(labels.replace('"/x*"', "/x"), "utf-8")


def verdict(cli: Cli, *arguments: str) -> tuple[str, str]:
    document = json.loads(cli("analyze", *arguments, "-f", "json").stdout)
    return document["verdict"], " ".join(d["message"] for d in document["diagnostics"])


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        ({"f.xml": FRAGMENT}, "not read: "),  # nothing includes it
        ({"f.xml": HALF, "q.xml": PART}, "includes what stands at line 1"),  # a policy takes a part only
        ({"f.xml": FRAGMENT, "q.xml": PART}, "not read whole"),  # the include selects nothing
        ({"f.xml": HALF, "q.xml": WHOLE}, ""),
        # grants under another root are grants that were not read
        ({"f.xml": f"<policies>{CAMERA}</policies>"}, "what it grants is not known"),
        ({"f.xml": CAMERA.replace("policy", "Policy")}, "what it grants is not known"),
        ({"f.xml": f"<x>{FRAGMENT}</x>"}, "what it grants is not known"),
        # XML of another kind is a notice
        ({"robot.launch.xml": '<launch><include file="x.xml"/><topics><topic>/a</topic></topics></launch>'}, ""),
    ],
)
def test_grants_that_nothing_brings_in_leave_it_undetermined(cli: Cli, files: dict[str, str], expected: str) -> None:
    for name, text in files.items():
        Path("d", name).write_text(text, "utf-8")
    got, said = verdict(cli, "d", "-l", "x.yaml" if "q.xml" in files else "l.yaml")
    assert got == ("undetermined" if expected else "no-leak-found")
    assert expected in said


def test_a_saved_graph_keeps_what_was_not_read_until_a_policy_includes_it(cli: Cli) -> None:
    """One answer: what is undetermined from the files is so from the graph."""
    Path("d/f.xml").write_text(FRAGMENT, "utf-8")
    assert cli("analyze", "d", "-l", "l.yaml", "--save-graph", "g.json", "-o", "o.txt").returncode == 4
    got, said = verdict(cli, "--add", "g.json", "-l", "l.yaml")
    assert (got, "no policy read here includes it" in said) == ("undetermined", True)
    Path("d/r.xml").write_text(WHOLE, "utf-8")
    got, said = verdict(cli, "d/r.xml", "--add", "g.json", "-l", "x.yaml")
    assert (got, "includes it" in said) == ("no-leak-found", False)


UPLINK = CAMERA.replace("/camera", "/up").replace('"camera"', '"uplink"').replace("publish", "subscribe")
LIST = """{{{0}mode{0}: "peer", // of "access_control:" nothing is said here
  {0}access_control{0}: {{"enabled": true, "default_permission": "deny", "rules": [], "subjects": [], "policies": []}}}}
"""
UNREAD = ("unread-file", "access-gap")
SIGNED = 'MIME-Version: 1.0\nContent-Type: multipart/signed; boundary="x"\n\n--x\n<dds><permissions/></dds>\n'


@pytest.mark.parametrize(
    ("name", "data"),
    [
        *((name, UPLINK) for name in ("up.policy", "up.xml.in", "up.xml.bak", "up", "up.XML~", "up.xhtml")),
        *((name, UPLINK) for name in (".up.policy", "up.json5", "up.yaml", "deep/.er/up.txt")),
        ("up.xml.erb", f"<%# made by\na template %>\n@HEADER@\n{{% set x = 1 %}}\n# text\n{UPLINK}"),
        ("up.xml.in", f'<?xml version="1.0"?>\n<!-- {"long " * 2000}-->\n<!DOCTYPE policy>\n{UPLINK}'),
        ("up.utf16", UPLINK.encode("utf-16")),
        ("up.bom", b"\xef\xbb\xbf" + UPLINK.encode()),
        ("up.xml.gz", gzip.compress(UPLINK.encode())),
        ("up.xml.bz2", bz2.compress(UPLINK.encode())),
        ("up.xml.xz", lzma.compress(UPLINK.encode())),
        ("node.inc", FRAGMENT),
        ("up.policy", UPLINK.replace("<policy ", '<s:policy xmlns:s="x" ').replace("</policy>", "</s:policy>")),
        ("up.json5", LIST.format("")),
        ("up.json", LIST.format('"').replace('// of "access_control:" nothing is said here', "")),
        ("up.txt", LIST.format("'")),
        ("up.yaml", "# a session\nmode: peer\naccess_control:\n  enabled: true\n"),
        ("permissions.signed", SIGNED),
        ("permissions", "<?xml version='1.0'?>\n<dds>\n<permissions/></dds>"),
        ("governance", "<dds><domain_access_rules/></dds>"),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 20 else "",
)  # fmt: skip
def test_what_is_a_policy_by_its_content_is_not_passed_over(cli: Cli, name: str, data: str | bytes) -> None:
    """Rule S11: whatever its name ends in."""
    file = Path("d", name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(data.encode() if isinstance(data, str) else data)
    for argument in ("d", "[d]"):
        done = cli("analyze", argument, "-l", "l.yaml", "-f", "json")
        document = json.loads(done.stdout)
        (told,) = [said for said in document["diagnostics"] if said.get("code") in UNREAD]
        assert (done.returncode, document["verdict"], told["severity"]) == (4, "undetermined", "warning")
        assert name in f"{told['file']} {told['message']}"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("README.md", f"# How policies look\n\nLike this:\n{UPLINK}"),
        ("page.html", f"<!DOCTYPE html>\n<html><pre>{FRAGMENT}</pre></html>"),
        ("session.json5", "{ // access_control: {}\n /* access_control: {} */ mode: 'peer', x: {access_control: 1} }"),
        ("notes.txt", "Note that\naccess_control: is not here"),
        ("profiles.txt", "<dds><profiles/></dds>"),
        ("key.pem", UPLINK),  # a key is never opened
        ("half.gz", "\x1f\x8b"),
        ("empty", ""),
        ("labels.yaml", "labels: 1\n"),
    ],
    ids=lambda value: value if len(value) < 20 else "",
)
def test_what_is_none_is_counted_and_changes_nothing(cli: Cli, name: str, text: str) -> None:
    Path("d", name).write_bytes(text.encode("latin-1"))
    got, said = verdict(cli, "d", "-l", "l.yaml")
    assert got == "no-leak-found"
    assert f"1 file is not read, as the name does not end in .xml: {name}" in said


def test_what_is_read_is_not_told_as_unread(cli: Cli) -> None:
    Path("d/up.policy").write_text(UPLINK, "utf-8")
    Path("d/f.inc").write_text(HALF, "utf-8")
    Path("d/q.xml").write_text(WHOLE.replace("f.xml", "f.inc"), "utf-8")
    Path("d/link").symlink_to("up.policy")
    document = json.loads(cli("analyze", "d", "d/up.policy", "-l", "x.yaml", "-f", "json").stdout)
    assert not [said for said in document["diagnostics"] if said.get("code") in UNREAD]


def test_a_file_that_may_not_be_opened_or_has_no_end_is_not_waited_for(cli: Cli) -> None:
    os.mkfifo("d/up.policy")
    Path("d/none").symlink_to("/dev/zero")
    assert cli("analyze", "d", "-l", "l.yaml").returncode == 0


def test_an_output_in_the_folder_is_written_again(cli: Cli) -> None:
    """What was only looked at is not read, so it may be written over."""
    for _ in range(2):
        assert cli("analyze", "d", "-l", "l.yaml", "-o", "d/answer.txt").returncode == 0
