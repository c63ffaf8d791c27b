"""The participant's screens: who sits where, of every kind of study, and the trials of a timing study."""
