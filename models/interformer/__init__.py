"""Interformer encoder: three seconds of motion in, the probability of each gesture out."""
