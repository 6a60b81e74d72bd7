"""The JSON documents as types, held by a test to ``docs/*.schema.json``.

What each key means stands there. ``NotRequired`` is what a document may do without: where there is nothing to say, or
since it is newer than the format.
"""
