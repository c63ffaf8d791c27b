"""Buttons pressed live: real-time loop, traces, telemetry for a page."""
