"""Annotations in the source code of nodes (``# privacy: source Video``), and what else the code says plainly."""
