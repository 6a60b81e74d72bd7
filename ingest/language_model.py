"""A server of a language model that a user names: where it is, a question over HTTP, the answer, the record of both.

This is the one place that sends names anywhere. Without TLS only an address of this computer or of a private network
will do. The name of a host is not looked up to find that out: who answers for a name can change, and asking for it is
sending already. The standard library is enough for one POST: its opener is built here of what is needed, so there is no
redirect, no cookie, no password file and no other scheme. TLS is verified with the certificates of the system. The
proxies of the environment are used (HTTPS_PROXY, ALL_PROXY, NO_PROXY …), but not for this computer and addresses of
private networks.

The outer form of an answer is that of chat completions; if it is another one, the address is no such server, and that
is an error. What the model wrote into it is anybody's text: it is JSON of the form that was asked for, or it is dropped
and told. The record of questions and answers is evidence: written once, read to ask again, without any key.
"""

from __future__ import annotations

import hashlib
import http.client
import ipaddress
import ssl
import time
import urllib.request
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.error import URLError
from urllib.parse import urlsplit

from rosprivacy.analysis.errors import InputError, ModelError, shown
from rosprivacy.analysis.json_values import parsed
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.reading.bounded_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

OPTION = "--model-url"
PATH = "/chat/completions"
EXAMPLE = "write it as http://localhost:PORT/v1 or https://HOST/v1"
ENCRYPT = "use https://, an address such as 192.168.0.2, or say --model-unencrypted"
# RFC 1918 and RFC 4193. What ipaddress calls private is more: addresses for examples (203.0.113.9), and 0.0.0.0.
PRIVATE = tuple(map(ipaddress.ip_network, ("10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "fc00::/7")))
KEY = "ROSPRIVACY_MODEL_KEY"
SHORTEST_KEY = 8  # a shorter one is none: servers on one's own computer take any word
LARGEST = 4 * 2**20  # bytes of an answer
PIECE = 2**16
TRIES, LONGEST_WAIT = 3, 60  # of a server that says when to ask again, in seconds
OK, BUSY, KEY_REFUSED = 200, (429, 503), (401, 403)
MOVED = range(300, 400)
HIDDEN = "[key]"
REFUSED, NO_JSON, CUT = "the model refused", "an answer is no JSON of the form asked for", "an answer is cut short"
BASE = "is --model-url the address that /chat/completions comes after?"
FORMAT = "rosprivacy.model-exchanges/1"
LARGEST_RECORD = 256 * 2**20
REMEDY = "write it again with --record"


class Address(NamedTuple):
    """Where questions go, and whether it is on this computer or in a private network: no proxy is asked for it then."""

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


class ModelServer:
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

    def __init__(self, address: Address, key: str, seconds: float, progress: Callable[[str], None]) -> None:
        if not key.isascii() or not key.isprintable() or " " in key:
            hint = "give it as the server's owner wrote it, on one line"
            raise InputError(KEY, 0, "has signs that no key has", hint)
        self.where = shown(urlsplit(address.url).netloc)
        self._address, self._key, self._seconds, self._progress = address, key, seconds, progress

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
            self._progress(f"{self.where}: asks to wait for {counted(wait, 'second')}")
            time.sleep(wait)
        raise AssertionError

    def _sent(self, body: bytes) -> tuple[int, Mapping[str, str], bytes]:
        """Status, headers and content of one answer."""
        headers = {"Content-Type": "application/json", "Accept": "application/json", "User-Agent": "rosprivacy"}
        if self._key:
            headers["Authorization"] = f"Bearer {self._key}"
        request = urllib.request.Request(self._address.url, body, headers, method="POST")  # noqa: S310 - address_of looked at it
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
        return f"status {status}{_message(data)}; look at the server, at --model and at --model-url"


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


def _message(data: bytes) -> str:
    """The message of a server, if it has one where such servers have it."""
    try:
        value: Any = parsed(data, lambda *said: ModelError(str(said)), "")
        message = value["error"]["message"] if isinstance(value["error"], dict) else value["error"]
    except (ModelError, LookupError, TypeError):
        return ""
    return f": {shown(message)!r}" if isinstance(message, str) and message else ""


class AnsweredQuestions(NamedTuple):
    """The answers to one question; why nothing of it could be read, empty if it was."""

    answers: tuple[Any, ...]
    unread: str = ""


def answers_in(data: bytes, where: str) -> AnsweredQuestions:
    r"""Return the answers, of any form.

    Parameters
    ----------
    where
        Who sent it.

    Raises
    ------
    ModelError
        If it is no chat completion.

    Examples
    --------
    >>> text = b'{"choices": [{"message": {"content": "{\\"suggestions\\": [1]}"}}]}'
    >>> answers_in(text, "localhost"), answers_in(b'{"choices": [{"message": {"refusal": "no"}}]}', "localhost").unread
    (AnsweredQuestions(answers=(1,), unread=''), 'the model refused')
    """

    def fail(line: int, fault: str, hint: str) -> ModelError:
        del line, hint  # of files
        return ModelError(f"{where}: the answer is no chat completion ({fault}); {BASE}")

    outer = parsed(data, fail, "")
    try:
        choice = outer["choices"][0]
        message = choice["message"]
        content, refusal = message.get("content"), message.get("refusal")
        ended = choice.get("finish_reason")
    except (LookupError, TypeError, AttributeError):
        raise fail(0, "it has no choices with a message", "") from None
    if refusal or ended == "content_filter":
        return AnsweredQuestions((), REFUSED)
    if not isinstance(content, str):
        return AnsweredQuestions((), NO_JSON)
    return _answers(content, CUT if ended == "length" else NO_JSON)


def _answers(content: str, otherwise: str) -> AnsweredQuestions:
    try:
        inner = parsed(content.encode(), lambda _, what, hint: ModelError(f"{what}; {hint}"), "")
    except ModelError:
        return AnsweredQuestions((), otherwise)
    if not isinstance(inner, dict) or list(inner) != ["suggestions"] or not isinstance(inner["suggestions"], list):
        return AnsweredQuestions((), otherwise)
    return AnsweredQuestions(tuple(inner["suggestions"]))


class Exchange(NamedTuple):
    """A question and what came back; no answer where the server gave none."""

    question: bytes
    answer: bytes | None


class Exchanges(NamedTuple):
    """What stands in a file: sent where, whether names were masked, when (``YYYY-MM-DD``); its hash, if it was read."""

    model: str
    url: str
    masked: bool
    date: str
    exchanges: tuple[Exchange, ...]
    sha256: str = ""


def as_document(exchanges: Exchanges) -> dict[str, Any]:
    """Return what is written as JSON."""
    return {
        "format": FORMAT,
        "model": exchanges.model,
        "url": exchanges.url,
        "masked": exchanges.masked,
        "date": exchanges.date,
        "exchanges": [
            {
                "question": one.question.decode("ascii"),
                "question_sha256": _digest(one.question),
                "answer": None if one.answer is None else one.answer.decode(),
                "answer_sha256": None if one.answer is None else _digest(one.answer),
            }
            for one in exchanges.exchanges
        ],
    }


def read_exchanges(file: str) -> Exchanges:
    """Read a file that was recorded.

    Raises
    ------
    InputError
        If it is none, or a text in it is not the one of its SHA-256.
    """
    data = read_regular(file, LARGEST_RECORD, partial(InputError, file))
    top = parsed(data, partial(InputError, file), REMEDY)
    if not isinstance(top, dict) or top.get("format") != FORMAT:
        raise InputError(file, 0, f"is no {FORMAT}", "name a file that --record wrote")
    try:
        exchanges = tuple(map(_exchange_in, _of(top, "exchanges", list)))
        texts = (_of(top, "model", str), _of(top, "url", str), _of(top, "masked", bool), _of(top, "date", str))
    except ValueError as odd:
        raise InputError(file, 0, str(odd), REMEDY) from None
    return Exchanges(*texts, exchanges, hashlib.sha256(data).hexdigest())


def _of(value: Any, key: str, type_: type) -> Any:
    if not isinstance(value, dict) or not isinstance(value.get(key), type_):
        raise ValueError(f"{shown(key)} is not there, or no {type_.__name__}")  # noqa: TRY004 - of a file
    return value[key]


def _exchange_in(exchange: Any) -> Exchange:
    question = _of(exchange, "question", str).encode()
    answer = None if exchange.get("answer") is None else _of(exchange, "answer", str).encode()
    if exchange.get("question_sha256") != _digest(question) or (
        answer and exchange.get("answer_sha256") != _digest(answer)
    ):
        raise ValueError("a question or an answer was changed: its SHA-256 is another one")
    return Exchange(question, answer)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def replayed(file: str, record: Exchanges) -> Callable[[bytes], bytes]:
    """Return what answers a question as it was answered then."""
    answers = {one.question: one.answer for one in record.exchanges}

    def answer(question: bytes) -> bytes:
        text = answers.get(question)
        if text is None:
            hint = "the input, the kinds or the program is another one, or the model was not reached then"
            what = "has no answer to what would be asked now"
            raise InputError(file, 0, what, f"{hint}: ask again with --record")
        return text

    return answer
