"""The rules of ``rosprivacy lint``: one table, in the order in which they are documented.

In: nothing. Out: ``RULES`` by name. What breaks them is found in ``read_rules``, ``include_rules``, ``grant_rules``
and ``enclave_rules``.
"""

from __future__ import annotations

from rosprivacy.analysis.model import LintRule, Severity

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTICE
_RULES = (
    LintRule("refused-policy", _E, "a form that sros2 refuses", "no permissions are made of it"),
    LintRule(
        "dead-deny", _E, "a DENY that sros2 does not read, or in permissions one after an ALLOW of the same",
        "what it should take away is allowed",
    ),
    LintRule("duplicate-enclave", _E, "an enclave path that is there twice", "sros2 uses the first one only"),
    LintRule(
        "several-profiles", _E, "several <profiles> in an enclave, or grants of a subject",
        "DDS uses the first grant only",
    ),
    LintRule("overridden-allow", _W, "an ALLOW that a DENY of its enclave takes back", "it grants nothing"),
    LintRule("wildcard-everything", _E, "a name that is * alone", "it grants every name there is, parameters too"),
    LintRule("wildcard", _W, "a name with *, ? or […]", "it also grants names that nobody thought of"),
    LintRule("mistaken-tilde", _W, "a name that begins with ~ and no /", "sros2 glues it to the node's name"),
    LintRule(
        "relative-standard-name", _W, "rosout, parameter_events or clock, relative in a namespace",
        "nodes use the name without the namespace, and get no permission for it",
    ),
    LintRule(
        "relative-shared-name", _W, "a relative name of a fragment, in several namespaces",
        "in some of them it is another name, which nobody else uses",
    ),
    LintRule("odd-namespace", _W, "a namespace that does not begin with /", "its names are those of no node"),
    LintRule("empty-group", _W, "a group without publish, subscribe, …", "it grants nothing"),
    LintRule("empty-include", _W, "an include that brings nothing", "what somebody meant to grant is not granted"),
    LintRule("repeated-include", _W, "an include that the same profile has already", "it brings nothing new"),
    LintRule(
        "needless-include", _W, "an include of which the profile has every line from elsewhere",
        "it brings nothing new, and who removes a line elsewhere may not think of it",
    ),
    LintRule("missing-include", _W, "an include of a file that is not there", "its fallback is read in its place"),
    LintRule("unused-file", _W, "a policy or a part of one that nothing reads", "what it grants is not granted"),
    LintRule("refused-name", _W, "a name that no ROS node can have", "the line meets no other, or the wrong ones"),
    LintRule("shared-enclave", _W, "an enclave that several files state", "sros2 makes permissions of one file"),
    LintRule(
        "mixed-enclave", _W, "an enclave with a source and a leak, in different nodes",
        "DDS lets each node of it do what any of them may, so nothing that stands between them protects",
    ),
    LintRule("crowded-enclave", _N, "an enclave of several nodes", "each of them may do what any of them may"),
    LintRule(
        "large-permissions", _E, "permissions of more than 64 KiB",
        "they do not fit into the handshake of DDS, so the enclave cannot join",
    ),
)  # fmt: skip
OF_LABELS = ("mixed-enclave",)
"""Those that are about sources and leaks."""
RULES = {rule.name: rule for rule in _RULES}
