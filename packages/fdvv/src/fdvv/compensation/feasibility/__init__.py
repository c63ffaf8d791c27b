"""Feasibility: what an identified rig can render within its limits, and why not more."""
