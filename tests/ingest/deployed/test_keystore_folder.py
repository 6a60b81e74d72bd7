"""A keystore is verified file by file; what does not hold is refused by name."""

from __future__ import annotations

import hashlib
import json
import os
import ssl
import time
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import SIGNED_BY
from rosprivacy.ingest.deployed import signatures
from rosprivacy.ingest.deployed.deployed_inputs import read_deployed
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.ingest.deployed.deployed_inputs import Read
    from tests.helpers.command import Cli

TODAY = (datetime.now(timezone.utc) + timedelta(days=1)).date().isoformat()  # the certificates are given today
CA = "public/permissions_ca.cert.pem"
PERMISSIONS = "enclaves/camera/permissions.p7s"
CAMERA = permissions(grant("/camera", rule("allow", publish=("rt/video",))))
VIEWER = permissions(grant("/viewer", rule("allow", subscribe=("rt/video",))))


@pytest.fixture
def keystore(tmp_path: Path) -> Keystore:
    made = Keystore(tmp_path / "keystore")
    made.enclave("/camera", CAMERA)
    made.enclave("/viewer", VIEWER)
    return made


def read(keystore: Keystore, today: str = TODAY, *, allow_unsigned: bool = False) -> Read:
    return read_deployed([str(keystore.folder)], None, today, allow_unsigned=allow_unsigned)


def refused(keystore: Keystore) -> list[tuple[str, str]]:
    """(file within the keystore, problem) of each problem."""
    with pytest.raises(InputErrors) as caught:
        read(keystore)
    inside = f"{keystore.folder}/"
    return [(error.file.removeprefix(inside), error.problem.replace(inside, "")) for error in caught.value.errors]


def test_a_keystore_gives_the_grants_of_all_its_enclaves(keystore: Keystore) -> None:
    policies, said = read(keystore)
    assert [[(g.allow, g.role, g.name, g.enclave) for g in policy.grants] for policy in policies] == [
        [(True, "publish", "rt/video", "/camera")],
        [(True, "subscribe", "rt/video", "/viewer")],
    ]
    assert [(one.code, one.place.file) for one in said] == [(SIGNED_BY, str(keystore.folder / CA))]
    names = [name.removeprefix(f"{keystore.folder}/") for name, _ in policies[0].sources]
    files = ["camera/cert.pem", "camera/permissions.p7s", "governance.p7s"]
    assert names == [*(f"enclaves/{name}" for name in files), "public/identity_ca.cert.pem", CA]


def test_files_have_the_hash_of_the_disk_and_grants_their_line_of_the_signed_file(keystore: Keystore) -> None:
    policies = read(keystore)[0]
    for policy in policies:
        for name, sha256 in policy.sources:
            assert hashlib.sha256(Path(name).read_bytes()).hexdigest() == sha256, name
    lines = (keystore.folder / PERMISSIONS).read_text().splitlines()
    assert "rt/video" in lines[policies[0].grants[0].place.line - 1]


def test_no_private_key_is_opened(keystore: Keystore) -> None:
    for file in keystore.folder.rglob("*key.pem"):
        file.unlink()
        file.mkdir()
    assert len(read(keystore)[0]) == 2


def changed(keystore: Keystore) -> None:
    file = keystore.folder / PERMISSIONS
    file.write_bytes(file.read_bytes().replace(b"rt/video", b"rt/audio"))


def swapped(keystore: Keystore) -> None:
    camera, viewer = (keystore.folder / f"enclaves/{name}/permissions.p7s" for name in ("camera", "viewer"))
    first, second = camera.read_bytes(), viewer.read_bytes()
    camera.write_bytes(second)
    viewer.write_bytes(first)


REFUSED: dict[str, tuple[Callable[[Keystore], object], list[tuple[str, str]]]] = {
    "changed": (changed, [(PERMISSIONS, f"it was changed after it was signed by {CA}")]),
    "of another CA": (
        lambda made: made.sign(CAMERA, made.folder / PERMISSIONS, "identity_ca"),
        [(PERMISSIONS, f"it was signed by somebody else than {CA}")],
    ),
    "missing": (lambda made: (made.folder / PERMISSIONS).unlink(), [(PERMISSIONS, "file not found")]),
    "governance missing": (
        lambda made: (made.folder / "enclaves/camera/governance.p7s").unlink(),
        [("enclaves/camera/governance.p7s", "file not found")],
    ),
    "swapped between enclaves": (
        swapped,
        [
            (PERMISSIONS, "permissions of CN=/viewer, beside the certificate of CN=/camera"),
            (
                "enclaves/viewer/permissions.p7s",
                "permissions of CN=/camera, beside the certificate of CN=/viewer",
            ),
        ],
    ),
    "certificates of another identity CA": (
        lambda made: made.authority("identity_ca"),  # a new one, after the certificates were given
        [(f"enclaves/{name}/cert.pem", "not given by public/identity_ca.cert.pem") for name in ("camera", "viewer")],
    ),
}


@pytest.mark.parametrize("how", REFUSED)
def test_what_does_not_hold_is_refused_by_name(keystore: Keystore, how: str) -> None:
    damage, problems = REFUSED[how]
    damage(keystore)
    assert refused(keystore) == problems
    if "missing" in how:  # also where nothing has to be signed
        with pytest.raises(InputErrors, match="file not found"):
            read(keystore, allow_unsigned=True)


def test_what_is_not_signed_is_refused_and_read_only_where_that_is_asked_for(keystore: Keystore) -> None:
    (keystore.folder / PERMISSIONS).write_text(CAMERA)
    assert refused(keystore) == [(PERMISSIONS, "not signed")]
    policies, said = read(keystore, allow_unsigned=True)
    assert [grant.name for grant in policies[0].grants] == ["rt/video"]
    assert [d.message for d in said if d.code != SIGNED_BY] == [
        "not verified: not signed; read all the same, as --allow-unsigned asks"
    ]


@pytest.mark.slow
def test_an_expired_certificate_and_an_expired_grant_are_told_and_read(keystore: Keystore) -> None:
    past = permissions(grant("/old", rule("allow", publish=("rt/old",)), validity=("2020-01-01", "2021-01-01")))
    keystore.enclave("/old", past)
    policies, said = read(keystore)
    assert len(policies) == 3
    message = f"grant of CN=/old is valid from 2020-01-01 to 2021-01-01, not on {TODAY}"
    assert [d.message for d in said if d.message.startswith(message)]
    assert any("the certificate of CN=/camera is valid" in d.message for d in read(keystore, "2070-01-01")[1])


def test_governance_tells_where_permissions_do_not_hold_and_what_is_sent_in_the_open(keystore: Keystore) -> None:
    rules = topic_rule("rt/free", reading="false"), topic_rule("rt/open", data="NONE", metadata="SIGN"), topic_rule()
    keystore.governance(governance(*rules, unauthenticated="true", rtps="NONE"))
    said = "\n".join(d.message for d in read(keystore)[1])
    assert "DDS topics rt/free: permissions are not asked, so every participant may read there" in said
    assert "DDS topics rt/open are sent without encryption: who is on the network can read them" in said
    assert "a participant without a certificate may join" in said
    assert "DDS topics * " not in said


@pytest.mark.slow
def test_a_policy_that_lies_in_a_keystore_is_told(keystore: Keystore) -> None:
    """Rule S11: no middleware reads it there, but who put it there may mean it."""
    (keystore.folder / "package.xml").write_text("<package/>")
    assert [one.code for one in read(keystore)[1]] == [SIGNED_BY]
    (keystore.folder / "policies").mkdir()
    for file in ("robot.policy.xml", "policies/robot.policy"):
        (keystore.folder / file).write_text("<policy/>")
    told = [one for one in read(keystore)[1] if one.code != SIGNED_BY]
    assert [(d.place.file.removeprefix(f"{keystore.folder}/"), d.code) for d in told] == [
        ("policies/robot.policy", "unread-file"), ("robot.policy.xml", "unread-file"),
    ]  # fmt: skip


def test_an_enclave_behind_a_link_is_one_of_the_keystore(keystore: Keystore) -> None:
    """A middleware follows the link too, so leaving it out would hide who reads."""
    viewer, elsewhere = keystore.folder / "enclaves/viewer", keystore.folder / "public/viewer"
    viewer.rename(elsewhere)
    viewer.symlink_to("../public/viewer")
    (elsewhere / "governance.p7s").unlink()
    (elsewhere / "governance.p7s").symlink_to("../../enclaves/governance.p7s")
    assert [grant.enclave for policy in read(keystore)[0] for grant in policy.grants] == ["/camera", "/viewer"]
    elsewhere.rename(keystore.folder / "gone")
    assert refused(keystore) == [("enclaves/viewer", "a link to nothing: ../public/viewer")]


def test_links_to_nothing_are_told_once_and_those_of_keys_not_at_all(keystore: Keystore) -> None:
    folder = keystore.folder / "enclaves/viewer"
    for name in ("key.pem", "permissions.p7s", "cert.pem"):
        (folder / name).unlink()
        (folder / name).symlink_to("nowhere")
        if name == "key.pem":
            assert len(read(keystore)[0]) == 2
    assert [file for file, _ in refused(keystore)] == ["enclaves/viewer/permissions.p7s"]


def test_an_empty_keystore_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "k/enclaves").mkdir(parents=True)
    (tmp_path / "k/public").mkdir()
    with pytest.raises(InputErrors, match=r"a keystore without any permissions\.p7s"):
        read_deployed([str(tmp_path / "k")], None, TODAY)


# ---------------------------------------------------------------- certificates are files like all others


@pytest.mark.parametrize(
    ("name", "what"),
    [(CA, "a pipe"), ("public/identity_ca.cert.pem", "without end"), ("enclaves/camera/cert.pem", "a pipe")],
)
def test_a_certificate_that_is_no_file_of_its_size_is_refused_at_once(keystore: Keystore, name: str, what: str) -> None:
    file = keystore.folder / name
    file.unlink()
    if what == "a pipe":
        os.mkfifo(file)
    else:
        with file.open("wb") as made:
            made.truncate(3 * 2**30)
    begun = time.monotonic()
    problems = refused(keystore)
    assert time.monotonic() - begun < signatures.SECONDS / 2
    assert {place for place, _ in problems} == {name}
    assert {problem for _, problem in problems} <= {"not a regular file", "more than 1048576 bytes"}


def test_an_openssl_that_does_not_end_is_told_of_the_file(
    keystore: Keystore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was not verified in time is an error with the file, never permissions that were read."""
    program = tmp_path / "bin" / "openssl"
    program.parent.mkdir()
    program.write_text("#!/bin/sh\nexec sleep 60\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent), prepend=os.pathsep)
    monkeypatch.setattr(signatures, "SECONDS", 0.2)
    assert (PERMISSIONS, "not verified: openssl did not end in 0.2 s") in refused(keystore)


# ---------------------------------------------------------------- whose signatures


def fingerprint(certificate: Path) -> str:
    return hashlib.sha256(ssl.PEM_cert_to_DER_cert(certificate.read_text())).hexdigest()


def signed_anew(keystore: Keystore) -> None:
    """What somebody can do who may change the folder: a CA of their own, and everything signed with it."""
    keystore.authority("permissions_ca")
    keystore.governance(governance())
    for name, text in (("camera", CAMERA), ("viewer", VIEWER)):
        keystore.sign(text, keystore.folder / "enclaves" / name / "permissions.p7s")


@pytest.mark.parametrize("how", ["file", "fingerprint", "with colons"])
def test_the_ca_can_be_pinned(cli: Cli, keystore: Keystore, tmp_path: Path, how: str) -> None:
    """That a keystore agrees with itself is known without a pin; whose it is, only with one."""
    ca = tmp_path / "ours.pem"
    ca.write_bytes((keystore.folder / CA).read_bytes())
    digest = fingerprint(ca)
    colons = ":".join(digest[at : at + 2].upper() for at in range(0, 64, 2))
    pin = ("--permissions-ca", {"file": str(ca), "fingerprint": digest, "with colons": colons}[how])
    done = cli("analyze", keystore.folder, *pin, "-f", "json")
    assert [d["message"] for d in json.loads(done.stdout)["diagnostics"] if d.get("code") == SIGNED_BY] == [
        f"the CA of the signatures, SHA-256 {digest}: it is that of --permissions-ca"
    ]
    signed_anew(keystore)
    assert cli("analyze", keystore.folder).returncode != 2
    done = cli("analyze", keystore.folder, *pin)
    assert done.returncode == 2
    assert f"{keystore.folder / CA}: not the CA of --permissions-ca" in done.stderr
    assert fingerprint(keystore.folder / CA) in done.stderr
    assert cli("analyze", keystore.folder, *pin, "--allow-unsigned").returncode == 2


def test_a_second_certificate_beside_the_pinned_one_is_refused(keystore: Keystore) -> None:
    """openssl takes each certificate of the file for the signer's."""
    ours = (keystore.folder / CA).read_bytes()
    pin = fingerprint(keystore.folder / CA)
    signed_anew(keystore)
    (keystore.folder / CA).write_bytes(ours + (keystore.folder / CA).read_bytes())
    assert len(read(keystore)[0]) == 2  # without a pin both are told
    with pytest.raises(InputErrors, match="not the CA of --permissions-ca"):
        read_deployed([str(keystore.folder)], None, TODAY, authorities=(pin,))


def test_what_nobody_signed_is_refused_beside_a_pin(cli: Cli, keystore: Keystore, tmp_path: Path) -> None:
    (tmp_path / "p.policy.xml").write_text('<policy version="0.2.0"><enclaves/></policy>')
    alone = keystore.folder / PERMISSIONS
    for name in (tmp_path / "p.policy.xml", alone):
        done = cli("analyze", name, "--permissions-ca", keystore.folder / CA, "--allow-unsigned")
        assert (done.returncode, str(name) in done.stderr) == (2, True)
