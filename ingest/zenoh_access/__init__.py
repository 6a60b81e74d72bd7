"""What Zenoh enforces: access control of sessions and routers, as facts and as decisions (rules S5, S6).

No command reads these files as grants yet.
"""
