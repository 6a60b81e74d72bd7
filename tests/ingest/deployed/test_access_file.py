"""Access control of Zenoh is read, or refused with every problem at its line, as Zenoh refuses it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest
import zenoh

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.deployed.access_file import identities, read_access
from tests.helpers.zenoh_tokens import opened_alone

if TYPE_CHECKING:
    from pathlib import Path

RULE = {"id": "r", "permission": "allow", "messages": ["put"], "flows": ["egress"], "key_exprs": ["0/camera/*/*"]}
SUBJECT = {"id": "s"}
POLICY = {"rules": ["r"], "subjects": ["s"]}
LISTS = {"rules": [RULE], "subjects": [SUBJECT], "policies": [POLICY]}


def written(folder: Path, section: dict[str, Any]) -> str:
    file = folder / "camera.json5"
    file.write_text(f"{{ // one session\n  access_control: {json.dumps(section, indent=2)},\n}}\n", "utf-8")
    return str(file)


def test_every_problem_is_told_at_its_line(tmp_path: Path) -> None:
    file = tmp_path / "camera.json5"
    file.write_text(
        """{ access_control: {
  enabled: true, default_permission: "Deny",
  rules: [
    { id: "r", permission: "allow", messages: ["put", "get"], key_exprs: [
      "0/camera/", "0/*x"] },
    { id: "r", messages: [], key_exprs: ["0/a"], actions: ["put"] },
  ],
  subjects: [{ id: "s", usernames: [""] }, { id: 3 }],
  policies: [{ rules: ["r", "q"], subjects: ["t"] }],
} }
""",
        "utf-8",
    )
    with pytest.raises(InputErrors) as caught:
        read_access(str(file))
    told = [str(error).removeprefix(f"{file}:").partition(";")[0] for error in caught.value.errors]
    assert told == [
        "2: 'Deny'",
        "4: 'get'",
        "5: key expression '0/*x': '*' or '$' where it cannot be",
        "5: key expression '0/camera/': an empty chunk",
        "6: an empty list",
        "6: id 'r' again, first in line 4",
        "6: no 'permission'",
        "6: unknown key 'actions'",
        "8: an empty name in usernames",
        "8: an id that is no text, or empty",
        "9: no rule has the id 'q'",
        "9: no subject has the id 't'",
    ]


def test_a_file_without_the_section_is_not_enabled(tmp_path: Path) -> None:
    file = tmp_path / "plain.json5"
    file.write_text("{ mode: 'client' }", "utf-8")
    assert not read_access(str(file)).enabled


@pytest.mark.parametrize(("second", "identities_held"), [({}, [2]), ({"link_protocols": ["tcp"]}, [1, 1])])
def test_two_subjects_that_state_the_same_are_one(
    tmp_path: Path, second: dict[str, Any], identities_held: list[int]
) -> None:
    """Then a deny wins; of two that are told apart one allow suffices."""
    rules = [RULE, {**RULE, "id": "d", "permission": "deny"}]
    policies = [POLICY, {"rules": ["d"], "subjects": ["t"]}]
    lists = {"rules": rules, "subjects": [SUBJECT, {"id": "t", **second}], "policies": policies}
    access = read_access(written(tmp_path, {"enabled": True, "default_permission": "deny", **lists}))
    assert [len(held) for held in identities(access).values()] == identities_held


SECTIONS: dict[str, dict[str, Any]] = {
    "as it should be": {**LISTS},
    "off": {"enabled": False, "rules": [RULE]},
    "enabled not stated": {"enabled": None},
    "no lists": {"rules": None, "subjects": None, "policies": None},
    "one list missing": {"policies": None},
    "lists empty": {"rules": [], "subjects": [], "policies": []},
    "unknown key": {"why": 1},
    "id twice": {"rules": [RULE, RULE]},
    "subject twice": {"subjects": [SUBJECT, SUBJECT]},
    "policy id twice": {"policies": [{**POLICY, "id": "p"}, {**POLICY, "id": "p"}]},
    "id empty": {"rules": [{**RULE, "id": " "}]},
    "id a number": {"rules": [{**RULE, "id": 3}]},
    "unknown rule": {"policies": [{**POLICY, "rules": ["q"]}]},
    "unknown subject": {"policies": [{**POLICY, "subjects": ["q"]}]},
    "policy of nothing": {"policies": [{**POLICY, "rules": []}]},
    "no messages": {"rules": [{**RULE, "messages": []}]},
    "message of another version": {"rules": [{**RULE, "messages": ["get"]}]},
    "no flows": {"rules": [{**RULE, "flows": []}]},
    "flows null": {"rules": [{**RULE, "flows": None}]},
    "another permission": {"rules": [{**RULE, "permission": "Allow"}]},
    "no expression": {"rules": [{**RULE, "key_exprs": []}]},
    "wrong expression": {"rules": [{**RULE, "key_exprs": ["0//a"]}]},
    "expression not canonical": {"rules": [{**RULE, "key_exprs": ["0/**/*"]}]},
    "empty user": {"subjects": [{**SUBJECT, "usernames": [""]}]},
    "no user": {"subjects": [{**SUBJECT, "usernames": []}]},
    "users null": {"subjects": [{**SUBJECT, "usernames": None}]},
    "zid": {"subjects": [{**SUBJECT, "zids": ["38a4829bce9166ee"]}]},
    "wrong zid": {"subjects": [{**SUBJECT, "zids": ["zz"]}]},
    "zid with a zero first": {"subjects": [{**SUBJECT, "zids": ["0a"]}]},
    "zid in capitals": {"subjects": [{**SUBJECT, "zids": ["AB"]}]},
    "long zid": {"subjects": [{**SUBJECT, "zids": ["a" * 33]}]},
    "a list where a text belongs": {"rules": [{**RULE, "id": ["r"]}]},
    "a text where a list belongs": {"rules": [{**RULE, "messages": "put"}]},
    "a map where a list belongs": {"rules": {"r": RULE}},
}


@pytest.mark.parametrize("name", SECTIONS)
def test_what_zenoh_refuses_is_refused(name: str, tmp_path: Path) -> None:
    section = {"enabled": True, **LISTS, **SECTIONS[name]}
    section = {key: value for key, value in section.items() if value is not None}
    try:
        with opened_alone(access_control=section):
            refused = False
    except zenoh.ZError:
        refused = True
    try:
        read_access(written(tmp_path, section))
        ours = False
    except InputErrors:
        ours = True
    assert ours == refused
