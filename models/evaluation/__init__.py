"""Measuring exported models on people and recordings that they were not trained on."""
