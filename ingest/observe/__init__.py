"""What was seen running, through any door: observations in, out come a policy and the types of channels (rule S16)."""
