"""People, gestures and sensors that are made up: seeded motion with ground truth."""
