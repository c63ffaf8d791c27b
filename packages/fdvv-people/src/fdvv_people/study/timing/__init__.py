"""Studies that time presses of people: the paper's experiment, and the tapping test."""
