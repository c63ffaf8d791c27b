"""From sealed answers to statistics, sentences and a report."""
