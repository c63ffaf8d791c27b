"""Plan, schedule, events and state of a timing study, as plain records."""
