"""Trials on the page: posted forms in, what is tried and what follows from it out; nothing of it is saved."""
