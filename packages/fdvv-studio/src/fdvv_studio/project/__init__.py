"""A person's documents: edit history, patches, programs."""
