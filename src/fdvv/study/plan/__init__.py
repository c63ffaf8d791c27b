"""Plans, schedules, staircases and simulated participants, as plain records."""
