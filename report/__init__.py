"""The answer, for a reader: a ``Document`` in, text or files out. Nothing here decides anything.

``document/contents.py`` says what a ``Document`` is, ``document/analysis.py`` makes the JSON document of it,
``text/analysis.py`` the text. ``page`` is the report for people, ``pictures`` draws, ``rdf`` writes linked data,
``sarif`` and ``cnil`` the formats of other people's tools, and ``compare`` tells what differs between two documents.
"""
