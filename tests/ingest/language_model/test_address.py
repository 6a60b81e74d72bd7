"""Where a language model may be, by its address alone (docs/language-model.md)."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.ingest.language_model import address_of

NEAR = [
    "127.0.0.1", "127.9.9.9", "10.1.2.3", "192.168.0.2", "172.16.9.9", "169.254.1.2", "localhost",
    "[::1]", "[fd00::1]", "[fc00::1]", "[fe80::1]", "[::ffff:10.0.0.1]", "[::ffff:127.0.0.1]",
]  # fmt: skip
FAR = [
    "203.0.113.9", "192.0.2.1", "198.51.100.1", "198.18.0.1", "240.0.0.1", "255.255.255.255", "0.1.2.3",
    "172.15.0.1", "172.32.0.1", "192.169.0.1", "11.0.0.1", "[2001:db8::1]", "[::]", "[::ffff:203.0.113.9]", "[fe00::1]",
    "[64:ff9b:1::1]",
    "8.8.8.8", "[2001:4860::1]", "[::ffff:8.8.8.8]", "100.64.0.1", "models.example", "gpu", "localhost.example",
    "2130706433", "0x7f.1", "127.1", "127.0.0.1.example",
]  # fmt: skip


@pytest.mark.parametrize("host", NEAR)
def test_what_is_near_needs_no_tls_and_no_proxy(host: str) -> None:
    found = address_of(f"http://{host}:11434/v1/")
    assert found == (f"http://{host}:11434/v1/chat/completions", True)


@pytest.mark.parametrize("host", FAR)
def test_what_is_not_known_to_be_near_needs_tls_or_a_word_of_the_user(host: str) -> None:
    with pytest.raises(InputError, match="is not encrypted, and its host not known to be in a private network"):
        address_of(f"http://{host}/v1")
    assert address_of(f"https://{host}/v1") == (f"https://{host}/v1/chat/completions", False)
    assert not address_of(f"http://{host}/v1", unencrypted=True).local


@pytest.mark.parametrize(
    "base",
    [
        "", "localhost:11434", "//localhost/v1", "file:///etc/passwd", "ftp://localhost/v1", "https://", "https:///v1",
        "https://host:99999/v1", "https://host:x/v1", "https://[::1/v1", "https://h/v1\r\nX: y", "https://h/a b",
        "https://h\u00e9/v1", "https://h/\x1b[31m",
    ],
)  # fmt: skip
def test_what_is_no_address_is_refused(base: str) -> None:
    with pytest.raises(InputError, match="is no address; write it as http://localhost:PORT/v1") as refused:
        address_of(base)
    assert str(refused.value).isprintable()


@pytest.mark.parametrize("base", ["https://u:top@h/v1", "https://top@h/v1", "https://h/v1?key=top", "https://h/v1#top"])
def test_what_may_be_a_password_is_refused_and_not_repeated(base: str) -> None:
    with pytest.raises(InputError, match="keys are read from the environment only") as refused:
        address_of(base, unencrypted=True)
    assert "top" not in str(refused.value)


def test_the_whole_address_will_do_too() -> None:
    assert address_of("https://h/v1/chat/completions").url == "https://h/v1/chat/completions"
