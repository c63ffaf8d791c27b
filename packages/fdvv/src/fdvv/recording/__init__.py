"""Streams as benches record them: types, files, readers of foreign logs."""
