"""Plans, schedules, staircases, thresholds and simulated participants, as plain records."""
