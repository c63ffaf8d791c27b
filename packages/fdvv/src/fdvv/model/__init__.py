"""What a button should feel like: force curves, vibration, models, landmarks, fits and files."""
