"""A keystore is verified file by file; what does not hold is refused by name."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.keystore.deployed_inputs import read_deployed
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.keystore.deployed_inputs import Read

TODAY = (datetime.now(UTC) + timedelta(days=1)).date().isoformat()  # the certificates are given today
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
    assert said == ()
    names = [name.removeprefix(f"{keystore.folder}/enclaves/") for name, _ in policies[0].sources]
    assert names == ["camera/permissions.p7s", "governance.p7s"]


def test_a_grant_stands_at_its_line_of_the_signed_file(keystore: Keystore) -> None:
    place = read(keystore)[0][0].grants[0].place
    lines = (keystore.folder / "enclaves/camera/permissions.p7s").read_text().splitlines()
    assert "rt/video" in lines[place.line - 1]


def test_no_private_key_is_opened(keystore: Keystore) -> None:
    for file in keystore.folder.rglob("*key.pem"):
        file.unlink()
        file.mkdir()
    assert len(read(keystore)[0]) == 2


def test_a_changed_byte_is_refused(keystore: Keystore) -> None:
    file = keystore.folder / "enclaves/camera/permissions.p7s"
    file.write_bytes(file.read_bytes().replace(b"rt/video", b"rt/audio"))
    problem = "it was changed after it was signed by public/permissions_ca.cert.pem"
    assert refused(keystore) == [("enclaves/camera/permissions.p7s", problem)]


def test_another_ca_is_refused(keystore: Keystore) -> None:
    keystore.sign(CAMERA, keystore.folder / "enclaves/camera/permissions.p7s", "identity_ca")
    problem = "it was signed by somebody else than public/permissions_ca.cert.pem"
    assert refused(keystore) == [("enclaves/camera/permissions.p7s", problem)]


def test_what_is_not_signed_is_refused_and_read_only_where_that_is_asked_for(keystore: Keystore) -> None:
    (keystore.folder / "enclaves/camera/permissions.p7s").write_text(CAMERA)
    assert refused(keystore) == [("enclaves/camera/permissions.p7s", "not signed")]
    policies, said = read(keystore, allow_unsigned=True)
    assert [grant.name for grant in policies[0].grants] == ["rt/video"]
    assert [d.message for d in said] == ["not verified: not signed; read all the same, as --allow-unsigned asks"]


def test_a_file_that_is_missing_is_an_error_also_where_nothing_has_to_be_signed(keystore: Keystore) -> None:
    (keystore.folder / "enclaves/camera/governance.p7s").unlink()
    assert refused(keystore) == [("enclaves/camera/governance.p7s", "file not found")]
    with pytest.raises(InputErrors, match="file not found"):
        read(keystore, allow_unsigned=True)


def test_permissions_that_were_swapped_between_enclaves_are_refused(keystore: Keystore) -> None:
    camera, viewer = (keystore.folder / f"enclaves/{name}/permissions.p7s" for name in ("camera", "viewer"))
    first, second = camera.read_bytes(), viewer.read_bytes()
    camera.write_bytes(second)
    viewer.write_bytes(first)
    assert refused(keystore) == [
        ("enclaves/camera/permissions.p7s", "permissions of CN=/viewer, beside the certificate of CN=/camera"),
        ("enclaves/viewer/permissions.p7s", "permissions of CN=/camera, beside the certificate of CN=/viewer"),
    ]


def test_a_certificate_of_another_identity_ca_is_refused(keystore: Keystore) -> None:
    keystore.authority("identity_ca")  # a new one, after the certificates were given
    assert refused(keystore) == [
        (f"enclaves/{name}/cert.pem", "not given by public/identity_ca.cert.pem") for name in ("camera", "viewer")
    ]


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


def test_permissions_that_are_missing_are_an_error(keystore: Keystore) -> None:
    (keystore.folder / "enclaves/camera/permissions.p7s").unlink()
    assert refused(keystore) == [("enclaves/camera/permissions.p7s", "file not found")]


def test_a_policy_that_lies_in_a_keystore_is_told(keystore: Keystore) -> None:
    """Rule S11: no middleware reads it there, but who put it there may mean it."""
    (keystore.folder / "package.xml").write_text("<package/>")
    assert not read(keystore)[1]
    (keystore.folder / "policies").mkdir()
    for file in ("robot.policy.xml", "policies/robot.policy"):
        (keystore.folder / file).write_text("<policy/>")
    told = read(keystore)[1]
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
