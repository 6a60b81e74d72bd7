"""Labelling and seeing the effect at once: policies and label files in, out come sessions with edits.

Nothing here knows of a browser. The function of the public API is ``rosprivacy.explore``, so the package has another
name: an imported package would take the function's place.
"""
