"""The circuit: parts, nets, values, rules and drawings."""
