"""A timing study in its folder, and how far its people are."""
