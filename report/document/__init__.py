"""The ``Document``, all that an answer says as typed facts, and the JSON document, which is a contract."""
