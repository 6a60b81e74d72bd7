"""What the middleware enforces: DDS-Security files, keystores and lists of Zenoh in, out come grants (rules S5, S6)."""
