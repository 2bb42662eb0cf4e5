"""Manifold-aware Wasserstein GAN: one second of motion in, the next two out."""
