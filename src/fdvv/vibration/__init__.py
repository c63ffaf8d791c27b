"""Vibration from recording to rendering: onsets, damped modes, exciter and inverse, templates, likeness."""
