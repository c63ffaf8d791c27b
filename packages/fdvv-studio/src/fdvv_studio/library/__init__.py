"""The catalogue of buttons: index, search, similarity, and libraries of measured buttons."""
