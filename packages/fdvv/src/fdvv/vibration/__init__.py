"""Vibration from recording to rendering: onsets, damped modes, exciter and its inverse, likeness."""
