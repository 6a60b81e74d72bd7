"""The report for people: an HTML page, Markdown, Word, the record of Article 30; in English, German and French.

In: a JSON document of the contract (``report/document/analysis.py``). Out: text. ``outline.py`` says what is told.
"""
