"""The program ``openssl``, asked in one place: it verifies as the library in the middlewares does; no key is opened.

In: its arguments. Out: what it says. Nothing of the user's configuration counts, and it asks nobody anything.
"""

from __future__ import annotations

import os
import shutil
import subprocess

from rosprivacy.analysis.errors import PolicyError, shown

SECONDS = 60
ALONE = {"OPENSSL_CONF": os.devnull, "LC_ALL": "C"}


def openssl(arguments: list[str], file: str) -> subprocess.CompletedProcess[bytes]:
    """Run ``openssl``.

    Parameters
    ----------
    file
        What it is about, for the error.

    Raises
    ------
    PolicyError
        If it is not there or does not end.
    """
    program = shutil.which("openssl")
    if program is None:
        what = "its signature cannot be verified: there is no openssl on the path"
        raise PolicyError(file, 0, what, "install openssl, or read it all the same with --allow-unsigned")
    try:
        return subprocess.run(  # noqa: S603 - a fixed program; what it is given are switches and absolute paths
            [program, *arguments],
            capture_output=True,
            check=False,
            timeout=SECONDS,
            env=ALONE,
            stdin=subprocess.DEVNULL,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise PolicyError(file, 0, f"openssl could not verify it: {shown(str(error))}", "check openssl") from None


def absolute(file: str) -> str:
    """Return a path that no switch can be mistaken for."""
    return os.path.abspath(file)  # noqa: PTH100 - by its text, links stay
