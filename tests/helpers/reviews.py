"""A review for tests: its forms as a browser without scripts sends them, and words that its readers do not know."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lxml import html

if TYPE_CHECKING:
    from starlette.testclient import TestClient

NAME = "A. Lee"
NO_WORDS = "//code | //pre | //*[@lang='en'][not(self::html)]"
MOST = 60  # questions of a small system
EVERYWHERE = ("yaml", "topic", "sanitizer", "conduit", "policy", "frontier")
INSIDERS = {
    "en": (" node", "enclave", "label", "mundane", "derivation", "element"),
    "de": ("knoten", "enklave", "enclave", "label", "policies", "kante", "senke"),
    "fr": ("nœud", "noeud", "enclave", "annotation", "arête", "étiquette"),
}


def page(client: TestClient, address: str = "/") -> Any:
    answer = client.get(address)
    assert answer.status_code == 200
    return html.fromstring(answer.text)


def answer(client: TestClient, role: str, address: str = "/", **fields: Any) -> Any:
    """Send the form of a question as it stands, with an answer."""
    form = next(form for form in page(client, address).forms if form.get("action").startswith("/label"))
    sent = [(name, value) for name, value in form.form_values() if name not in ("role", *fields)]
    body = {name: [value for key, value in sent if key == name] for name, _ in sent}
    return client.post(form.get("action"), data={**body, "by": NAME, "role": role, **fields})


def heading(whole: Any) -> str:
    return str(whole.xpath("string(//h1)"))


def to_the_end(client: TestClient) -> list[str]:
    """Answer everything: what may bring data in does, all else passes it on; return the pages that were seen."""
    seen = []
    for _ in range(MOST):
        text = client.get("/").text
        seen.append(text)
        roles = html.fromstring(text).xpath("//input[@name='role']/@value")
        if not roles:
            return seen
        role = next(role for role in ("conduit", "sensitive", "source") if role in roles)
        assert answer(client, role).status_code == 303
    raise AssertionError("it never ends")


def insiders_in(text: str, language: str) -> list[str]:
    """Words on a page that only people know who write policies; names, kinds and lines of files are no words."""
    whole = html.fromstring(text)
    for left in whole.xpath(f"{NO_WORDS} | //select[@name='brings' or @name='makes']"):
        left.drop_tree()
    said = whole.text_content().casefold()
    return [word for word in (*EVERYWHERE, *INSIDERS[language]) if word in said]
