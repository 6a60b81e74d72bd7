"""The answer, for a reader: an ``Analysis`` in, text or files out. Nothing here decides anything.

``document.py`` makes the JSON document of the contract, ``terminal.py`` the text. ``page`` is the report for people,
``views.py`` and ``pictures`` draw, ``linked`` writes RDF, ``exchange`` the formats of other people's tools, and
``compare`` tells what differs between two documents.
"""
