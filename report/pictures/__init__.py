"""How views become files: ``picture.py`` is what is drawn, the rest how it looks and in which format.

In: a ``Picture``, as ``report/pictures/views.py`` makes it. Out: DOT, SVG, PNG, GraphML, Mermaid.
"""
