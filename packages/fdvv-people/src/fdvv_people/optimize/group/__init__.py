"""One button for a group of people, and what a button of one's own gains over it."""
