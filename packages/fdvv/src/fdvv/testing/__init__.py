"""Test helpers for users: the device conformance suite, synthetic buttons, scripted devices."""
