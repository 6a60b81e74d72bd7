"""Where a language model is: an address of a user -> one that names may be sent to.

Without TLS only an address of this computer or of a private network will do. The name of a host is not looked up to
find that out: who answers for a name can change, and asking for it is sending already.
"""

from __future__ import annotations

import ipaddress
from typing import NamedTuple
from urllib.parse import urlsplit

from rosprivacy.analysis.errors import InputError, shown

OPTION = "--model-url"
PATH = "/chat/completions"
EXAMPLE = "write it as http://localhost:PORT/v1 or https://HOST/v1"
ENCRYPT = "use https://, an address such as 192.168.0.2, or say --model-unencrypted"
# RFC 1918 and RFC 4193. What ipaddress calls private is more: addresses for examples (203.0.113.9), and 0.0.0.0.
PRIVATE = tuple(map(ipaddress.ip_network, ("10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "fc00::/7")))


class Address(NamedTuple):
    """Where questions go.

    Attributes
    ----------
    url
        With its path, for a POST.
    local
        Whether it is on this computer or in a private network by its address: no proxy is asked for it.
    """

    url: str
    local: bool


def address_of(base: str, *, unencrypted: bool = False) -> Address:
    """Return where to send to.

    Parameters
    ----------
    base
        As servers name it: what ``/chat/completions`` comes after.
    unencrypted
        Whether the user wants plain http to any host.

    Raises
    ------
    InputError
        If it is no such address. What may be a password is not repeated.

    Examples
    --------
    >>> address_of("http://localhost:11434/v1/")
    Address(url='http://localhost:11434/v1/chat/completions', local=True)
    >>> address_of("http://models.example/v1")
    Traceback (most recent call last):
        ...
    rosprivacy.analysis.errors.InputError: --model-url: http://models.example/v1 is not encrypted, and its host not \
known to be in a private network; use https://, an address such as 192.168.0.2, or say --model-unencrypted
    """
    try:
        parts = urlsplit(base)
        host, _ = parts.hostname or "", parts.port
    except ValueError:
        raise InputError(OPTION, 0, "is no address", EXAMPLE) from None
    if parts.username is not None or parts.password is not None or "?" in base or "#" in base:
        hint = "keys are read from the environment only, and nothing comes after the path"
        raise InputError(OPTION, 0, "has a password, a query or a fragment", hint)
    if parts.scheme not in ("http", "https") or not host or not base.isascii() or not base.isprintable() or " " in base:
        raise InputError(OPTION, 0, f"{shown(base)!r} is no address", EXAMPLE)
    local = _is_local(host)
    if parts.scheme == "http" and not (local or unencrypted):
        what = f"{shown(base)} is not encrypted, and its host not known to be in a private network"
        raise InputError(OPTION, 0, what, ENCRYPT)
    return Address(base.rstrip("/").removesuffix(PATH) + PATH, local)


def _is_local(host: str) -> bool:
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host == "localhost"
    address = getattr(address, "ipv4_mapped", None) or address
    networks = (network for network in PRIVATE if network.version == address.version)
    return address.is_loopback or address.is_link_local or any(address in network for network in networks)
