"""The posted form of a decision: fields from a browser go in, out comes what is decided about which finding.

Where it is written is no matter of the form: that is the file which the command named.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.decisions import Choice

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.explorer.deciding import How
    from rosprivacy.explorer.web.forms import Form

_BETWEEN = re.compile("[,;]")


class DecisionSaid(NamedTuple):
    """What is decided: the id of a finding, one of ``Choice``, and the words of it."""

    finding: str
    choice: str
    how: How


def decision_in(form: Form, findings: Collection[str]) -> DecisionSaid:
    """Return what a form decides.

    Parameters
    ----------
    findings
        Ids of those that are found now.

    Raises
    ------
    FormError
        If it decides nothing that can be decided.

    Examples
    --------
    >>> from rosprivacy.explorer.web.forms import Form
    >>> form = Form(b"finding=00112233445566ff&choice=accept&reason=why&owner=A.+Lee&legal_basis=6(1)(f),+9(2)(h)")
    >>> decision_in(form, ["00112233445566ff"]).how["legal_basis"]
    ('6(1)(f)', '9(2)(h)')
    """
    bases = tuple(base.strip() for base in _BETWEEN.split(form.words("legal_basis")) if base.strip())
    how: How = {
        "reason": form.words("reason"),
        "owner": form.words("owner"),
        "expires": form.words("expires"),
        "ticket": form.words("ticket"),
        "legal_basis": bases,
    }
    return DecisionSaid(form.choice("finding", findings), form.choice("choice", [one.value for one in Choice]), how)
