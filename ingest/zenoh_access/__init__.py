"""What Zenoh enforces: access control of sessions and routers in, out come grants and decisions (rules S5, S6)."""
