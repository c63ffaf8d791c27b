"""What these pages ask for, a module for each group of calls."""
