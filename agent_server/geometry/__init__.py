"""The maths of curves, the sphere and skeletons: the float64 reference."""
