"""HP-GAN: several futures of one second of motion, each from a random vector of its own."""
