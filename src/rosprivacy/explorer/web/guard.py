"""Who may ask the page's server, and what: the browser that the link was opened in, from the page itself.

In: an application (ASGI) and a ``RequestDoor``. Out: an application that refuses everybody else before it is asked. It
is plain ASGI, so that nothing is buffered. Starlette's ``TrustedHostMiddleware`` was weighed: it leaves the port out,
and so would let in what other servers of this machine hand out; its session needs a further package and keeps the
session in the cookie, where we need one secret only.
"""

from __future__ import annotations

import secrets
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, cookie_parser
from starlette.responses import HTMLResponse, PlainTextResponse

if TYPE_CHECKING:
    from collections.abc import Collection

    from starlette.responses import Response
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

LARGEST = 65_536  # bytes of a form
ENTRANCE = "/enter"
ADDRESS = "127.0.0.1"
# same-origin: under no-referrer a browser sends a form of the page itself with Origin "null", which is refused. No
# address but that of ENTRANCE holds a secret, which opens once and is answered by another address.
HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
# The page asks for the next one itself: where the link came from another page, or from a file, a browser keeps the
# cookie back in all that the answer leads to (SameSite), but not in what our own page asks.
ENTERED = (
    "<!doctype html><html lang=en><meta http-equiv=refresh content='0;url=/'><link rel=icon href='data:,'>"
    "<title>rosprivacy explore</title>"
    "<p><a href='/'>Go on to the page</a></p></html>"
)
# A link to the page itself: from a terminal in a web page, the first request comes without the cookie (SameSite).
STRANGER = (
    "<!doctype html><html lang=en><title>rosprivacy explore</title><h1>Open the link that the terminal shows</h1>"
    "<p>It opens this page once, in one browser. If you have just opened it, <a href='/'>go on to the page</a>; "
    "if not, end the program (Ctrl+C) and start it again for a new link.</p></html>"
)


class Refusal(NamedTuple):
    """Why a request is not answered: a status of HTTP and one sentence."""

    status: int
    why: str


@dataclass
class RequestDoor:
    """The secrets of one run. The link opens once; what it leaves in the browser is another secret than its own.

    Attributes
    ----------
    port
        That the server is bound to.
    read_only
        Whether nothing may be changed.
    """

    port: int
    read_only: bool = False
    _token: str | None = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)
    _secret: str = field(default_factory=lambda: secrets.token_urlsafe(32), repr=False)

    @property
    def cookie(self) -> str:
        """Its name: browsers keep the cookies of all ports of a machine together."""
        return f"rosprivacy-{self.port}"

    @property
    def hosts(self) -> tuple[str, str]:
        """The names by which a browser of this machine, or one behind ``ssh -L``, asks."""
        return f"{ADDRESS}:{self.port}", f"localhost:{self.port}"

    @property
    def link(self) -> str:
        """What opens the page; empty once it was used."""
        return f"http://{ADDRESS}:{self.port}{ENTRANCE}?token={self._token}" if self._token else ""

    def enter(self, token: str) -> str | None:
        """Return what the browser has to keep, once, for the token of the link; None for any other."""
        if self._token is None or not _equal(token, self._token):
            return None
        self._token = None
        return self._secret

    def knows(self, secret: str) -> bool:
        """Whether this is what the link left in the browser."""
        return self._token is None and _equal(secret, self._secret)


class Guard:
    """Asks an application only what the page itself asks, and says with each answer what a browser may do with it.

    Parameters
    ----------
    reading
        Paths of forms that change nothing that is kept: they are answered where nothing may be changed, too.
    """

    def __init__(self, app: ASGIApp, door: RequestDoor, reading: Collection[str] = ()) -> None:
        self.app, self.door, self._reading = app, door, reading

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] != "http":
            return  # no websockets; nothing is to be done when the server starts

        async def respond(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        answer = self._answer(scope)
        with suppress(ClientDisconnect):  # a form that was broken off: there is nobody to tell
            await (answer or self.app)(scope, receive, respond)

    def _answer(self, scope: Scope) -> Response | None:
        """What is answered without asking the application; None for what it may be asked."""
        headers = Headers(scope=scope)
        refusal = refused(scope["method"], headers, self.door, reads=scope["path"] in self._reading)
        if refusal:
            return PlainTextResponse(refusal.why, refusal.status)
        if scope["path"] == ENTRANCE:
            return self._entered(scope)
        return None if self.door.knows(_cookie(headers, self.door.cookie)) else HTMLResponse(STRANGER, 401)

    def _entered(self, scope: Scope) -> Response:
        token = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        kept = self.door.enter(token) if scope["method"] == "GET" else None
        if kept is None:
            return HTMLResponse(STRANGER, 401)
        response = HTMLResponse(ENTERED)
        response.set_cookie(self.door.cookie, kept, httponly=True, samesite="strict")
        return response


def refused(method: str, headers: Headers, door: RequestDoor, *, reads: bool = False) -> Refusal | None:
    """Return why a request is refused whoever asks; None if nothing speaks against it.

    Parameters
    ----------
    reads
        Whether what is asked changes nothing, though it is a form.

    Examples
    --------
    >>> refused("GET", Headers({"host": "rebound.example:8700"}), RequestDoor(8700)).status
    421
    >>> refused("GET", Headers({"host": "127.0.0.1:8700"}), RequestDoor(8700))
    """
    hosts = headers.getlist("host")
    if len(hosts) != 1 or hosts[0] not in door.hosts:
        return Refusal(421, "This server answers to its own address on this machine only.")
    origins = headers.getlist("origin")
    if origins and origins != [f"http://{hosts[0]}"]:
        return Refusal(403, "Another page asked.")
    return (
        None if method in ("GET", "HEAD") else _change_refused(method, headers, read_only=door.read_only and not reads)
    )


def _change_refused(method: str, headers: Headers, *, read_only: bool) -> Refusal | None:
    if method != "POST":
        return Refusal(405, "Only GET, HEAD and POST are answered.")
    if "origin" not in headers:
        return Refusal(403, "It is not known which page asked.")
    if read_only:
        return Refusal(403, "The program was started with --read-only: nothing can be changed.")
    return _too_much(headers)


def _too_much(headers: Headers) -> Refusal | None:
    lengths = headers.getlist("content-length")
    if not lengths or "transfer-encoding" in headers:
        return Refusal(411, "The length of a form has to be said.")
    if len(lengths) != 1 or not (lengths[0].isascii() and lengths[0].isdigit()):
        return Refusal(400, "The length of the form is no number.")
    if len(lengths[0]) > len(str(LARGEST)) or int(lengths[0]) > LARGEST:
        return Refusal(413, f"A form has at most {LARGEST} bytes.")
    return None


def _cookie(headers: Headers, name: str) -> str:
    """The value of a cookie; empty if there is none. Those of other programs on this machine may look like anything."""
    return cookie_parser("; ".join(headers.getlist("cookie"))).get(name, "")


def _equal(first: str, second: str) -> bool:
    """Compare in a time that tells nothing; of texts that is not done for all signs."""
    return secrets.compare_digest(first.encode("utf-8", "surrogatepass"), second.encode())
