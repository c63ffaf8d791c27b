"""What a person does with a button, and how well it went: tasks, rounds, scores."""
