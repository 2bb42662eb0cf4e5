"""Measurements of the product on the machine at hand; each gives a frozen result."""
