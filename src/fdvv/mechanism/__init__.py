"""From a model to a real switch: springs, leaves on cams and domes that give its curves."""
