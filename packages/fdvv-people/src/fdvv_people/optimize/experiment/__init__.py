"""The paper's experiment on simulated people: training, a week, validation, report."""
