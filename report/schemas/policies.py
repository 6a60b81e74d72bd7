"""The documents about policies themselves: ``rosprivacy.check/1`` and ``rosprivacy.lint/1``."""

from typing import Annotated

from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import Cause, Count, Keywords, Severity, closed, one_of
from rosprivacy.report.schemas.records import FileEntry


class DifferenceEntry(TypedDict):
    """A right that one side has and the other has not."""

    enclave: str
    only_in: Annotated[str, one_of("policy", "deployed")]
    right: Annotated[str, one_of("write", "read")]
    kind: Annotated[str, one_of("topic", "service", "action")]
    name: str
    leg: Annotated[str, one_of("", "request", "response")]
    dds: str
    file: str
    line: Count


class LossEntry(TypedDict):
    """A line that does not hold, as the known generator of Zenoh lists loses it."""

    loss: Annotated[
        str,
        one_of(
            "deny-became-allow",
            "deny-not-written",
            "action-not-read",
            "enclave-not-read",
            "one-role-only",
            "namespace-not-applied",
            "one-file-for-two-nodes",
            "names-below",
        ),
    ]
    message: str
    file: str
    line: Count


@closed
class ExposedEntry(TypedDict):
    """A rule of a governance by which others than the robot's own nodes can read."""

    cause: Annotated[Cause, "Nothing encrypts what is sent there, or a participant without a certificate may join."]
    dds: Annotated[str, "Expression of DDS topics; * where it is about all."]
    file: str
    line: int


class CheckDocument(TypedDict):
    """What a policy says and what is deployed: rosprivacy check --format json."""

    format: Annotated[str, Keywords(const="rosprivacy.check/1")]
    compared: Annotated[
        NotRequired[Annotated[str, one_of("deployment", "description")]],
        "With what: what is deployed; or, with what their code does (deployed), descriptions of nodes (policy). "
        "Absent in documents of earlier versions.",
    ]
    exposed: Annotated[
        NotRequired[list[ExposedEntry]],
        "What the deployed governance leaves in the open: it is no difference, since a policy says nothing of it. "
        "Absent in documents of earlier versions.",
    ]
    differences: list[DifferenceEntry]
    losses: Annotated[
        NotRequired[list[LossEntry]], "Lines that do not hold, as the known generator of Zenoh lists loses them."
    ]
    undetermined: Annotated[
        bool,
        "Whether more may be allowed than is compared: somewhere permissions are not asked, or any session is let in.",
    ]
    diagnostics: list[Annotated[dict[str, object], Keywords(required=["severity", "message", "file", "line"])]]
    policies: list[Annotated[dict[str, str], Keywords(required=["file", "sha256"], additionalProperties=True)]]
    rosprivacy: str


class BreachEntry(TypedDict):
    """A rule that is broken at a line; line 0 where it is the file as a whole."""

    rule: str
    severity: Severity
    file: str
    line: Annotated[Count, "0 where it is the file as a whole."]
    message: str
    why: str


class LintDocument(TypedDict):
    """What is wrong with how policies are written: rosprivacy lint --format json."""

    format: Annotated[str, Keywords(const="rosprivacy.lint/1")]
    breaches: list[BreachEntry]
    not_looked_at: Annotated[list[str], "Rules that need labels, and no labels are named."]
    policies: list[FileEntry]
    rosprivacy: str
