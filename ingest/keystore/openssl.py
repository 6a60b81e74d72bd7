"""The program ``openssl``, asked in one place: it verifies as the library in the middlewares does; no key is opened.

In: its arguments, and bytes that we have read: it opens no file of a keystore, which could be a pipe or without end.
Out: what it says. Nothing of the user's configuration counts, and it asks nobody anything.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from rosprivacy.analysis.errors import PolicyError, shown

SECONDS = 60
AUTHORITY = "CA"  # in the arguments: where the certificates of the CA are to be named
ALONE = {"OPENSSL_CONF": os.devnull, "LC_ALL": "C"}


def openssl(arguments: list[str], file: str, data: bytes, authority: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    """Run ``openssl``.

    Parameters
    ----------
    file
        What it is about, for the error.
    data
        What is in it.
    authority
        Certificates in PEM, which stand where ``AUTHORITY`` does.

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
        with tempfile.TemporaryDirectory() as folder:
            beside = Path(folder, "ca.pem")
            beside.write_bytes(authority)
            named = [str(beside) if argument == AUTHORITY else argument for argument in arguments]
            return subprocess.run(  # noqa: S603 - a fixed program, switches, and a path of ours
                [program, *named], input=data, capture_output=True, check=False, timeout=SECONDS, env=ALONE
            )
    except subprocess.TimeoutExpired:
        raise PolicyError(file, 0, f"not verified: openssl did not end in {SECONDS} s", "check the file") from None
    except OSError as error:
        raise PolicyError(file, 0, f"openssl could not verify it: {shown(str(error))}", "check openssl") from None
