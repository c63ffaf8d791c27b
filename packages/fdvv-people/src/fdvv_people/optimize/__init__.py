"""Find the button that makes a person perform best: design spaces, engines, tasks."""
