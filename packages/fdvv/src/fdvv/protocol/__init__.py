"""The wire between host and firmware, generated from ``protocol/*.toml``."""
