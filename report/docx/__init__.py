"""The report as a Word document.

In: the report as Markdown (``report/page/markdown.py``), so that no sentence stands in one of them only. Out: the bytes
of a ``.docx``: headings, lists and tables of Word's own styles, which people go on with.
"""
