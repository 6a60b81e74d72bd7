"""Register and findings as linked data: RDF in words of the Data Privacy Vocabulary, with PROV for how they came about.

In: an ``Analysis`` and the vocabulary. Out: Turtle or JSON-LD.
"""
