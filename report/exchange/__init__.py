"""Files for other people's tools: SARIF 2.1.0 for code scanning and editors, the CNIL's PIA tool.

In: an ``Analysis``. Out: plain dicts that go to JSON.
"""
