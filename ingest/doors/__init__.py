"""Doors to a running system: a middleware, a program or a text in, out come observations (rule S16)."""
