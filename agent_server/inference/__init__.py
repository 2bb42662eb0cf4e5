"""Model bundles: what they promise, and running them."""
