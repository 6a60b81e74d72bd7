"""The explorer's page on this machine: a session goes in, out come a server that one browser may ask, and its page."""
