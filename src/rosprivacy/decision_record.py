"""A decision that is written down: with who wrote it, when, and what was there then, into a log or a decisions file.

In: what a person decides, and a document of the answer. Out: the text of the file with it. A decisions file keeps
what a person decides and no more, since whoever edits it could change the rest, too.
"""

from __future__ import annotations

import getpass
import os
import platform
import subprocess
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from rosprivacy.clock import now
from rosprivacy.ingest.decisions.decision_chain import digest
from rosprivacy.ingest.decisions.decision_log import is_log, parse_log, with_entry
from rosprivacy.ingest.decisions.decision_writer import FINDINGS, with_decision
from rosprivacy.ingest.decisions.decisions_file import parse_decisions

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.ontology.vocabulary import Vocabulary

IDENTITY = ("git", "-c", "user.useConfigOnly=true", "var", "GIT_AUTHOR_IDENT")  # only what a person set
NO_FACTS = frozenset({"decision", "paths", "paths_bounded", "robots", "view", "state"})  # or of how it was asked


def with_recorded(
    file: str, text: str | None, entry: Mapping[str, Any], remark: str, vocabulary: Vocabulary, section: str = FINDINGS,
    facts: Mapping[str, Any] | None = None,
) -> str:  # fmt: skip
    """Return the text of a log or a decisions file with a decision in it; see ``with_entry`` and ``with_decision``.

    Parameters
    ----------
    facts
        Of ``provenance``.
    """
    if not is_log(file):
        return with_decision(file, text, entry, remark, vocabulary, section)
    decision = {key: str(value) if key in ("date", "expires") else value for key, value in entry.items()}
    return with_entry(file, text, decision, section, facts or {}, vocabulary)


def parse_recorded(file: str, text: str, vocabulary: Vocabulary, day: str) -> Decisions:
    """Return what the text of a log or a decisions file says."""
    if is_log(file):
        return parse_log(file, text.encode(), vocabulary, day)
    return parse_decisions(file, text, vocabulary, day)


def provenance(folder: Path, about: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return who writes an entry of a log, when, and what was there.

    Parameters
    ----------
    folder
        Of the log: git may know a person by another name there.
    about
        Of ``subject``.
    """
    return {"account": _account(folder), "when": now(os.environ), **({"about": about} if about else {})}


def subject(document: Mapping[str, Any], **facts: Mapping[str, Any] | None) -> dict[str, str]:
    """Return what a decision is made about: hashes of its facts and of what they were read from.

    Parameters
    ----------
    facts
        Of the document: ``finding``, and the ``row`` of the register; None for what is not decided about.
    """
    assumptions = document["assumptions"]
    return {
        **{
            what: digest({key: value for key, value in some.items() if key not in NO_FACTS})
            for what, some in facts.items()
            if some
        },
        "policies": _digest_of_files(assumptions.get("policies", ())),
        "labels": _digest_of_files(assumptions["labels"]),
        "law": assumptions["law_as_of"],
    }


def _digest_of_files(files: Iterable[Mapping[str, str]]) -> str:
    """One hash of files, wherever they lie."""
    return digest(sorted(file["sha256"] for file in files))


def _account(folder: Path) -> dict[str, str]:
    try:
        git = subprocess.run([*IDENTITY], cwd=folder, capture_output=True, check=True)  # noqa: S603 - git
        name, _, _ = git.stdout.decode("utf-8", "replace").rsplit(" ", 2)  # the time and its zone
    except (OSError, subprocess.CalledProcessError, ValueError):
        name = ""
    return {"user": f"{_user()}@{platform.node()}", **({"git": name} if name else {})}


def _user() -> str:
    """The account of the system, whatever the environment calls it."""
    with suppress(ImportError, KeyError):
        import pwd  # noqa: PLC0415 - not on Windows

        return pwd.getpwuid(os.geteuid()).pw_name
    with suppress(ImportError, KeyError, OSError):
        return getpass.getuser()
    return "unknown"
