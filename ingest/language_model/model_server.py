"""A question over HTTP to the server of a language model, and its answer: the one place that sends names anywhere.

The standard library is enough for one POST: its opener is built here of what is needed, so there is no redirect, no
cookie, no password file and no other scheme. TLS is verified with the certificates of the system. The proxies of the
environment are used (HTTPS_PROXY, ALL_PROXY, NO_PROXY …), but not for this computer and addresses of private networks.
"""

from __future__ import annotations

import http.client
import ssl
import time
import urllib.request
from functools import cached_property
from typing import TYPE_CHECKING, Any
from urllib.error import URLError
from urllib.parse import urlsplit

from rosprivacy.analysis.errors import InputError, ModelError, shown
from rosprivacy.analysis.json_values import parsed
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.ingest.language_model.address import Address

KEY = "ROSPRIVACY_MODEL_KEY"
SHORTEST_KEY = 8  # a shorter one is none: servers on one's own computer take any word
LARGEST = 4 * 2**20  # bytes of an answer
PIECE = 2**16
TRIES, LONGEST_WAIT = 3, 60  # of a server that says when to ask again, in seconds
OK, BUSY, KEY_REFUSED = 200, (429, 503), (401, 403)
MOVED = range(300, 400)
HIDDEN = "[key]"


class Server:
    """Who answers.

    Parameters
    ----------
    address
        Where.
    key
        What the server asks for; never shown, and taken out of what it answers.
    seconds
        How long to wait for one answer.
    told
        Is told of each wait.
    """

    def __init__(self, address: Address, key: str, seconds: float, told: Callable[[str], None]) -> None:
        if not key.isascii() or not key.isprintable() or " " in key:
            hint = "give it as the server's owner wrote it, on one line"
            raise InputError(KEY, 0, "has signs that no key has", hint)
        self.where = shown(urlsplit(address.url).netloc)
        self._address, self._key, self._seconds, self._told = address, key, seconds, told

    def __call__(self, body: bytes) -> bytes:
        """Send a question; return what came back, without the key.

        Raises
        ------
        ModelError
            If the server cannot be reached, or gives no answer.
        """
        for left in reversed(range(TRIES)):
            status, headers, data = self._sent(body)
            if status == OK:
                return data
            wait = _wait(headers) if status in BUSY and left else None
            if wait is None:
                raise ModelError(f"{self.where}: {self._refused(status, headers, data)}")
            self._told(f"{self.where}: asks to wait for {counted(wait, 'second')}")
            time.sleep(wait)
        raise AssertionError

    def _sent(self, body: bytes) -> tuple[int, Mapping[str, str], bytes]:
        """Status, headers and content of one answer."""
        headers = {"Content-Type": "application/json", "Accept": "application/json", "User-Agent": "rosprivacy"}
        if self._key:
            headers["Authorization"] = f"Bearer {self._key}"
        request = urllib.request.Request(self._address.url, body, headers, method="POST")  # noqa: S310 - address.py looked at it
        until = time.monotonic() + self._seconds
        try:
            with self._opener.open(request, timeout=self._seconds) as answer:
                return answer.status, answer.headers, self._read(answer, until)
        except TimeoutError:
            raise self._late() from None
        except URLError as error:
            if isinstance(error.reason, TimeoutError):
                raise self._late() from None
            raise self._unreachable(error.reason) from None
        except http.client.IncompleteRead:
            raise self._broken() from None
        except (OSError, http.client.HTTPException, ValueError) as error:
            raise self._unreachable(error) from None

    @cached_property
    def _opener(self) -> urllib.request.OpenerDirector:
        opener = urllib.request.OpenerDirector()
        opener.add_handler(urllib.request.ProxyHandler({} if self._address.local else proxies()))
        opener.add_handler(urllib.request.HTTPHandler())
        opener.add_handler(urllib.request.HTTPSHandler(context=ssl.create_default_context()))
        return opener

    def _read(self, answer: http.client.HTTPResponse, until: float) -> bytes:
        pieces, size = [], 0
        while piece := answer.read1(PIECE):
            pieces.append(piece)
            size += len(piece)
            if size > LARGEST:
                raise ModelError(f"{self.where}: the answer has more than {LARGEST:,} bytes; ask another server")
            if time.monotonic() > until:
                raise self._late()
        if answer.length:  # what was promised and did not come
            raise self._broken()
        try:
            return self._without_key(b"".join(pieces).decode())
        except UnicodeDecodeError:
            raise ModelError(f"{self.where}: the answer is not UTF-8; is --model-url its address?") from None

    def _without_key(self, text: str) -> bytes:
        return (text.replace(self._key, HIDDEN) if len(self._key) >= SHORTEST_KEY else text).encode()

    def _broken(self) -> ModelError:
        return ModelError(f"{self.where}: the answer broke off; run the command again")

    def _late(self) -> ModelError:
        hint = "allow more with --model-timeout, or ask a faster model"
        return ModelError(f"{self.where}: no answer in {self._seconds:g} seconds; {hint}")

    def _unreachable(self, why: object) -> ModelError:
        reason = getattr(why, "verify_message", "") or getattr(why, "strerror", "") or str(why) or type(why).__name__
        hint = "is the server running, and is --model-url its address?"
        return ModelError(f"{self.where}: cannot be reached: {shown(reason)}; {hint}")

    def _refused(self, status: int, headers: Mapping[str, str], data: bytes) -> str:
        """What is wrong and what to do; of the text of a server no more than its message, and none about keys."""
        if status in KEY_REFUSED:
            given = "refuses the key" if self._key else "asks for a key"
            return f"{given} (status {status}); set {KEY} to the one of this server"
        if status in MOVED:
            return f"sends elsewhere (status {status}), and nothing was sent there; name the right --model-url"
        if status in BUSY and headers.get("Retry-After"):
            later = shown(headers["Retry-After"])
            return f"has too much to do (status {status}); run the command again later: it says {later}"
        return f"status {status}{_said(data)}; look at the server, at --model and at --model-url"


def proxies() -> dict[str, str]:
    """Return the proxies of the environment or the system by scheme; ALL_PROXY is for both.

    Raises
    ------
    InputError
        If one is of a kind that is not known here: going around it would not be what the user wants.
    """
    named = urllib.request.getproxies()
    found = {scheme: named.get(scheme) or named.get("all", "") for scheme in ("http", "https")}
    for scheme, proxy in found.items():
        if "://" in proxy and not proxy.startswith(("http://", "https://")):
            what = f"a proxy of {shown(proxy.partition('://')[0])!r} is not known here"
            raise InputError(f"{scheme.upper()}_PROXY", 0, what, "name an HTTP proxy, or NO_PROXY for this host")
    return {scheme: proxy for scheme, proxy in found.items() if proxy}


def _wait(headers: Mapping[str, str]) -> int | None:
    """How many seconds a server asks to wait; None if it does not say, or too many."""
    said = headers.get("Retry-After") or ""
    return int(said) if said in map(str, range(LONGEST_WAIT + 1)) else None


def _said(data: bytes) -> str:
    """The message of a server, if it has one where such servers have it."""
    try:
        value: Any = parsed(data, lambda *said: ModelError(str(said)), "")
        message = value["error"]["message"] if isinstance(value["error"], dict) else value["error"]
    except (ModelError, LookupError, TypeError):
        return ""
    return f": {shown(message)!r}" if isinstance(message, str) and message else ""
