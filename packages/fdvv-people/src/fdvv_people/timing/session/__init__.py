"""A participant's session: every press is on the disk before it counts."""
