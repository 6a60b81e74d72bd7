"""Recordings: bags and what is known of their channels in, out come the kinds of data that can be in them."""
