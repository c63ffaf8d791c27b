"""The documents are whole, true and found: coverage, examples, links, site."""
