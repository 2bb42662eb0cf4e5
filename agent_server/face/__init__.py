"""Faces from images: detection, tracking, landmarks, blendshapes, head pose, features."""
