"""The rig as things to make, buy, wire and test: parts, circuit, bill of materials, self-test."""

__version__ = "0.1.0"
