"""Long work in processes of its own, with its events on file."""
