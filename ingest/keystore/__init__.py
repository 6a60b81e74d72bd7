"""What the middleware enforces: DDS-Security files and keystores in, out come grants and governance (rules S5, S6)."""
