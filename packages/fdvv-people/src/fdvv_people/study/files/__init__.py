"""A study on disk: plan, hash-chained logs, sealed assignments, verification."""
